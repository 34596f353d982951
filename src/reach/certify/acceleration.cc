#include "reach/certify/acceleration.h"

#include <array>

#include "reach/certify/models/model.h"
#include "reach/certify/models/upward.h"

namespace rondo::reach::certify {

namespace {

// Taylor coefficients in time, of order one and two. The one of order zero is known.
struct Jet {
  Interval first = Interval::Point(0);
  Interval second = Interval::Point(0);
};

const Jet kUnknown{{}, {}};

// Interval arithmetic knows no 0 * infinity.
Jet Cleaned(const Jet& jet) { return IsFinite(jet.first) && IsFinite(jet.second) ? jet : kUnknown; }

Jet Product(Interval a, const Jet& x, Interval b, const Jet& y) {
  return {x.first * b + a * y.first, x.second * b + x.first * y.first + a * y.second};
}

// For a function of one argument: f' x1, and f' x2 + f'' / 2 x1^2.
Jet Chain(CodeOp function, Interval at, const Jet& x) {
  std::array<Interval, 3> c;
  if (!TaylorCoefficients(function, at, c)) return kUnknown;
  return {c[1] * x.first, c[1] * x.second + c[2] * interval::Sqr(x.first)};
}

Jet Of(const Program& p, uint32_t node, const OnBox& on, const std::vector<Jet>& jets,
       const std::vector<Jet>& variables) {
  const Code& c = p.code[node];
  const std::vector<Interval>& v = on.values;
  const bool first = on.choices[node] == Choice::kFirst;
  switch (c.op) {
    case CodeOp::kVariable:
      return variables[c.a];
    case CodeOp::kLinear: {
      Jet sum;
      for (uint32_t i = c.a; i < c.a + c.b; ++i) {
        const Interval factor = Interval::Point(p.parts[i].factor) + Around(p.parts[i].error);
        sum.first = sum.first + factor * jets[p.parts[i].node].first;
        sum.second = sum.second + factor * jets[p.parts[i].node].second;
      }
      return sum;
    }
    case CodeOp::kProduct:
      return Product(v[c.a], jets[c.a], v[c.b], jets[c.b]);
    case CodeOp::kAtan2:
      return kUnknown;
    case CodeOp::kAbs:
    case CodeOp::kMax:
    case CodeOp::kChoose: {
      if (on.choices[node] == Choice::kOpen) return kUnknown;
      if (c.op == CodeOp::kMax) return jets[first ? c.a : c.b];
      if (c.op == CodeOp::kChoose) return jets[first ? c.b : c.c];
      return first ? jets[c.a] : Jet{-jets[c.a].first, -jets[c.a].second};
    }
    default:
      return Chain(c.op, v[c.a], jets[c.a]);
  }
}

// By node. Nothing is said of nodes that a variable which is unknown has a part in.
std::vector<Jet> JetsOf(const Program& p, const OnBox& on, const std::vector<Jet>& variables) {
  std::vector<Jet> jets(p.code.size());
  for (uint32_t node = 0; node < p.code.size(); ++node) {
    bool known = true;
    for (const uint32_t v : p.depends[node])
      known = known && IsFinite(variables[v].first) && IsFinite(variables[v].second);
    jets[node] = known ? Cleaned(Of(p, node, on, jets, variables)) : kUnknown;
  }
  return jets;
}

}  // namespace

std::vector<Interval> Accelerations(const Dynamics& dynamics, const Program& observed,
                                    const interval::Box& box) {
  std::vector<Interval> result(observed.outputs.size());
  const Program& rates = dynamics.rates;
  OnBox on_rates;
  OnBox on;
  if (!Linearise(rates, box, 0, on_rates) || !Linearise(observed, box, 0, on)) return result;
  // x = x0 + x1 t + x2 t^2: x1 is the rate, x2 half of its derivative.
  std::vector<Jet> variables(box.size());
  for (size_t v = 0; v < box.size(); ++v) {
    if (v < dynamics.states) {
      variables[v].first = on_rates.values[rates.outputs[v]];
    } else if (!box[v].IsPoint()) {
      variables[v] = kUnknown;
    }
  }
  const std::vector<Jet> of_rates = JetsOf(rates, on_rates, variables);
  for (size_t i = 0; i < dynamics.states; ++i) {
    const Jet& rate = of_rates[rates.outputs[i]];
    variables[i] = Cleaned({variables[i].first, Interval::Point(0.5) * rate.first});
  }
  const std::vector<Jet> jets = JetsOf(observed, on, variables);
  for (size_t k = 0; k < result.size(); ++k)
    result[k] = Interval::Point(2) * jets[observed.outputs[k]].second;
  return result;
}

}  // namespace rondo::reach::certify
