#pragma once

#include <functional>
#include <span>
#include <vector>

#include "koord/semantics/machine/host.h"
#include "koord/semantics/machine/registers.h"

/// Runs compiled Koord programs, one event or formula at a time.
namespace rondo::koord::semantics {

/// Executes code on the words of a state. Allocates only when a new list or text comes into being, or to
/// remember more writes than in any run before. Not thread-safe: each thread needs a machine and a heap of
/// its own.
class Machine {
 public:
  Machine(const Code& code, const Layout& layout, Heap& heap);

  /// Sets the state that runs read and write. `old`: the one at the end of the program transition, for
  /// `old(...)`; without it, the same. Both must outlive the runs.
  void SetMemory(Word* memory, const Word* old = nullptr) {
    state_.memory = memory;
    state_.old = old == nullptr ? memory : old;
  }
  /// Returns the state that was set last.
  const Word* memory() const { return state_.memory; }
  /// Sets who computes external functions and receives what is logged; nullptr: nobody.
  void SetHost(Host* host) { state_.host = host; }
  Host* host() const { return state_.host; }
  /// Chooses for `any`: returns a number below `possibilities`. Without a chooser, `any` takes the first.
  using Chooser = std::function<uint64_t(uint64_t possibilities)>;
  void SetChooser(Chooser chooser) { state_.chooser = std::move(chooser); }
  /// Sets how a value of a log type becomes text, where programs join texts and values.
  void SetShow(std::function<std::string(size_t, std::span<const Word>)> show) {
    state_.show = std::move(show);
  }
  /// Returns the words of the parameters, in the order of the layout.
  std::vector<Word>& params() { return state_.params; }
  const std::vector<Word>& params() const { return state_.params; }

  /// Runs the code at `entry` for `robot`; what it pushed is in `result`. Returns false if it cannot be
  /// completed: `fault` says why, and what was written stays until `Undo`.
  /// @param total  gives operations without a value the value zero, as formulas need it, and notes that in
  /// `used_default`.
  bool Run(uint32_t entry, size_t robot, bool total);
  /// Runs a formula; returns whether it is true. False as well if it could not be completed.
  bool RunFormula(uint32_t entry, size_t robot) { return Run(entry, robot, true) && stack_[0] != 0; }
  /// Returns the words that the last run pushed; valid until the next one.
  std::span<const Word> result() const { return {stack_.data(), top_}; }

  /// Reports whether the last total run met an operation without a value, and took zero for it.
  bool used_default() const { return state_.used_default; }

  /// Returns why the last run could not be completed, and where in the program; kNone if it could.
  Fault fault() const { return fault_; }
  diag::Span fault_span() const { return fault_span_; }
  /// Reports whether the last run took the lock of its event (`atomic`), and whether it executed `stop`.
  bool locked() const { return state_.locked; }
  bool stopped() const { return state_.stopped; }

  using Write = semantics::Write;
  using Unit = semantics::Unit;
  /// Returns the addresses that the last run wrote and what was there before, each once, in order of the
  /// first write.
  const std::vector<Write>& writes() const { return state_.writes; }
  /// Returns the variables and cells that every robot may write and that the last run wrote, each once.
  const std::vector<Unit>& units() const { return state_.units; }
  /// Says whether runs remember what they write to streams; `said` returns that of the last one. For who has to
  /// know first whether the event counts.
  void KeepSaid(bool keep) { state_.keep_said = keep; }
  const std::vector<Said>& said() const { return state_.said; }
  /// Says whether another robot holds the lock of the event: then `atomic` ends a run with `Fault::kNoLock`.
  void SetLockTaken(bool taken) { state_.lock_taken = taken; }
  /// Restores what the last run wrote to what was there before.
  void Undo();

  /// Says whether to check calls against summaries. `violated_summary` returns the first summary that was
  /// violated since the last `ForgetSummary`, or -1.
  void CheckSummaries(bool check) { state_.check_summaries = check; }
  int violated_summary() const { return state_.violated_summary; }
  void ForgetSummary() { state_.violated_summary = -1; }
  /// Returns, by number of the branch, whether any run so far took it.
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
