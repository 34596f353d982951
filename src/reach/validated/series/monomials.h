#pragma once

#include <cstdint>
#include <span>
#include <vector>

/// The monomials that the engine's polynomials are made of.
namespace rondo::reach {

/// Numbers the monomials in `symbols` variables that range over [-1, 1], by degree: those of degree at most d
/// are the first Count(d), whatever the largest degree is. Number 0 is the constant 1.
class Monomials {
 public:
  explicit Monomials(size_t symbols) : symbols_(symbols) { Extend(1); }

  /// Makes the monomials up to this degree known. Cost: of all pairs whose product has this degree.
  void Extend(size_t degree);

  size_t symbols() const { return symbols_; }
  /// Returns the largest degree that is known.
  size_t degree() const { return count_.size() - 1; }
  /// Returns how many monomials have degree `d` or less.
  size_t Count(size_t d) const { return count_[d]; }
  size_t DegreeOf(size_t monomial) const { return degree_of_[monomial]; }
  /// Reports whether all exponents are even. Then the monomial ranges over [0, 1], else (but for 1) over [-1,
  /// 1].
  bool IsEven(size_t monomial) const { return even_[monomial] != 0; }
  std::span<const uint8_t> Exponents(size_t monomial) const {
    return std::span(exponents_).subspan(monomial * symbols_, symbols_);
  }
  /// Returns the monomial that is this symbol.
  size_t Symbol(size_t symbol) const { return symbol + 1; }

  /// Say which ordered pairs of monomials have the product `k`: those from pair_begin()[k] to before
  /// pair_begin()[k + 1].
  std::span<const uint32_t> pair_begin() const { return pair_begin_; }
  std::span<const uint32_t> left() const { return left_; }
  std::span<const uint32_t> right() const { return right_; }
  /// Returns the largest number of pairs with one product.
  size_t longest() const { return longest_; }

 private:
  size_t symbols_;
  std::vector<size_t> count_;
  std::vector<uint8_t> exponents_, degree_of_, even_;
  std::vector<uint32_t> pair_begin_, left_, right_;
  size_t longest_ = 1;
};

}  // namespace rondo::reach
