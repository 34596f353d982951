#pragma once

#include <cstring>

#include "reach/validated/series/convolve.h"

/// The inner loop of `convolve.h`, compiled once for each instruction set, with the vectors that it has
/// (GCC's and Clang's vector types).
namespace rondo::reach {
namespace {

#if defined(__AVX512F__)
constexpr size_t kNative = 8;
#elif defined(__AVX__)
constexpr size_t kNative = 4;
#else
constexpr size_t kNative = 2;
#endif
constexpr size_t kParts = kWidth / kNative;

using Lanes __attribute__((vector_size(kNative * sizeof(double)))) = double;

/// Holds eight partial sums. Vectors are not passed by value: how depends on the instruction set.
struct Sums {
  Lanes parts[kParts] = {};

  /// Adds the products of eight numbers of `a` and of `b`.
  void AddProducts(const double* a, const double* b) {
    for (size_t i = 0; i < kParts; ++i) {
      Lanes x;
      Lanes y;
      std::memcpy(&x, a + i * kNative, sizeof x);
      std::memcpy(&y, b + i * kNative, sizeof y);
      parts[i] += x * y;
    }
  }
  /// Returns the sum of all eight.
  double Total() const {
    double v[kWidth];
    std::memcpy(v, parts, sizeof v);
    return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
  }
};

/// Is a `Convolve` for the instruction set that this is compiled for.
[[maybe_unused]] void ConvolveHere(const Pairs& pairs, size_t count, const double* left, size_t left_stride,
                                   const double* right, size_t right_stride, size_t blocks, double* out) {
  if (blocks == 1) {
    for (size_t o = 0; o < count; ++o) {
      Sums sum;
      for (uint32_t p = pairs.begin[o]; p < pairs.begin[o + 1]; ++p)
        sum.AddProducts(left + pairs.left[p] * left_stride, right + pairs.right[p] * right_stride);
      out[o] = sum.Total();
    }
    return;
  }
  for (size_t o = 0; o < count; ++o) {
    Sums sum;
    for (uint32_t p = pairs.begin[o]; p < pairs.begin[o + 1]; ++p) {
      const double* a = left + pairs.left[p] * left_stride;
      const double* b = right + pairs.right[p] * right_stride;
      for (size_t block = 0; block < blocks; ++block) sum.AddProducts(a + block * kWidth, b + block * kWidth);
    }
    out[o] = sum.Total();
  }
}

}  // namespace
}  // namespace rondo::reach
