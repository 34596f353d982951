#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

/// Exact numbers: what terms, certificates and parsers compute with.
namespace rondo::expr {

/// Is an exact rational number of any size (GMP), always in lowest terms. A value type; copies are deep.
class Rational {
 public:
  Rational(int64_t value = 0);  // NOLINT: implicit by design
  Rational(const Rational& other);
  Rational(Rational&& other) noexcept;
  Rational& operator=(Rational other) noexcept;
  ~Rational();

  /// Reads `12`, `1.5`, `.5`, `5.`, `1e-3`, `-2/3` exactly. nullopt for anything else, for a zero
  /// denominator, and for exponents beyond +-400, which would only exhaust memory.
  static std::optional<Rational> Parse(std::string_view text);

  friend Rational operator+(const Rational& a, const Rational& b);
  friend Rational operator-(const Rational& a, const Rational& b);
  friend Rational operator*(const Rational& a, const Rational& b);
  /// Requires b != 0.
  friend Rational operator/(const Rational& a, const Rational& b);
  friend bool operator==(const Rational& a, const Rational& b);
  friend std::strong_ordering operator<=>(const Rational& a, const Rational& b);

  bool IsZero() const;
  bool IsInteger() const;
  /// Returns the largest integer that is not above it.
  Rational Floor() const;
  /// Returns the square root, if it is rational.
  std::optional<Rational> ExactRoot() const;
  /// Returns the exact value of a finite double.
  static Rational FromDouble(double value);
  /// Returns a double near it, less than one unit in the last place away (GMP rounds towards zero).
  double ToDouble() const;
  /// Returns how many decimal digits numerator and denominator have together, or one or two more.
  size_t Digits() const;
  size_t Hash() const;
  /// Return numerator and denominator in decimal; the sign is the numerator's.
  std::string Numerator() const;
  std::string Denominator() const;
  /// Returns `3`, `0.25`, and `1/3` where no short decimal is exact.
  std::string ToString() const;

 private:
  struct Impl;
  explicit Rational(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Returns the quotient q of SMT-LIB's `div`, for which 0 <= a - b*q < |b|. Requires b != 0.
Rational EuclideanQuotient(const Rational& a, const Rational& b);

}  // namespace rondo::expr
