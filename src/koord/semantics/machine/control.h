#pragma once

#include "koord/semantics/machine/host.h"
#include "koord/semantics/machine/registers.h"

/// Carries out the instructions that say what comes next (jumps, loops, calls) and those that leave the
/// machine: the host, locks, logs. `ops.def` says what each does.
namespace rondo::koord::semantics {

/// Continues with the instruction number `at`.
inline void GoTo(Registers& r, uint32_t at) { r.next = r.m.code.instructions.data() + at; }

RONDO_INSTRUCTION RunJump(Registers& r, const Instruction& i) {
  GoTo(r, i.a);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunJumpUnless(Registers& r, const Instruction& i) {
  if (*--r.top == 0) GoTo(r, i.a);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunJumpIf(Registers& r, const Instruction& i) {
  if (*--r.top != 0) GoTo(r, i.a);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunForNext(Registers& r, const Instruction& i) {
  if (++r.steps > kMostSteps) return Fault::kRunaway;
  const int64_t next = ToInt(r.frame[i.a]) + 1;
  r.frame[i.a] = FromInt(next);
  if (next < ToInt(r.frame[i.b])) GoTo(r, i.c);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunCall(Registers& r, const Instruction& i) {
  if (++r.steps > kMostSteps) return Fault::kRunaway;
  r.m.calls.push_back(static_cast<uint32_t>(r.next - r.m.code.instructions.data()));
  GoTo(r, r.m.code.function_entry[i.a]);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunReturn(Registers& r, const Instruction&) {
  GoTo(r, r.m.calls.back());
  r.m.calls.pop_back();
  return Fault::kNone;
}

/// Has the host compute function `i.a` of `i.b` words of arguments, and pushes its `i.c` words.
RONDO_INSTRUCTION RunExternal(Registers& r, const Instruction& i) {
  r.top -= i.b;
  r.m.buffer.assign(i.c, 0);
  std::vector<Word> result;
  result.swap(r.m.buffer);
  const Answer answer =
      r.m.host == nullptr ? Answer::kNone : r.m.host->Call(i.a, r.robot, {r.top, i.b}, result);
  if (answer == Answer::kLater && !r.total) return Fault::kNotYet;
  if (answer != Answer::kValue) RONDO_TOTAL(External);
  for (const Word w : result) *r.top++ = w;
  r.m.buffer.swap(result);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunSummaryBegin(Registers& r, const Instruction& i) {
  if (!r.m.check_summaries || r.m.in_summary || r.total) {
    GoTo(r, i.a);
  } else {
    r.m.in_summary = true;
    r.total = true;
  }
  return Fault::kNone;
}

RONDO_INSTRUCTION RunSummaryTest(Registers& r, const Instruction& i) {
  if (*--r.top == 0 && r.m.violated_summary < 0) r.m.violated_summary = static_cast<int>(i.a);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunSummaryEnd(Registers& r, const Instruction&) {
  r.m.in_summary = false;
  r.total = false;
  return Fault::kNone;
}

RONDO_INSTRUCTION RunLock(Registers& r, const Instruction&) {
  if (r.m.lock_taken) return Fault::kNoLock;
  r.m.locked = true;
  return Fault::kNone;
}

RONDO_INSTRUCTION RunStop(Registers& r, const Instruction&) {
  r.m.stopped = true;
  return Fault::kNone;
}

RONDO_INSTRUCTION RunFault(Registers& r, const Instruction& i) {
  if (!r.total) return static_cast<Fault>(i.a);
  r.m.used_default = true;
  return Fault::kNone;
}

RONDO_INSTRUCTION RunOld(Registers& r, const Instruction&) {
  r.memory = r.m.old;
  return Fault::kNone;
}

RONDO_INSTRUCTION RunNow(Registers& r, const Instruction&) {
  r.memory = r.m.memory;
  return Fault::kNone;
}

RONDO_INSTRUCTION RunLog(Registers& r, const Instruction& i) {
  r.top -= i.b;
  if (r.m.host != nullptr) r.m.host->Log(r.robot, i.a, {r.top, i.b});
  if (r.m.keep_said) r.m.said.push_back({i.a, {r.top, r.top + i.b}});
  return Fault::kNone;
}

RONDO_INSTRUCTION RunMark(Registers& r, const Instruction& i) {
  r.m.marks[i.a] = true;
  return Fault::kNone;
}

}  // namespace rondo::koord::semantics
