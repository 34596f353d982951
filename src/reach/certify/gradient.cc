#include "reach/certify/gradient.h"

namespace rondo::reach::certify {

namespace {

bool IsContinuousOperation(CodeOp op) {
  switch (op) {
    case CodeOp::kVariable:
    case CodeOp::kLinear:
    case CodeOp::kProduct:
    case CodeOp::kSine:
    case CodeOp::kCosine:
    case CodeOp::kExp:
    case CodeOp::kAbs:
    case CodeOp::kMax:
      return true;
    case CodeOp::kReciprocal:
    case CodeOp::kRoot:
    case CodeOp::kLog:
    case CodeOp::kAtan:
    case CodeOp::kAtan2:
    case CodeOp::kChoose:
      return false;
  }
  return false;
}

// By node: whether the one that is asked for is computed from it.
std::vector<bool> UsedBy(const Program& program, uint32_t node) {
  std::vector<bool> used(node + 1, false);
  used[node] = true;
  for (uint32_t n = node + 1; n-- > 0;) {
    if (!used[n]) continue;
    const Code& code = program.code[n];
    switch (code.op) {
      case CodeOp::kVariable:
        break;
      case CodeOp::kLinear:
        for (uint32_t i = code.a; i < code.a + code.b; ++i) used[program.parts[i].node] = true;
        break;
      case CodeOp::kChoose:
        used[code.c] = true;
        [[fallthrough]];
      case CodeOp::kProduct:
      case CodeOp::kMax:
      case CodeOp::kAtan2:
        used[code.b] = true;
        [[fallthrough]];
      default:
        used[code.a] = true;
    }
  }
  return used;
}

}  // namespace

bool IsContinuous(const Program& program, uint32_t node) {
  const std::vector<bool> used = UsedBy(program, node);
  for (uint32_t n = 0; n <= node; ++n) {
    if (used[n] && !IsContinuousOperation(program.code[n].op)) return false;
  }
  return true;
}

std::vector<Interval> GradientOn(const Program& program, const std::vector<Interval>& values, uint32_t node,
                                 size_t count) {
  // Backwards: what each node adds to the one that is asked for.
  std::vector<Interval> share(node + 1, Interval::Point(0));
  std::vector<bool> known(node + 1, false);
  share[node] = Interval::Point(1);
  known[node] = true;
  const auto add = [&](uint32_t to, Interval amount) {
    share[to] = known[to] ? share[to] + amount : amount;
    known[to] = true;
  };
  std::vector<Interval> gradient(count, Interval::Point(0));
  std::vector<bool> unknown(count, false);
  for (uint32_t n = node + 1; n-- > 0;) {
    if (!known[n]) continue;
    const Code& code = program.code[n];
    const Interval all = share[n];
    switch (code.op) {
      case CodeOp::kVariable:
        if (code.a < count) gradient[code.a] = all;
        break;
      case CodeOp::kLinear:
        for (uint32_t i = code.a; i < code.a + code.b; ++i) {
          const LinearPart& part = program.parts[i];
          add(part.node, all * (Interval::Point(part.factor) + Interval{-part.error, part.error}));
        }
        break;
      case CodeOp::kProduct:
        add(code.a, all * values[code.b]);
        add(code.b, all * values[code.a]);
        break;
      case CodeOp::kSine:
        add(code.a, all * interval::Cos(values[code.a]));
        break;
      case CodeOp::kCosine:
        add(code.a, -(all * interval::Sin(values[code.a])));
        break;
      case CodeOp::kExp:
        add(code.a, all * values[n]);
        break;
      default:
        for (const uint32_t variable : program.depends[n]) {
          if (variable < count) unknown[variable] = true;
        }
    }
  }
  for (size_t v = 0; v < count; ++v) {
    if (unknown[v]) gradient[v] = {};
  }
  return gradient;
}

}  // namespace rondo::reach::certify
