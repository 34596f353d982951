#include "sim/bodies/integrator.h"

#include <boost/numeric/odeint.hpp>
#include <cmath>

namespace rondo::sim {
namespace {

void RungeKutta4(const Derivative& f, std::vector<double>& x, double dt) {
  const size_t n = x.size();
  thread_local std::vector<double> k1, k2, k3, k4, y;  // memory that the steps of one thread share
  for (auto* v : {&k1, &k2, &k3, &k4, &y}) v->resize(n);
  f(x, k1);
  for (size_t i = 0; i < n; ++i) y[i] = x[i] + dt / 2 * k1[i];
  f(y, k2);
  for (size_t i = 0; i < n; ++i) y[i] = x[i] + dt / 2 * k2[i];
  f(y, k3);
  for (size_t i = 0; i < n; ++i) y[i] = x[i] + dt * k3[i];
  f(y, k4);
  for (size_t i = 0; i < n; ++i) x[i] += dt / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
}

bool Adaptive(const Derivative& f, std::vector<double>& x, double dt) {
  namespace odeint = boost::numeric::odeint;
  auto stepper = odeint::make_controlled<odeint::runge_kutta_dopri5<std::vector<double>>>(1e-9, 1e-9);
  const auto system = [&](const std::vector<double>& state, std::vector<double>& rate, double) {
    rate.resize(state.size());
    f(state, rate);
  };
  double t = 0;
  double step = dt;
  for (int tries = 0; dt - t > 1e-15; ++tries) {
    if (tries > 100'000 || !(step > 0)) return false;
    step = std::min(step, dt - t);
    stepper.try_step(system, x, t, step);
  }
  return true;
}

}  // namespace

bool Integrate(Integrator integrator, const Derivative& f, std::vector<double>& state, double dt) {
  if (integrator == Integrator::kRungeKutta4) {
    RungeKutta4(f, state, dt);
  } else if (!Adaptive(f, state, dt)) {
    return false;
  }
  for (const double x : state) {
    if (!std::isfinite(x)) return false;
  }
  return true;
}

}  // namespace rondo::sim
