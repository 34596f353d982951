#include "solve/certify/arithmetic/known_value.h"

#include <gmpxx.h>

#include <utility>

namespace rondo::solve::certify {

using expr::Elementary;
using expr::Rational;

namespace {

// r >= 0 with r r = value: of numerator and denominator in lowest terms, each for itself.
std::optional<Rational> SquareRoot(const Rational& value) {
  const mpz_class n(value.Numerator());
  const mpz_class d(value.Denominator());
  if (sgn(n) < 0) return std::nullopt;
  const mpz_class p = sqrt(n);
  const mpz_class q = sqrt(d);
  if (p * p != n || q * q != d) return std::nullopt;
  return *Rational::Parse(p.get_str()) / *Rational::Parse(q.get_str());
}

// (p / q)^n = p^n / q^n, and the reciprocal for a negative n.
std::optional<Rational> WholePower(const Rational& base, const Rational& exponent) {
  constexpr unsigned long kMost = 10'000;
  constexpr size_t kMostDigits = 20'000;
  const Rational size = exponent < Rational(0) ? Rational(0) - exponent : exponent;
  if (!size.IsInteger() || size > Rational(static_cast<int64_t>(kMost))) return std::nullopt;
  const unsigned long n = mpz_class(size.Numerator()).get_ui();
  if (base.Digits() * n > kMostDigits) return std::nullopt;
  mpz_class p;
  mpz_class q;
  mpz_pow_ui(p.get_mpz_t(), mpz_class(base.Numerator()).get_mpz_t(), n);
  mpz_pow_ui(q.get_mpz_t(), mpz_class(base.Denominator()).get_mpz_t(), n);
  if (exponent < Rational(0)) std::swap(p, q);
  return *Rational::Parse(p.get_str()) / *Rational::Parse(q.get_str());
}

}  // namespace

std::optional<Rational> KnownValue(Elementary function, const std::vector<Rational>& args) {
  const Rational zero(0);
  const Rational one(1);
  const Rational& x = args[0];
  switch (function) {
    case Elementary::kSqrt:
      return SquareRoot(x);
    case Elementary::kAbs:
      return x < zero ? zero - x : x;
    case Elementary::kMin:
      return args[1] < x ? args[1] : x;
    case Elementary::kMax:
      return args[1] < x ? x : args[1];
    case Elementary::kSin:   // the vertical side of the unit circle's point at angle 0
    case Elementary::kTan:   // sin 0 / cos 0
    case Elementary::kAsin:  // sin 0 = 0 and 0 in [-pi/2, pi/2]
    case Elementary::kAtan:  // tan 0 = 0
      if (x.IsZero()) return zero;
      break;
    case Elementary::kCos:
    case Elementary::kExp:
      if (x.IsZero()) return one;
      break;
    case Elementary::kAcos:  // cos 0 = 1
    case Elementary::kLog:   // exp 0 = 1
      if (x == one) return zero;
      break;
    case Elementary::kAtan2:  // atan2(y, x): the direction of the positive x axis
      if (x.IsZero() && args[1] > zero) return zero;
      break;
    case Elementary::kPower:
      if (args[1].IsZero()) return one;
      if (x.IsZero()) return args[1] > zero ? std::optional(zero) : std::nullopt;
      if (x == one) return one;
      return WholePower(x, args[1]);
    case Elementary::kCount_:
      break;
  }
  return std::nullopt;
}

}  // namespace rondo::solve::certify
