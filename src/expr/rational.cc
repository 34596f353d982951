#include "expr/rational.h"

#include <gmpxx.h>

#include <cctype>
#include <cmath>

#include "base/check.h"

namespace rondo::expr {
namespace {

constexpr long kLargestExponent = 400;

mpz_class PowerOfTen(unsigned long exponent) {
  mpz_class result;
  mpz_ui_pow_ui(result.get_mpz_t(), 10, exponent);
  return result;
}

}  // namespace

struct Rational::Impl {
  mpq_class value;
};

Rational::Rational(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Rational::Rational(int64_t value) : impl_(std::make_unique<Impl>()) {
  static_assert(sizeof(long) == sizeof(int64_t));
  impl_->value = mpq_class(static_cast<long>(value));
}
Rational::Rational(const Rational& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
Rational::Rational(Rational&& other) noexcept = default;
Rational& Rational::operator=(Rational other) noexcept {
  impl_ = std::move(other.impl_);
  return *this;
}
Rational::~Rational() = default;

std::optional<Rational> Rational::Parse(std::string_view text) {
  bool negative = false;
  if (text.starts_with('-')) {
    negative = true;
    text.remove_prefix(1);
  }
  std::string digits;
  std::string denominator;
  long scale = 0;  // value = digits * 10^scale / denominator
  bool fraction = false;
  size_t i = 0;
  for (; i < text.size(); ++i) {
    const char c = text[i];
    if (std::isdigit(static_cast<unsigned char>(c))) {
      digits += c;
      if (fraction) --scale;
    } else if (c == '.' && !fraction) {
      fraction = true;
    } else {
      break;
    }
  }
  if (digits.empty()) return std::nullopt;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    ++i;
    bool minus = false;
    if (i < text.size() && (text[i] == '+' || text[i] == '-')) minus = text[i++] == '-';
    if (i == text.size()) return std::nullopt;
    long exponent = 0;
    for (; i < text.size(); ++i) {
      if (!std::isdigit(static_cast<unsigned char>(text[i]))) return std::nullopt;
      exponent = exponent * 10 + (text[i] - '0');
      if (exponent > kLargestExponent) return std::nullopt;
    }
    scale += minus ? -exponent : exponent;
  } else if (i < text.size() && text[i] == '/' && !fraction) {
    denominator = text.substr(i + 1);
    i = text.size();
    if (denominator.empty() || denominator.find_first_not_of("0123456789") != std::string::npos)
      return std::nullopt;
  }
  if (i != text.size()) return std::nullopt;
  auto impl = std::make_unique<Impl>();
  impl->value = mpq_class(mpz_class(digits, 10));
  if (scale > 0) impl->value *= mpq_class(PowerOfTen(static_cast<unsigned long>(scale)));
  if (scale < 0) impl->value /= mpq_class(PowerOfTen(static_cast<unsigned long>(-scale)));
  if (!denominator.empty()) {
    const mpz_class d(denominator, 10);
    if (d == 0) return std::nullopt;
    impl->value /= mpq_class(d);
  }
  if (negative) impl->value = -impl->value;
  impl->value.canonicalize();
  return Rational(std::move(impl));
}

Rational operator+(const Rational& a, const Rational& b) {
  return Rational(std::make_unique<Rational::Impl>(Rational::Impl{a.impl_->value + b.impl_->value}));
}
Rational operator-(const Rational& a, const Rational& b) {
  return Rational(std::make_unique<Rational::Impl>(Rational::Impl{a.impl_->value - b.impl_->value}));
}
Rational operator*(const Rational& a, const Rational& b) {
  return Rational(std::make_unique<Rational::Impl>(Rational::Impl{a.impl_->value * b.impl_->value}));
}
Rational operator/(const Rational& a, const Rational& b) {
  CHECK(!b.IsZero()) << "division by zero";
  return Rational(std::make_unique<Rational::Impl>(Rational::Impl{a.impl_->value / b.impl_->value}));
}
bool operator==(const Rational& a, const Rational& b) { return a.impl_->value == b.impl_->value; }
std::strong_ordering operator<=>(const Rational& a, const Rational& b) {
  return cmp(a.impl_->value, b.impl_->value) <=> 0;
}

bool Rational::IsZero() const { return impl_->value == 0; }
bool Rational::IsInteger() const { return impl_->value.get_den() == 1; }
Rational Rational::Floor() const {
  auto impl = std::make_unique<Impl>();
  mpz_class quotient;
  mpz_fdiv_q(quotient.get_mpz_t(), impl_->value.get_num_mpz_t(), impl_->value.get_den_mpz_t());
  impl->value = mpq_class(quotient);
  return Rational(std::move(impl));
}
std::optional<Rational> Rational::ExactRoot() const {
  const mpz_class& n = impl_->value.get_num();
  const mpz_class& d = impl_->value.get_den();
  if (n < 0 || mpz_perfect_square_p(n.get_mpz_t()) == 0 || mpz_perfect_square_p(d.get_mpz_t()) == 0)
    return std::nullopt;
  auto impl = std::make_unique<Impl>();
  impl->value = mpq_class(sqrt(n), sqrt(d));
  return Rational(std::move(impl));
}

Rational Rational::FromDouble(double value) {
  CHECK(std::isfinite(value));
  auto impl = std::make_unique<Impl>();
  impl->value = mpq_class(value);
  return Rational(std::move(impl));
}

size_t Rational::Digits() const {
  return mpz_sizeinbase(impl_->value.get_num_mpz_t(), 10) + mpz_sizeinbase(impl_->value.get_den_mpz_t(), 10);
}

double Rational::ToDouble() const { return impl_->value.get_d(); }
size_t Rational::Hash() const { return std::hash<std::string>()(impl_->value.get_str()); }
std::string Rational::Numerator() const { return impl_->value.get_num().get_str(); }
std::string Rational::Denominator() const { return impl_->value.get_den().get_str(); }

std::string Rational::ToString() const {
  if (IsInteger()) return Numerator();
  // A denominator 2^a 5^b has a finite decimal; use it when it is short.
  mpz_class rest = impl_->value.get_den();
  unsigned long places = 0;
  unsigned long twos = 0;
  unsigned long fives = 0;
  while (rest % 2 == 0) rest /= 2, ++twos;
  while (rest % 5 == 0) rest /= 5, ++fives;
  places = std::max(twos, fives);
  if (rest != 1 || places > 6) return impl_->value.get_str();
  const mpz_class scaled = impl_->value.get_num() * PowerOfTen(places) / impl_->value.get_den();
  std::string digits = mpz_class(abs(scaled)).get_str();
  if (digits.size() <= places) digits.insert(0, places + 1 - digits.size(), '0');
  digits.insert(digits.size() - places, ".");
  return (scaled < 0 ? "-" : "") + digits;
}

Rational EuclideanQuotient(const Rational& a, const Rational& b) {
  CHECK(!b.IsZero()) << "division by zero";
  if (b > Rational(0)) return (a / b).Floor();
  return Rational(0) - (a / (Rational(0) - b)).Floor();
}

}  // namespace rondo::expr
