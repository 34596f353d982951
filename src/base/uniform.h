#pragma once

#include <cmath>
#include <numbers>
#include <random>

/// Draws random numbers that are the same on every machine.
namespace rondo::base {

/// Returns a number in [0, 1): the same everywhere for the same state of the engine, which the standard's
/// distributions do not promise.
inline double Uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// Returns a number from the normal distribution of mean 0 and deviation 1 (Box and Muller). Takes two
/// numbers from the engine.
inline double Normal(std::mt19937_64& random) {
  const double u = 1 - Uniform(random);
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * Uniform(random));
}

}  // namespace rondo::base
