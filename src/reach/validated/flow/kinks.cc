#include "reach/validated/flow/kinks.h"

#include <algorithm>
#include <cmath>

namespace rondo::reach {

namespace {

// What the function is beside the linear one, if that is zero at zero and the function is linear on both sides of it.
Chord Through(double slope, Interval at_lo, Interval at_hi) {
  return {slope, interval::Hull(interval::Hull(at_lo, at_hi), Interval::Point(0))};
}

// 1 - slope, and how far the double may be off.
LinearPart Rest(double slope, uint32_t node) { return {1 - slope, 0x1p-53, node}; }

}  // namespace

Chord ChordOfMax(Interval x) {
  const double slope = x.hi / (x.hi - x.lo);
  const Interval s = Interval::Point(slope);
  return Through(slope, -(s * Interval::Point(x.lo)), (Interval::Point(1) - s) * Interval::Point(x.hi));
}

Chord ChordOfAbs(Interval x) {
  const double slope = (x.hi + x.lo) / (x.hi - x.lo);
  const Interval s = Interval::Point(slope);
  const Interval one = Interval::Point(1);
  return Through(slope, -((one + s) * Interval::Point(x.lo)), (one - s) * Interval::Point(x.hi));
}

void ReplaceKink(Program& program, uint32_t n, Interval x) {
  Code& code = program.code[n];
  const bool max = code.op == CodeOp::kMax;
  const auto first = static_cast<uint32_t>(program.parts.size());
  LinearPart constant{0, 0, 0};
  if (x.lo >= 0 || x.hi <= 0) {
    const bool positive = x.lo >= 0;
    program.parts.push_back({max || positive ? 1.0 : -1.0, 0, max && !positive ? code.b : code.a});
  } else {
    const Chord chord = max ? ChordOfMax(x) : ChordOfAbs(x);
    program.parts.push_back({chord.slope, 0, code.a});
    if (max) program.parts.push_back(Rest(chord.slope, code.b));
    constant.factor = chord.offset.Middle();
    constant.error = std::max((Interval::Point(constant.factor) - chord.offset).hi,
                              (chord.offset - Interval::Point(constant.factor)).hi);
  }
  code = {CodeOp::kLinear, first, static_cast<uint32_t>(program.parts.size()) - first};
  program.constants[n] = constant;
  std::erase(program.kinks, n);
}

Program ComparedAt(const Program& program, uint32_t n) {
  const Code& kink = program.code[n];
  Program compared = program;
  compared.code.resize(n);
  compared.constants.resize(n);
  compared.depends.resize(n);
  std::erase_if(compared.kinks, [&](uint32_t k) { return k >= n; });
  const auto first = static_cast<uint32_t>(compared.parts.size());
  compared.parts.push_back({1, 0, kink.a});
  if (kink.op == CodeOp::kMax) compared.parts.push_back({-1, 0, kink.b});
  compared.code.push_back({CodeOp::kLinear, first, static_cast<uint32_t>(compared.parts.size()) - first});
  compared.constants.push_back({0, 0, 0});
  compared.depends.push_back(program.depends[n]);
  compared.outputs = {n};
  compared.core_end = n + 1;
  return compared;
}

}  // namespace rondo::reach
