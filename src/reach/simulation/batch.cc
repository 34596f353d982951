#include "reach/simulation/batch.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

namespace rondo::reach {

base::Result<BatchJudge> BatchJudge::Of(const Problem& problem) {
  if (!problem.events.empty()) return base::Error{"a model with events is not simulated in batches"};
  BatchJudge judge;
  judge.problem_ = &problem;
  std::vector<TermId> variables = problem.states;
  for (const Input& i : problem.inputs) variables.push_back(i.term);
  std::string trouble;
  const auto compile = [&](const std::vector<TermId>& functions, Code& code) {
    auto program = Compile(*problem.arena, variables, functions);
    if (!program.ok()) {
      trouble = program.error().message;
      return;
    }
    code.program = std::move(program).value();
    code.values.resize(code.program.code.size());
  };
  compile(problem.rates, judge.rates_);
  compile(Updated(problem), judge.updates_);
  std::vector<TermId> terms;
  for (const Claim& c : problem.claims) {
    auto formula = Normalise(*problem.arena, c.formula);
    if (!formula.ok()) return formula.error();
    Judged judged{std::move(formula).value(), terms.size(), c.from.ToDouble(), c.to.ToDouble()};
    terms.insert(terms.end(), judged.formula.terms.begin(), judged.formula.terms.end());
    judge.claims_.push_back(std::move(judged));
  }
  compile(terms, judge.observed_);
  auto assumed = Normalise(*problem.arena, problem.assume);
  if (!assumed.ok()) return assumed.error();
  judge.assumption_ = std::move(assumed).value();
  compile(judge.assumption_.terms, judge.assumed_);
  if (!trouble.empty()) return base::Error{trouble};
  return judge;
}

void BatchJudge::Evaluate(Code& code, std::span<const Lanes> variables) {
  const Program& p = code.program;
  const auto each = [](Lanes& out, const Lanes& a, auto f) {
    for (size_t l = 0; l < kLanes; ++l) out[l] = f(a[l]);
  };
  for (size_t n = 0; n < p.code.size(); ++n) {
    const auto& c = p.code[n];
    Lanes& out = code.values[n];
    const auto& v = code.values;
    switch (c.op) {
      case CodeOp::kVariable:
        out = variables[c.a];
        break;
      case CodeOp::kLinear: {
        Lanes sum;
        sum.fill(p.constants[n].factor);
        for (uint32_t i = c.a; i < c.a + c.b; ++i) {
          const Lanes& x = v[p.parts[i].node];
          const double factor = p.parts[i].factor;
          for (size_t l = 0; l < kLanes; ++l) sum[l] += factor * x[l];
        }
        out = sum;
        break;
      }
      case CodeOp::kProduct:
        for (size_t l = 0; l < kLanes; ++l) out[l] = v[c.a][l] * v[c.b][l];
        break;
      case CodeOp::kReciprocal:
        each(out, v[c.a], [](double x) { return 1 / x; });
        break;
      case CodeOp::kRoot:
        each(out, v[c.a], [](double x) { return std::sqrt(x); });
        break;
      case CodeOp::kSine:
        each(out, v[c.a], [](double x) { return std::sin(x); });
        break;
      case CodeOp::kCosine:
        each(out, v[c.a], [](double x) { return std::cos(x); });
        break;
      case CodeOp::kExp:
        each(out, v[c.a], [](double x) { return std::exp(x); });
        break;
      case CodeOp::kLog:
        each(out, v[c.a], [](double x) { return std::log(x); });
        break;
      case CodeOp::kAtan:
        each(out, v[c.a], [](double x) { return std::atan(x); });
        break;
      case CodeOp::kAtan2:
        for (size_t l = 0; l < kLanes; ++l) out[l] = std::atan2(v[c.a][l], v[c.b][l]);
        break;
      case CodeOp::kAbs:
        each(out, v[c.a], [](double x) { return std::fabs(x); });
        break;
      case CodeOp::kMax:
        for (size_t l = 0; l < kLanes; ++l) out[l] = std::fmax(v[c.a][l], v[c.b][l]);
        break;
      case CodeOp::kChoose:
        for (size_t l = 0; l < kLanes; ++l) out[l] = v[c.a][l] <= 0 ? v[c.b][l] : v[c.c][l];
        break;
    }
  }
}

void BatchJudge::Judge(double time, std::span<const Lanes> x, std::span<bool> failed) {
  Evaluate(observed_, x);
  for (const Judged& claim : claims_) {
    if (time < claim.from - 1e-9 || time > claim.to + 1e-9) continue;
    for (size_t l = 0; l < failed.size(); ++l) {
      if (failed[l]) continue;
      const double miss = claim.formula.Miss([&](size_t atom) {
        const double value = observed_.values[observed_.program.outputs[claim.first + atom]][l];
        return std::isnan(value) ? 1e300 : value;
      });
      failed[l] = miss > 0;
    }
  }
}

void BatchJudge::Run(std::span<const std::vector<double>> starts, double dt, size_t steps,
                     std::span<bool> failed) {
  const size_t n = problem_->states.size();
  const size_t inputs = problem_->inputs.size();
  std::vector<Lanes> x(n + inputs), at(n + inputs), next(n);
  std::array<std::vector<Lanes>, 4> k;
  for (auto& slope : k) slope.resize(n);
  for (size_t i = 0; i < n; ++i) {
    for (size_t l = 0; l < kLanes; ++l) x[i][l] = starts[std::min(l, starts.size() - 1)][i];
  }
  std::array<std::mt19937_64, kLanes> random;
  for (size_t l = 0; l < kLanes; ++l) {
    uint64_t seed = 1;
    for (size_t i = 0; i < n; ++i) seed = seed * 0x9E3779B97F4A7C15U + std::bit_cast<uint64_t>(x[i][l]);
    random[l].seed(seed);
  }
  const auto draw = [&] {
    for (size_t i = 0; i < inputs; ++i) {
      const Interval bounds = problem_->inputs[i].bounds;
      for (size_t l = 0; l < kLanes; ++l) {
        const double u = static_cast<double>(random[l]() >> 11) * 0x1p-53;
        at[n + i][l] = x[n + i][l] = bounds.lo + u * (bounds.hi - bounds.lo);
      }
    }
  };
  draw();
  Evaluate(assumed_, x);
  std::array<bool, kLanes> excluded{};
  for (size_t l = 0; l < failed.size(); ++l) {
    failed[l] = false;
    excluded[l] =
        assumption_.Miss([&](size_t atom) { return assumed_.values[assumed_.program.outputs[atom]][l]; }) > 0;
  }
  const double period = problem_->controller ? problem_->controller->period.ToDouble() : 0;
  size_t sample = 0;
  const size_t samples = Samples(*problem_);
  const auto control = [&](double t) {
    if (sample >= samples || t < period * static_cast<double>(sample) - 1e-9) return;
    ++sample;
    Evaluate(updates_, x);
    for (size_t i = 0; i < n; ++i) next[i] = updates_.values[updates_.program.outputs[i]];
    std::copy(next.begin(), next.end(), x.begin());
  };
  const auto integrate = [&](double h) {
    constexpr std::array<double, 4> kAt{0, 0.5, 0.5, 1};
    for (size_t s = 0; s < 4; ++s) {
      for (size_t i = 0; i < n; ++i) {
        at[i] = x[i];
        if (s == 0) continue;
        for (size_t l = 0; l < kLanes; ++l) at[i][l] += kAt[s] * h * k[s - 1][i][l];
      }
      Evaluate(rates_, at);
      for (size_t i = 0; i < n; ++i) k[s][i] = rates_.values[rates_.program.outputs[i]];
    }
    for (size_t i = 0; i < n; ++i) {
      for (size_t l = 0; l < kLanes; ++l)
        x[i][l] += h / 6 * (k[0][i][l] + 2 * k[1][i][l] + 2 * k[2][i][l] + k[3][i][l]);
    }
  };
  control(0);
  Judge(0, x, failed);
  const size_t every = std::max<size_t>(1, steps / 16);
  for (size_t step = 0; step < steps; ++step) {
    if (step > 0 && step % every == 0) draw();
    double t = dt * static_cast<double>(step);
    const double end = dt * static_cast<double>(step + 1);
    while (t < end - 1e-9) {
      control(t);
      const double until = sample < samples ? std::min(end, period * static_cast<double>(sample)) : end;
      integrate(until - t);
      t = until;
    }
    Judge(end, x, failed);
  }
  for (size_t l = 0; l < failed.size(); ++l) {
    for (size_t i = 0; i < n; ++i) failed[l] = failed[l] || !std::isfinite(x[i][l]);
    failed[l] = failed[l] && !excluded[l];
  }
}

}  // namespace rondo::reach
