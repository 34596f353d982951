#include "reach/validated/series/monomials.h"

#include <algorithm>
#include <map>

#include "base/check.h"

namespace rondo::reach {

namespace {

// All exponents of this degree, in descending lexicographic order: for degree 1 that is the order of the
// symbols.
void Enumerate(size_t symbols, size_t degree, std::vector<uint8_t>& prefix, std::vector<uint8_t>& out) {
  if (prefix.size() + 1 == symbols) {
    out.insert(out.end(), prefix.begin(), prefix.end());
    out.push_back(static_cast<uint8_t>(degree));
    return;
  }
  for (size_t e = degree + 1; e-- > 0;) {
    prefix.push_back(static_cast<uint8_t>(e));
    Enumerate(symbols, degree - e, prefix, out);
    prefix.pop_back();
  }
}

}  // namespace

void Monomials::Extend(size_t degree) {
  if (!count_.empty() && degree < count_.size()) return;
  CHECK(degree < 64) << degree;
  const size_t known = count_.empty() ? 0 : count_.back();
  if (count_.empty()) {
    exponents_.assign(symbols_, 0);
    count_.push_back(1);
  }
  while (count_.size() <= degree) {
    std::vector<uint8_t> prefix;
    if (symbols_ > 0) Enumerate(symbols_, count_.size(), prefix, exponents_);
    count_.push_back(symbols_ == 0 ? 1 : exponents_.size() / symbols_);
  }
  const size_t all = count_.back();
  std::map<std::vector<uint8_t>, uint32_t> index;
  for (size_t i = 0; i < all; ++i) {
    const auto e = Exponents(i);
    index.emplace(std::vector<uint8_t>(e.begin(), e.end()), static_cast<uint32_t>(i));
    if (i < known) continue;
    size_t sum = 0;
    bool even = true;
    for (const uint8_t x : e) {
      sum += x;
      even = even && x % 2 == 0;
    }
    degree_of_.push_back(static_cast<uint8_t>(sum));
    even_.push_back(even ? 1 : 0);
  }
  if (pair_begin_.empty()) pair_begin_.push_back(0);
  std::vector<uint8_t> factor(symbols_), rest(symbols_);
  for (size_t k = known; k < all; ++k) {
    // Every divisor of the monomial, with what remains.
    const auto e = Exponents(k);
    std::fill(factor.begin(), factor.end(), 0);
    while (true) {
      for (size_t s = 0; s < symbols_; ++s) rest[s] = static_cast<uint8_t>(e[s] - factor[s]);
      left_.push_back(index.at(factor));
      right_.push_back(index.at(rest));
      size_t s = 0;
      while (s < symbols_ && factor[s] == e[s]) factor[s++] = 0;
      if (s == symbols_) break;
      ++factor[s];
    }
    longest_ = std::max(longest_, left_.size() - pair_begin_.back());
    pair_begin_.push_back(static_cast<uint32_t>(left_.size()));
  }
}

}  // namespace rondo::reach
