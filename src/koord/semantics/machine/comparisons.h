#pragma once

#include "koord/semantics/machine/registers.h"

/// Carries out comparisons, least and largest values, and negation. Truth values are the words 0 and 1.
namespace rondo::koord::semantics {

RONDO_INSTRUCTION RunLessInt(Registers& r, const Instruction&) {
  --r.top;
  r.top[-1] = ToInt(r.top[-1]) < ToInt(r.top[0]);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunLessEqualInt(Registers& r, const Instruction&) {
  --r.top;
  r.top[-1] = ToInt(r.top[-1]) <= ToInt(r.top[0]);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunLessFloat(Registers& r, const Instruction&) {
  --r.top;
  r.top[-1] = ToFloat(r.top[-1]) < ToFloat(r.top[0]);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunLessEqualFloat(Registers& r, const Instruction&) {
  --r.top;
  r.top[-1] = ToFloat(r.top[-1]) <= ToFloat(r.top[0]);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunEqual(Registers& r, const Instruction& i) {
  r.top -= size_t{2} * i.a;
  bool equal = true;
  for (uint32_t k = 0; k < i.a; ++k) equal = equal && r.top[k] == r.top[k + i.a];
  *r.top++ = equal;
  return Fault::kNone;
}

RONDO_INSTRUCTION RunNot(Registers& r, const Instruction&) {
  r.top[-1] = r.top[-1] == 0;
  return Fault::kNone;
}

RONDO_INSTRUCTION RunIsRobot(Registers& r, const Instruction&) {
  r.top[-1] = ToInt(r.top[-1]) >= 0 && r.top[-1] < r.m.layout.robots();
  return Fault::kNone;
}

RONDO_INSTRUCTION RunMinInt(Registers& r, const Instruction&) {
  --r.top;
  r.top[-1] = FromInt(std::min(ToInt(r.top[-1]), ToInt(r.top[0])));
  return Fault::kNone;
}

RONDO_INSTRUCTION RunMaxInt(Registers& r, const Instruction&) {
  --r.top;
  r.top[-1] = FromInt(std::max(ToInt(r.top[-1]), ToInt(r.top[0])));
  return Fault::kNone;
}

RONDO_INSTRUCTION RunMinFloat(Registers& r, const Instruction&) {
  --r.top;
  r.top[-1] = FromFloat(std::min(ToFloat(r.top[-1]), ToFloat(r.top[0])));
  return Fault::kNone;
}

RONDO_INSTRUCTION RunMaxFloat(Registers& r, const Instruction&) {
  --r.top;
  r.top[-1] = FromFloat(std::max(ToFloat(r.top[-1]), ToFloat(r.top[0])));
  return Fault::kNone;
}

}  // namespace rondo::koord::semantics
