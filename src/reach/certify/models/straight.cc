#include "reach/certify/models/straight.h"

#include <algorithm>

#include "reach/certify/models/upward.h"

namespace rondo::reach::certify {

namespace {

bool IsKink(CodeOp op) { return op == CodeOp::kMax || op == CodeOp::kAbs; }

// A double within 2^-54 of (1 + slope) / 2, and the slack.
LinearPart HalfOf(double slope, uint32_t node) { return {0.5 * (1 + slope), 0x1p-53, node}; }

}  // namespace

uint32_t OpenKink(const Program& program, const OnBox& on, uint32_t from) {
  uint32_t node = from;
  while (node < program.code.size() && !(IsKink(program.code[node].op) && on.choices[node] == Choice::kOpen))
    ++node;
  return node;
}

Program ArgumentOf(const Program& program, uint32_t node) {
  const Code kink = program.code[node];
  Program argument = program;
  argument.code.resize(node + 1);
  argument.constants.resize(node + 1);
  argument.depends.resize(node + 1);
  std::erase_if(argument.kinks, [&](uint32_t k) { return k >= node; });
  argument.code[node] = {CodeOp::kLinear, static_cast<uint32_t>(program.parts.size()),
                         kink.op == CodeOp::kMax ? 2u : 1u};
  argument.constants[node] = {0, 0, 0};
  argument.parts.push_back({1, 0, kink.a});
  if (kink.op == CodeOp::kMax) argument.parts.push_back({-1, 0, kink.b});
  argument.outputs.assign(1, node);
  argument.core_end = node + 1;
  return argument;
}

// max(a, b) = (a + b + |a - b|) / 2, and |x| = slope x + rest. With |slope| <= 1 the rest is linear on both sides of
// zero, and zero there.
void Straighten(Program& program, uint32_t node, Interval argument) {
  const Code kink = program.code[node];
  const bool max = kink.op == CodeOp::kMax;
  double slope = argument.lo >= 0 ? 1 : -1;
  Interval rest = Interval::Point(0);
  if (argument.lo < 0 && argument.hi > 0) {
    slope = std::clamp((argument.lo + argument.hi) / (argument.hi - argument.lo), -1.0, 1.0);
    const Interval s = Interval::Point(slope);
    for (const double end : {argument.lo, argument.hi}) {
      const Interval x = Interval::Point(end);
      rest = interval::Hull(rest, interval::Abs(x) - s * x);
    }
  }
  const auto first = static_cast<uint32_t>(program.parts.size());
  LinearPart constant{rest.Middle(), Radius(rest), 0};
  if (max) {
    program.parts.push_back(HalfOf(slope, kink.a));
    program.parts.push_back(HalfOf(-slope, kink.b));
    constant = {0.5 * constant.factor, 0.5 * constant.error, 0};
  } else {
    program.parts.push_back({slope, 0, kink.a});
  }
  program.code[node] = {CodeOp::kLinear, first, static_cast<uint32_t>(program.parts.size()) - first};
  program.constants[node] = constant;
  std::erase(program.kinks, node);
}

}  // namespace rondo::reach::certify
