#include "reach/certify/models/evaluate.h"

#include <cmath>

namespace rondo::reach::certify {

namespace {

// |x| = slope x + offset with lo <= x <= hi, lo < 0 < hi.
struct Chord {
  double slope;
  Interval offset;
};
Chord ChordOfAbs(Interval x) {
  const double slope = (x.hi + x.lo) / (x.hi - x.lo);
  const Interval s = Interval::Point(slope);
  // |x| - slope x is linear on both sides of zero, where it is zero.
  const Interval at_lo = -Interval::Point(x.lo) - s * Interval::Point(x.lo);
  const Interval at_hi = Interval::Point(x.hi) - s * Interval::Point(x.hi);
  return {slope, interval::Hull(interval::Hull(at_lo, at_hi), Interval::Point(0))};
}

Model Abs(const Algebra& algebra, const Model& a) {
  const Interval range = algebra.Bounds(a);
  if (range.lo >= 0) return a;
  if (range.hi <= 0) return algebra.Affine(-1, a, Interval::Point(0));
  const Chord chord = ChordOfAbs(range);
  return algebra.Affine(chord.slope, a, chord.offset);
}

}  // namespace

std::optional<std::vector<Model>> Evaluate(const Program& program, const Algebra& algebra,
                                           const std::vector<Model>& variables, const OnBox& on,
                                           const std::vector<Model>* lower) {
  std::vector<Model> models(program.code.size());
  const LinearPart none{0, 0, 0};
  for (uint32_t node = 0; node < program.code.size(); ++node) {
    const Code& c = program.code[node];
    std::optional<Model> made;
    switch (c.op) {
      case CodeOp::kVariable:
        made = variables[c.a];
        break;
      case CodeOp::kLinear:
        made = algebra.Linear(std::span(program.parts).subspan(c.a, c.b), program.constants[node], models);
        break;
      case CodeOp::kProduct:
        made = lower == nullptr ? algebra.Product(models[c.a], models[c.b])
                                : algebra.NextPower(models[c.a], models[c.b], (*lower)[node]);
        break;
      case CodeOp::kReciprocal:
      case CodeOp::kRoot:
      case CodeOp::kSine:
      case CodeOp::kCosine:
      case CodeOp::kExp:
      case CodeOp::kLog:
      case CodeOp::kAtan:
        made = algebra.Function(c.op, models[c.a], lower == nullptr ? nullptr : &(*lower)[node]);
        break;
      case CodeOp::kAtan2:
        if (on.choices[node] != Choice::kOpen) made = algebra.Angle(models[c.a], models[c.b]);
        if (!made) made = algebra.Constant(on.values[node]);
        break;
      case CodeOp::kAbs:
        made = Abs(algebra, models[c.a]);
        break;
      case CodeOp::kMax:
        if (on.choices[node] == Choice::kOpen) {
          // (a + b + |a - b|) / 2
          const std::vector<LinearPart> minus{{1, 0, c.a}, {-1, 0, c.b}};
          const std::vector<LinearPart> half{{0.5, 0, 0}, {0.5, 0, 1}, {0.5, 0, 2}};
          const Model difference = algebra.Linear(minus, none, models);
          made = algebra.Linear(half, none, {models[c.a], models[c.b], Abs(algebra, difference)});
        } else {
          made = models[on.choices[node] == Choice::kFirst ? c.a : c.b];
        }
        break;
      case CodeOp::kChoose:
        made = on.choices[node] == Choice::kOpen ? algebra.Either(models[c.b], models[c.c])
                                                 : models[on.choices[node] == Choice::kFirst ? c.b : c.c];
        break;
    }
    if (!made || !std::isfinite(made->error) || !std::isfinite(made->norm)) return std::nullopt;
    models[node] = std::move(*made);
  }
  return models;
}

std::vector<Interval> RangesOf(const Algebra& algebra, const std::vector<Model>& models) {
  std::vector<Interval> ranges;
  for (const Model& m : models) ranges.push_back(algebra.Bounds(m));
  return ranges;
}

}  // namespace rondo::reach::certify
