#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace rondo::sim {

/// x' = f(x): writes the derivative of `state` to `rate`. The inputs are held while time passes.
using Derivative = std::function<void(std::span<const double> state, std::span<double> rate)>;

enum class Integrator : uint8_t {
  kRungeKutta4,  ///< one step, fourth order
  kAdaptive,     ///< Dormand and Prince 5(4), relative and absolute tolerance 1e-9 (Boost.Odeint)
};

/// Moves `state` on by `dt` seconds. False if the adaptive steps become too small to go on, or the state is
/// not finite.
bool Integrate(Integrator integrator, const Derivative& f, std::vector<double>& state, double dt);

}  // namespace rondo::sim
