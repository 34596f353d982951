#pragma once

#include <functional>
#include <span>
#include <vector>

#include "koord/semantics/machine/host.h"
#include "koord/semantics/machine/registers.h"

namespace rondo::koord::semantics {

/// Executes code. Allocates only when a new list or text comes into being.
class Machine {
 public:
  Machine(const Code& code, const Layout& layout, Heap& heap);

  /// Where the words of the state are; `old`: those at the end of the program transition, for `old(...)`.
  void SetMemory(Word* memory, const Word* old = nullptr) {
    state_.memory = memory;
    state_.old = old == nullptr ? memory : old;
  }
  void SetHost(Host* host) { state_.host = host; }
  /// What `any` takes: a number below that of the possibilities. Without a chooser, the first one.
  using Chooser = std::function<uint64_t(uint64_t possibilities)>;
  void SetChooser(Chooser chooser) { state_.chooser = std::move(chooser); }
  void SetShow(std::function<std::string(size_t, std::span<const Word>)> show) {
    state_.show = std::move(show);
  }
  std::vector<Word>& params() { return state_.params; }
  const std::vector<Word>& params() const { return state_.params; }

  /// Runs the code at `entry` for `robot`. What it pushed is in `result`. false: it cannot be completed; see
  /// `fault`. Formulas are total: `total` gives operations without a value the value zero.
  bool Run(uint32_t entry, size_t robot, bool total);
  bool RunFormula(uint32_t entry, size_t robot) { return Run(entry, robot, true) && stack_[0] != 0; }
  std::span<const Word> result() const { return {stack_.data(), top_}; }

  /// Did the last total run meet an operation without a value, and take zero for it?
  bool used_default() const { return state_.used_default; }

  Fault fault() const { return fault_; }
  diag::Span fault_span() const { return fault_span_; }
  bool locked() const { return state_.locked; }
  bool stopped() const { return state_.stopped; }

  using Write = semantics::Write;
  using Unit = semantics::Unit;
  /// What the last run wrote, in order.
  const std::vector<Write>& writes() const { return state_.writes; }
  /// What it wrote of what every robot may write, each once.
  const std::vector<Unit>& units() const { return state_.units; }
  /// Another robot holds the lock of the event: `atomic` ends the run with `Fault::kNoLock`.
  void SetLockTaken(bool taken) { state_.lock_taken = taken; }
  /// Takes the writes of the last run back.
  void Undo();

  /// Check calls against summaries? The first summary that was violated since the last `ForgetSummary`, or
  /// -1.
  void CheckSummaries(bool check) { state_.check_summaries = check; }
  int violated_summary() const { return state_.violated_summary; }
  void ForgetSummary() { state_.violated_summary = -1; }
  /// Which branches were taken so far.
  std::vector<bool>& marks() { return state_.marks; }

 private:
  MachineState state_;
  std::vector<Word> stack_;
  std::vector<Word> frame_;
  size_t top_ = 0;
  Fault fault_ = Fault::kNone;
  diag::Span fault_span_;
};

}  // namespace rondo::koord::semantics
