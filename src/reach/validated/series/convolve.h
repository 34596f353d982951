#pragma once

#include <cstddef>
#include <cstdint>

/// The inner loop of the multiplication of Taylor models whose coefficients are Taylor series in time.
namespace rondo::reach {

/// Doubles that are multiplied at once.
inline constexpr size_t kWidth = 8;

/// Lists, by output, the pairs of operands whose products are summed.
struct Pairs {
  const uint32_t* begin;  ///< by output: its first pair; one entry more than outputs
  const uint32_t* left;
  const uint32_t* right;
};

/// Computes, for each output o < count: out[o] = sum over its pairs (i, j) and a < kWidth * blocks of left[i
/// * left_stride + a] * right[j * right_stride + a], in some order of summation, with or without fused
/// operations: callers must count its roundings.
using Convolve = void (*)(const Pairs& pairs, size_t count, const double* left, size_t left_stride,
                          const double* right, size_t right_stride, size_t blocks, double* out);

/// Returns the one for the best instruction set of this machine.
Convolve BestConvolve();

}  // namespace rondo::reach
