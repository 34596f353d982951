#include "reach/validated/series/monomials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "reach/validated/series/bound.h"
#include "reach/validated/series/convolve.h"

namespace rondo::reach {

extern const Convolve kPortableConvolve;
#if defined(__x86_64__)
extern const Convolve kAvx2Convolve;
extern const Convolve kAvx512Convolve;
#endif

namespace {

Monomials UpTo(size_t symbols, size_t degree) {
  Monomials m(symbols);
  m.Extend(degree);
  return m;
}

size_t Choose(size_t n, size_t k) {
  size_t result = 1;
  for (size_t i = 1; i <= k; ++i) result = result * (n - k + i) / i;
  return result;
}

TEST(Monomials, AreAsManyAsThereAreExponents) {
  for (size_t symbols = 0; symbols <= 5; ++symbols) {
    const Monomials m = UpTo(symbols, 4);
    for (size_t d = 0; d <= 4; ++d) EXPECT_EQ(m.Count(d), Choose(symbols + d, d)) << symbols << " " << d;
  }
}

TEST(Monomials, AreAllDifferent) {
  const Monomials m = UpTo(3, 5);
  std::set<std::vector<uint8_t>> seen;
  for (size_t k = 0; k < m.Count(5); ++k) {
    const auto e = m.Exponents(k);
    EXPECT_TRUE(seen.emplace(e.begin(), e.end()).second) << k;
  }
}

TEST(Monomials, ComeByDegree) {
  const Monomials m = UpTo(3, 4);
  for (size_t k = 0; k < m.Count(4); ++k) {
    size_t sum = 0;
    for (const uint8_t e : m.Exponents(k)) sum += e;
    EXPECT_EQ(m.DegreeOf(k), sum);
    EXPECT_LT(k, m.Count(sum));
    if (sum > 0) {
      EXPECT_GE(k, m.Count(sum - 1));
    }
  }
}

TEST(Monomials, BeginWithOneAndTheSymbols) {
  const Monomials m = UpTo(4, 2);
  EXPECT_EQ(m.DegreeOf(0), 0u);
  for (size_t s = 0; s < 4; ++s) {
    EXPECT_EQ(m.DegreeOf(m.Symbol(s)), 1u);
    EXPECT_EQ(m.Exponents(m.Symbol(s))[s], 1);
  }
}

TEST(Monomials, KnowWhichAreNeverNegative) {
  const Monomials m = UpTo(2, 4);
  for (size_t k = 0; k < m.Count(4); ++k) {
    const auto e = m.Exponents(k);
    EXPECT_EQ(m.IsEven(k), e[0] % 2 == 0 && e[1] % 2 == 0) << k;
  }
}

TEST(Monomials, ListEveryPairOfFactorsOnce) {
  const Monomials m = UpTo(3, 4);
  const size_t count = m.Count(4);
  std::set<std::pair<uint32_t, uint32_t>> pairs;
  for (uint32_t p = 0; p < m.pair_begin()[count]; ++p)
    EXPECT_TRUE(pairs.emplace(m.left()[p], m.right()[p]).second);
  size_t expected = 0;
  for (size_t i = 0; i < count; ++i) {
    for (size_t j = 0; j < count; ++j) expected += m.DegreeOf(i) + m.DegreeOf(j) <= 4 ? 1 : 0;
  }
  EXPECT_EQ(pairs.size(), expected);
}

TEST(Monomials, KnowTheMostPairsOfAProduct) {
  const Monomials m = UpTo(3, 4);
  size_t most = 0;
  for (size_t k = 0; k < m.Count(4); ++k)
    most = std::max<size_t>(most, m.pair_begin()[k + 1] - m.pair_begin()[k]);
  EXPECT_EQ(m.longest(), most);
}

TEST(Monomials, AreTheSameWhenExtendedInSteps) {
  Monomials slowly(2);
  for (size_t d = 1; d <= 5; ++d) slowly.Extend(d);
  const Monomials at_once = UpTo(2, 5);
  ASSERT_EQ(slowly.Count(5), at_once.Count(5));
  for (size_t k = 0; k < at_once.Count(5); ++k)
    EXPECT_TRUE(std::ranges::equal(slowly.Exponents(k), at_once.Exponents(k))) << k;
  EXPECT_TRUE(std::ranges::equal(slowly.left(), at_once.left()));
}

TEST(Monomials, StayWhenALowerDegreeIsAskedFor) {
  Monomials m = UpTo(2, 4);
  m.Extend(1);
  EXPECT_EQ(m.degree(), 4u);
}

TEST(Monomials, OfNoSymbolsAreTheConstantOnly) {
  const Monomials m = UpTo(0, 3);
  EXPECT_EQ(m.Count(3), 1u);
  EXPECT_TRUE(m.IsEven(0));
}

// The kernels that this machine can run.
std::vector<Convolve> Kernels() {
  std::vector<Convolve> kernels{kPortableConvolve, BestConvolve()};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0)
    kernels.push_back(kAvx2Convolve);
  if (__builtin_cpu_supports("avx512f") != 0) kernels.push_back(kAvx512Convolve);
#endif
  return kernels;
}

struct Operands {
  Operands(const Monomials& m, size_t degree, size_t with_blocks)
      : monomials(m), count(m.Count(degree)), blocks(with_blocks), stride(with_blocks * kWidth) {
    left.resize(count * stride);
    right.resize(count * stride);
  }
  std::vector<double> Run(Convolve kernel) const {
    std::vector<double> out(count);
    const Pairs pairs{monomials.pair_begin().data(), monomials.left().data(), monomials.right().data()};
    kernel(pairs, count, left.data(), stride, right.data(), stride, blocks, out.data());
    return out;
  }
  // Output `o` by definition, of the magnitudes if asked for.
  long double Exact(size_t o, bool magnitudes) const {
    long double sum = 0;
    for (uint32_t p = monomials.pair_begin()[o]; p < monomials.pair_begin()[o + 1]; ++p) {
      for (size_t a = 0; a < stride; ++a) {
        const long double term = static_cast<long double>(left[monomials.left()[p] * stride + a]) *
                                 right[monomials.right()[p] * stride + a];
        sum += magnitudes ? std::fabs(term) : term;
      }
    }
    return sum;
  }

  const Monomials& monomials;
  size_t count, blocks, stride;
  std::vector<double> left, right;
};

TEST(Convolution, IsExactOnSmallIntegers) {
  const Monomials m = UpTo(3, 3);
  std::mt19937_64 random(7);
  for (const size_t blocks : {1, 2, 3}) {
    Operands operands(m, 3, blocks);
    for (double& x : operands.left) x = static_cast<double>(random() % 2001) - 1000;
    for (double& x : operands.right) x = static_cast<double>(random() % 2001) - 1000;
    for (const Convolve kernel : Kernels()) {
      const std::vector<double> out = operands.Run(kernel);
      for (size_t o = 0; o < out.size(); ++o) EXPECT_EQ(out[o], operands.Exact(o, false)) << blocks;
    }
  }
}

TEST(Convolution, IsOffByNoMoreThanItsRoundings) {
  const Monomials m = UpTo(4, 4);
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const size_t blocks : {1, 2}) {
    Operands operands(m, 4, blocks);
    for (double& x : operands.left) x = std::ldexp(uniform(random), static_cast<int>(random() % 30) - 15);
    for (double& x : operands.right) x = std::ldexp(uniform(random), static_cast<int>(random() % 30) - 15);
    const double roundings = Roundings(static_cast<double>(m.longest() * blocks * kWidth + 8));
    for (const Convolve kernel : Kernels()) {
      const std::vector<double> out = operands.Run(kernel);
      for (size_t o = 0; o < out.size(); ++o)
        EXPECT_LE(std::fabs(out[o] - operands.Exact(o, false)), roundings * operands.Exact(o, true)) << o;
    }
  }
}

TEST(Convolution, OfLowerDegreesUsesTheSamePairs) {
  const Monomials m = UpTo(2, 5);
  Operands low(m, 2, 1);
  for (size_t i = 0; i < low.count; ++i) low.left[i * low.stride] = low.right[i * low.stride] = 1;
  const std::vector<double> out = low.Run(BestConvolve());
  // The square of the sum of all monomials has the number of divisors as coefficients.
  for (size_t k = 0; k < low.count; ++k)
    EXPECT_EQ(out[k], (m.Exponents(k)[0] + 1) * (m.Exponents(k)[1] + 1)) << k;
}

}  // namespace
}  // namespace rondo::reach
