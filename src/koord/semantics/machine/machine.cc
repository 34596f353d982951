#include "koord/semantics/machine/machine.h"

#include "koord/semantics/machine/comparisons.h"
#include "koord/semantics/machine/control.h"
#include "koord/semantics/machine/grids.h"
#include "koord/semantics/machine/lists.h"
#include "koord/semantics/machine/loads.h"
#include "koord/semantics/machine/numbers.h"
#include "koord/semantics/machine/points.h"
#include "koord/semantics/machine/stores.h"

namespace rondo::koord::semantics {

namespace {

// How many words an instruction can push.
size_t Pushes(const Instruction& i) {
  switch (i.op) {
    case Op::kParam:
    case Op::kGlobal:
    case Op::kOwn:
    case Op::kCell:
    case Op::kGlobalAt:
    case Op::kOwnAt:
    case Op::kFrame:
    case Op::kReplace:
    case Op::kUnpack:
      return i.b;
    case Op::kExternal:
      return i.c;
    case Op::kListAt:
    case Op::kAnyItem:
      return i.a;
    default:
      return 3;
  }
}

}  // namespace

Machine::Machine(const Code& code, const Layout& layout, Heap& heap) : state_{code, layout, heap} {
  size_t depth = 64;
  for (const Instruction& i : code.instructions) depth += Pushes(i);
  stack_.resize(depth);
  frame_.resize(code.frame_words + 1);
  state_.params.resize(layout.param_words());
  state_.logged.resize(layout.words());
}

void Machine::Undo() {
  for (auto it = state_.writes.rbegin(); it != state_.writes.rend(); ++it) state_.memory[it->at] = it->before;
  state_.writes.clear();
  state_.units.clear();
}

bool Machine::Run(uint32_t entry, size_t robot, bool total) {
  MachineState& m = state_;
  m.writes.clear();
  m.units.clear();
  m.said.clear();
  m.calls.clear();
  m.locked = m.stopped = m.in_summary = m.used_default = false;
  if (++m.run == 0) {
    std::fill(m.logged.begin(), m.logged.end(), 0);
    m.run = 1;
  }
  fault_ = Fault::kNone;
  const Instruction* const code = m.code.instructions.data();
  Registers r{m, stack_.data(), frame_.data(), m.memory, m.layout.block(robot), robot, total,
              0, code + entry};
  while (true) {
    const Instruction& i = *r.next++;
    Fault fault = Fault::kNone;
    // One switch, every function inlined: what compilers make fast.
    switch (i.op) {
      case Op::kEnd:
        top_ = static_cast<size_t>(r.top - stack_.data());
        return true;
#define RONDO_OP(name)       \
  case Op::k##name:          \
    fault = Run##name(r, i); \
    break;
#include "koord/semantics/machine/ops.def"
#undef RONDO_OP
    }
    if (fault == Fault::kNone) [[likely]]
      continue;
    fault_ = fault;
    fault_span_ = m.code.spans[static_cast<size_t>(&i - code)];
    top_ = 0;
    m.in_summary = false;
    return false;
  }
}

}  // namespace rondo::koord::semantics
