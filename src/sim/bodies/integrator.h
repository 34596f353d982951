#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

/// Integrates ordinary differential equations in doubles.
namespace rondo::sim {

/// Writes the derivative x' = f(x) of `state` to `rate`, per second. The inputs are held while time passes.
using Derivative = std::function<void(std::span<const double> state, std::span<double> rate)>;

/// Names the methods of integration.
enum class Integrator : uint8_t {
  kRungeKutta4,  ///< the classical method of fourth order, in one step
  kAdaptive,     ///< Dormand and Prince 5(4), relative and absolute tolerance 1e-9 (Boost.Odeint)
};

/// Moves `state` on by `dt` seconds. Returns false if the adaptive steps become too small to go on, or the
/// state is not finite.
bool Integrate(Integrator integrator, const Derivative& f, std::vector<double>& state, double dt);

}  // namespace rondo::sim
