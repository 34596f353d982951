#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

/// The monomials that the checker's polynomials are made of.
namespace rondo::reach::certify {

/// Numbers the monomials up to a degree, in symbols that range over [-1, 1]. Number 0 is the constant 1,
/// number i + 1 is symbol i; those of a lower degree come first, in an order that does not depend on the
/// highest.
class Basis {
 public:
  /// Is an ordered pair of monomials, by their numbers.
  struct Pair {
    uint32_t left, right;
  };

  Basis(size_t symbols, size_t degree);

  size_t degree() const { return degree_; }
  size_t size() const { return degree_of_.size(); }
  size_t DegreeOf(size_t monomial) const { return degree_of_[monomial]; }
  /// Reports whether all exponents are even. Then the monomial is never negative.
  bool IsEven(size_t monomial) const { return even_[monomial] != 0; }
  /// Returns the number of the monomial with these exponents, by symbol, if its degree is not too high.
  std::optional<size_t> Find(const std::vector<uint32_t>& exponents) const;
  /// Returns the exponents of a monomial, one for each symbol.
  std::span<const uint32_t> Exponents(size_t monomial) const {
    return std::span(exponents_).subspan(monomial * symbols_, symbols_);
  }
  /// Returns all ordered pairs whose product is this monomial.
  std::span<const Pair> Pairs(size_t monomial) const {
    return std::span(pairs_).subspan(begin_[monomial], begin_[monomial + 1] - begin_[monomial]);
  }
  /// Returns the largest number of pairs with one product: how many roundings a coefficient of a product has.
  size_t most_pairs() const { return most_pairs_; }

 private:
  size_t symbols_, degree_;
  std::vector<uint32_t> exponents_;
  std::map<std::vector<uint32_t>, size_t> index_;
  std::vector<uint8_t> degree_of_, even_;
  std::vector<size_t> begin_;
  std::vector<Pair> pairs_;
  size_t most_pairs_ = 1;
};

/// Returns the highest degree, at least 1, of which there are no more than so many monomials.
size_t DegreeWithin(size_t symbols, size_t most_monomials);

/// Makes every basis once and keeps it. Safe for several threads.
class Bases {
 public:
  /// Returns the basis for so many symbols up to this degree.
  std::shared_ptr<const Basis> Of(size_t symbols, size_t degree);

 private:
  std::mutex mutex_;
  std::map<std::pair<size_t, size_t>, std::shared_ptr<const Basis>> known_;
};

}  // namespace rondo::reach::certify
