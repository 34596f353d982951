#include "reach/certify/models/basis.h"

#include <algorithm>

namespace rondo::reach::certify {

namespace {

using Powers = std::vector<uint32_t>;

// All exponents of exactly this degree, the first symbol's highest first.
void Enumerate(size_t symbols, size_t degree, Powers& prefix, std::vector<Powers>& out) {
  if (prefix.size() + 1 == symbols) {
    out.push_back(prefix);
    out.back().push_back(static_cast<uint32_t>(degree));
    return;
  }
  for (size_t own = degree + 1; own-- > 0;) {
    prefix.push_back(static_cast<uint32_t>(own));
    Enumerate(symbols, degree - own, prefix, out);
    prefix.pop_back();
  }
}

}  // namespace

Basis::Basis(size_t symbols, size_t degree) : symbols_(symbols), degree_(symbols == 0 ? 0 : degree) {
  std::vector<Powers> monomials;
  std::vector<size_t> up_to;  // how many have this degree or less
  for (size_t d = 0; d <= degree_; ++d) {
    Powers prefix;
    if (symbols == 0) {
      monomials.emplace_back();
    } else {
      Enumerate(symbols, d, prefix, monomials);
    }
    up_to.push_back(monomials.size());
    degree_of_.resize(monomials.size(), static_cast<uint8_t>(d));
  }
  for (size_t m = 0; m < monomials.size(); ++m) {
    index_.emplace(monomials[m], m);
    exponents_.insert(exponents_.end(), monomials[m].begin(), monomials[m].end());
    even_.push_back(std::ranges::all_of(monomials[m], [](uint32_t e) { return e % 2 == 0; }) ? 1 : 0);
  }
  std::vector<std::vector<Pair>> pairs(monomials.size());
  Powers product(symbols);
  for (size_t i = 0; i < monomials.size(); ++i) {
    for (size_t j = 0; j < up_to[degree_ - degree_of_[i]]; ++j) {
      for (size_t s = 0; s < symbols; ++s) product[s] = monomials[i][s] + monomials[j][s];
      pairs[index_.at(product)].push_back({static_cast<uint32_t>(i), static_cast<uint32_t>(j)});
    }
  }
  begin_.push_back(0);
  for (const std::vector<Pair>& p : pairs) {
    pairs_.insert(pairs_.end(), p.begin(), p.end());
    begin_.push_back(pairs_.size());
    most_pairs_ = std::max(most_pairs_, p.size());
  }
}

std::optional<size_t> Basis::Find(const std::vector<uint32_t>& exponents) const {
  const auto it = index_.find(exponents);
  return it == index_.end() ? std::nullopt : std::optional(it->second);
}

size_t DegreeWithin(size_t symbols, size_t most_monomials) {
  // (symbols + degree choose degree)
  double count = 1;
  for (size_t degree = 1;; ++degree) {
    count *= static_cast<double>(symbols + degree) / static_cast<double>(degree);
    if (count > static_cast<double>(most_monomials) || symbols == 0) return std::max<size_t>(degree, 2) - 1;
  }
}

std::shared_ptr<const Basis> Bases::Of(size_t symbols, size_t degree) {
  const std::lock_guard lock(mutex_);
  auto& basis = known_[{symbols, degree}];
  if (basis == nullptr) basis = std::make_shared<const Basis>(symbols, degree);
  return basis;
}

}  // namespace rondo::reach::certify
