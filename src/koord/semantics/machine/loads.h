#pragma once

#include "koord/semantics/machine/nested_lists.h"
#include "koord/semantics/machine/registers.h"

/// Carries out the instructions that push constants, variables and parts of values. `ops.def` says what each
/// does.
namespace rondo::koord::semantics {

RONDO_INSTRUCTION RunConstant(Registers& r, const Instruction& i) {
  *r.top++ = r.m.code.constants[i.a];
  return Fault::kNone;
}

RONDO_INSTRUCTION RunPop(Registers& r, const Instruction& i) {
  r.top -= i.a;
  return Fault::kNone;
}

RONDO_INSTRUCTION RunParam(Registers& r, const Instruction& i) {
  Push(r, r.m.params.data() + i.a, i.b);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunGlobal(Registers& r, const Instruction& i) {
  Push(r, r.memory + i.a, i.b);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunOwn(Registers& r, const Instruction& i) {
  Push(r, r.memory + r.own + i.a, i.b);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunCell(Registers& r, const Instruction& i) {
  const int64_t robot = ToInt(*--r.top);
  if (robot < 0 || static_cast<uint64_t>(robot) >= r.m.layout.robots()) {
    RONDO_TOTAL(Index);
    PushZeros(r, i.b);
  } else {
    Push(r, r.memory + r.m.layout.block(static_cast<size_t>(robot)) + i.a, i.b);
  }
  return Fault::kNone;
}

/// Pushes the handle of the list with these words.
inline void PushList(Registers& r, const Word* from, uint32_t words) {
  *r.top++ = r.m.heap.Intern({from, words});
}

RONDO_INSTRUCTION RunCellArray(Registers& r, const Instruction& i) {
  const int64_t robot = ToInt(*--r.top);
  if (robot < 0 || static_cast<uint64_t>(robot) >= r.m.layout.robots()) {
    RONDO_TOTAL(Index);
    *r.top++ = 0;
  } else {
    PushList(r, r.memory + r.m.layout.block(static_cast<size_t>(robot)) + i.a, i.b * i.c);
  }
  return Fault::kNone;
}

RONDO_INSTRUCTION RunRow(Registers& r, const Instruction& i) {
  r.m.buffer.clear();
  for (size_t robot = 0; robot < r.m.layout.robots(); ++robot) {
    const Word* from = r.memory + r.m.layout.block(robot) + i.a;
    r.m.buffer.insert(r.m.buffer.end(), from, from + i.b);
  }
  *r.top++ = r.m.heap.Intern(r.m.buffer);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunGlobalArray(Registers& r, const Instruction& i) {
  PushList(r, r.memory + i.a, i.b * i.c);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunOwnArray(Registers& r, const Instruction& i) {
  PushList(r, r.memory + r.own + i.a, i.b * i.c);
  return Fault::kNone;
}

/// Pops an index and pushes that item of the array of `i.c` items of `i.b` words at `array`.
inline Fault PushItem(Registers& r, const Instruction& i, const Word* array) {
  const int64_t k = ToInt(*--r.top);
  const bool inside = k >= 0 && static_cast<uint64_t>(k) < i.c;
  if (inside) {
    Push(r, array + static_cast<size_t>(k) * i.b, i.b);
  } else {
    RONDO_TOTAL(Index);
    PushZeros(r, i.b);
  }
  return Fault::kNone;
}

RONDO_INSTRUCTION RunGlobalAt(Registers& r, const Instruction& i) { return PushItem(r, i, r.memory + i.a); }

RONDO_INSTRUCTION RunOwnAt(Registers& r, const Instruction& i) {
  return PushItem(r, i, r.memory + r.own + i.a);
}

RONDO_INSTRUCTION RunFlatIndex(Registers& r, const Instruction& i) {
  const int64_t k = ToInt(*--r.top);
  const int64_t outer = ToInt(r.top[-1]);
  int64_t flat = 0;
  const bool inside = k >= 0 && static_cast<uint64_t>(k) < i.a && outer >= 0 &&
                      !__builtin_mul_overflow(outer, static_cast<int64_t>(i.a), &flat) &&
                      !__builtin_add_overflow(flat, k, &flat);
  if (!inside) RONDO_TOTAL(Index);
  r.top[-1] = FromInt(inside ? flat : -1);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunPack(Registers& r, const Instruction& i) {
  r.top -= i.b;
  *r.top = Pack(r.m.heap, r.m.code.shapes[i.a], {r.top, i.b});
  ++r.top;
  return Fault::kNone;
}

RONDO_INSTRUCTION RunUnpack(Registers& r, const Instruction& i) {
  --r.top;
  if (!Unpack(r.m.heap, r.m.code.shapes[i.a], *r.top, r.top)) {
    RONDO_TOTAL(Index);
    std::fill_n(r.top, i.b, 0);
  }
  r.top += i.b;
  return Fault::kNone;
}

RONDO_INSTRUCTION RunFrame(Registers& r, const Instruction& i) {
  Push(r, r.frame + i.a, i.b);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunSlice(Registers& r, const Instruction& i) {
  r.top -= i.c;
  for (uint32_t k = 0; k < i.b; ++k) r.top[k] = r.top[i.a + k];
  r.top += i.b;
  return Fault::kNone;
}

RONDO_INSTRUCTION RunReplace(Registers& r, const Instruction& i) {
  Word* record = r.top - i.c;
  Word* value = record - i.b;
  for (uint32_t k = 0; k < i.b; ++k) std::swap(record[i.a + k], value[k]);
  for (uint32_t k = 0; k < i.c; ++k) value[k] = record[k];
  r.top = value + i.c;
  return Fault::kNone;
}

RONDO_INSTRUCTION RunRobot(Registers& r, const Instruction&) {
  *r.top++ = r.robot;
  return Fault::kNone;
}

}  // namespace rondo::koord::semantics
