#include "reach/validated/around.h"

#include <optional>

#include "reach/validated/series/box_series.h"

namespace rondo::reach {

namespace {

// Everything on the box.
struct Values {
  BoxSeries series;
  std::vector<Branch> branches;
};

std::optional<Values> ValuesOf(const Stage& stage, const interval::Box& box) {
  const Program& p = stage.dynamics.program;
  Values values{BoxSeries(p, 1), std::vector<Branch>(p.code.size(), Branch::kEither)};
  for (size_t i = 0; i < box.size(); ++i) values.series.SetVariable(i, 0, box[i]);
  for (size_t w = 0; w < stage.dynamics.inputs.size(); ++w)
    values.series.SetVariable(box.size() + w, 0, stage.dynamics.inputs[w]);
  std::vector<Interval> held(p.code.size());
  if (!values.series.Decide(values.branches, held)) return std::nullopt;
  return values;
}

}  // namespace

bool RatesOn(const Stage& stage, const interval::Box& box, interval::Box& rates) {
  const auto values = ValuesOf(stage, box);
  if (!values) return false;
  for (size_t i = 0; i < rates.size(); ++i)
    rates[i] = values->series.Of(stage.dynamics.program.outputs[i], 0);
  return true;
}

bool RisesOn(const Stage& stage, const interval::Box& box, const Guard& guard) {
  const Program& p = stage.dynamics.program;
  auto values = ValuesOf(stage, box);
  if (!values) return false;
  std::vector<Interval> gradient;
  values->series.Gradient({p.outputs[box.size() + guard.first]}, values->branches, {}, true, gradient);
  Interval rate = Interval::Point(0);
  for (size_t v = 0; v < gradient.size(); ++v) {
    if (gradient[v] == Interval::Point(0)) continue;
    if (v >= box.size()) return false;  // an input, which jumps
    rate = rate + gradient[v] * values->series.Of(p.outputs[v], 0);
  }
  return rate.lo > 0;
}

}  // namespace rondo::reach
