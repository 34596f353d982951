#pragma once

#include "koord/semantics/machine/registers.h"

/// Carries out the instructions that write variables. Each write is remembered, so that it can be taken back,
/// and each unit that every robot may write, so that two robots' writes can be compared.
namespace rondo::koord::semantics {

/// Writes `width` words at address `at`, and remembers what was there before the run.
inline void WriteMemory(Registers& r, uint32_t at, const Word* from, uint32_t width) {
  MachineState& m = r.m;
  for (uint32_t k = 0; k < width; ++k) {
    // Once for each address: a loop may write it often.
    if (m.logged[at + k] != m.run) m.writes.push_back({at + k, m.memory[at + k]});
    m.logged[at + k] = m.run;
    m.memory[at + k] = from[k];
  }
}

/// Remembers that the run wrote this unit, once.
inline void NoteUnit(Registers& r, uint32_t at, uint32_t width) {
  const Unit unit{at, width};
  if (std::find(r.m.units.begin(), r.m.units.end(), unit) == r.m.units.end()) r.m.units.push_back(unit);
}

/// Remembers that the run wrote all cells, of `cell` words each, among `words` words from `at` on.
inline void NoteCells(Registers& r, uint32_t at, uint32_t words, uint32_t cell) {
  for (uint32_t k = 0; k < words; k += cell) NoteUnit(r, at + k, cell);
}

RONDO_INSTRUCTION RunSetFrame(Registers& r, const Instruction& i) {
  r.top -= i.b;
  for (uint32_t k = 0; k < i.b; ++k) r.frame[i.a + k] = r.top[k];
  return Fault::kNone;
}

RONDO_INSTRUCTION RunSetGlobal(Registers& r, const Instruction& i) {
  r.top -= i.b;
  WriteMemory(r, i.a, r.top, i.b);
  NoteCells(r, i.a, i.b, i.d == 0 ? i.b : i.d);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunSetOwn(Registers& r, const Instruction& i) {
  r.top -= i.b;
  WriteMemory(r, r.own + i.a, r.top, i.b);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunSetParam(Registers& r, const Instruction& i) {
  r.top -= i.b;
  for (uint32_t k = 0; k < i.b; ++k) r.m.params[i.a + k] = r.top[k];
  return Fault::kNone;
}

/// Pops an index and a value of `i.b` words, and writes it as that item of the array of `i.c` items at
/// `array`. Without such an item it is `Fault::kIndex`, or in a formula nothing happens.
inline Fault SetItem(Registers& r, const Instruction& i, uint32_t array, bool shared) {
  const int64_t k = ToInt(*--r.top);
  r.top -= i.b;
  if (k < 0 || static_cast<uint64_t>(k) >= i.c) {
    RONDO_TOTAL(Index);
    return Fault::kNone;
  }
  const uint32_t at = array + static_cast<uint32_t>(k) * i.b;
  WriteMemory(r, at, r.top, i.b);
  if (shared) NoteCells(r, at, i.b, i.d);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunSetGlobalAt(Registers& r, const Instruction& i) { return SetItem(r, i, i.a, true); }

RONDO_INSTRUCTION RunSetOwnAt(Registers& r, const Instruction& i) {
  return SetItem(r, i, r.own + i.a, false);
}

/// Pops a list of `i.c` items of `i.b` words, and writes them at `array`; `Fault::kIndex` if it has another
/// length.
inline Fault SetArray(Registers& r, const Instruction& i, uint32_t array, bool shared) {
  const auto items = r.m.heap[*--r.top];
  if (items.size() != static_cast<size_t>(i.b) * i.c) return Fault::kIndex;
  WriteMemory(r, array, items.data(), i.b * i.c);
  if (shared) NoteCells(r, array, i.b * i.c, i.b);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunSetGlobalArray(Registers& r, const Instruction& i) { return SetArray(r, i, i.a, true); }

RONDO_INSTRUCTION RunSetOwnArray(Registers& r, const Instruction& i) {
  return SetArray(r, i, r.own + i.a, false);
}

}  // namespace rondo::koord::semantics
