#pragma once

#include <cstring>

#include "reach/validated/convolve.h"

/// Compiled once for each instruction set: the vector type is GCC's and Clang's, eight doubles wide.
namespace rondo::reach {
namespace {

typedef double Lanes __attribute__((vector_size(kWidth * sizeof(double))));

// sum += the products of eight doubles each. Vectors are not passed by value: how depends on the instruction
// set.
inline void AddProducts(const double* a, const double* b, Lanes& sum) {
  Lanes x;
  Lanes y;
  std::memcpy(&x, a, sizeof x);
  std::memcpy(&y, b, sizeof y);
  sum += x * y;
}

inline double Sum(const Lanes& v) {
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

[[maybe_unused]] void ConvolveHere(const Pairs& pairs, size_t count, const double* left, size_t left_stride,
                                   const double* right, size_t right_stride, size_t blocks, double* out) {
  if (blocks == 1) {
    for (size_t o = 0; o < count; ++o) {
      Lanes sum{};
      for (uint32_t p = pairs.begin[o]; p < pairs.begin[o + 1]; ++p)
        AddProducts(left + pairs.left[p] * left_stride, right + pairs.right[p] * right_stride, sum);
      out[o] = Sum(sum);
    }
    return;
  }
  for (size_t o = 0; o < count; ++o) {
    Lanes sum{};
    for (uint32_t p = pairs.begin[o]; p < pairs.begin[o + 1]; ++p) {
      const double* a = left + pairs.left[p] * left_stride;
      const double* b = right + pairs.right[p] * right_stride;
      for (size_t block = 0; block < blocks; ++block)
        AddProducts(a + block * kWidth, b + block * kWidth, sum);
    }
    out[o] = Sum(sum);
  }
}

}  // namespace
}  // namespace rondo::reach
