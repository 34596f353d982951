#pragma once

#include <functional>
#include <span>
#include <vector>

#include "koord/semantics/machine/code.h"
#include "koord/semantics/machine/layout.h"

namespace rondo::koord::semantics {

/// What a program cannot know by itself: external functions, and where its streams go.
class Host {
 public:
  Host() = default;
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;
  virtual ~Host() = default;
  /// Computes external function `f` for a robot. `result` is zero on entry. false: it has no value there.
  virtual bool Call(size_t f, size_t robot, std::span<const Word> arguments, std::span<Word> result) = 0;
  /// `stream << value`: the value of log type `type`.
  virtual void Log(size_t robot, size_t type, std::span<const Word> value) = 0;
};

/// Executes code. Allocates only when a new list or text comes into being.
class Machine {
 public:
  Machine(const Code& code, const Layout& layout, Heap& heap);

  /// Where the words of the state are; `old`: those at the end of the program transition, for `old(...)`.
  void SetMemory(Word* memory, const Word* old = nullptr) {
    memory_ = memory;
    old_ = old == nullptr ? memory : old;
  }
  void SetHost(Host* host) { host_ = host; }
  /// What `any` takes: a number below that of the possibilities. Without a chooser, the first one.
  using Chooser = std::function<uint64_t(uint64_t possibilities)>;
  void SetChooser(Chooser chooser) { chooser_ = std::move(chooser); }
  void SetShow(std::function<std::string(size_t, std::span<const Word>)> show) { show_ = std::move(show); }
  std::vector<Word>& params() { return params_; }
  const std::vector<Word>& params() const { return params_; }

  /// Runs the code at `entry` for `robot`. What it pushed is in `result`. false: it cannot be completed; see
  /// `fault`. Formulas are total: `total` gives operations without a value the value zero.
  bool Run(uint32_t entry, size_t robot, bool total);
  bool RunFormula(uint32_t entry, size_t robot) { return Run(entry, robot, true) && stack_[0] != 0; }
  std::span<const Word> result() const { return {stack_.data(), top_}; }

  /// Did the last total run meet an operation without a value, and take zero for it?
  bool used_default() const { return used_default_; }

  Fault fault() const { return fault_; }
  diag::Span fault_span() const { return fault_span_; }
  bool locked() const { return locked_; }
  bool stopped() const { return stopped_; }

  /// What the last run wrote, in order: the address and what was there before.
  struct Write {
    uint32_t at;
    Word before;
  };
  /// A variable, or a cell of an array, that every robot may write.
  struct Unit {
    uint32_t at;
    uint32_t width;
    friend bool operator==(Unit, Unit) = default;
  };
  const std::vector<Write>& writes() const { return writes_; }
  const std::vector<Unit>& units() const { return units_; }
  /// Another robot holds the lock of the event: `atomic` ends the run with `Fault::kNoLock`.
  void SetLockTaken(bool taken) { lock_taken_ = taken; }
  /// Takes the writes of the last run back.
  void Undo();

  /// Check calls against summaries? The first summary that was violated since the last `ForgetSummary`, or
  /// -1.
  void CheckSummaries(bool check) { check_summaries_ = check; }
  int violated_summary() const { return violated_summary_; }
  void ForgetSummary() { violated_summary_ = -1; }
  /// Which branches were taken so far.
  std::vector<bool>& marks() { return marks_; }

 private:
  bool Stop(Fault fault, size_t at);

  const Code& code_;
  const Layout& layout_;
  Heap& heap_;
  Host* host_ = nullptr;
  std::function<std::string(size_t, std::span<const Word>)> show_;
  Chooser chooser_;
  std::vector<Word> params_;
  std::vector<Word> stack_;
  std::vector<Word> frame_;
  std::vector<uint32_t> calls_;
  std::vector<Word> buffer_;
  size_t top_ = 0;
  Word* memory_ = nullptr;
  const Word* old_ = nullptr;
  std::vector<Write> writes_;
  std::vector<Unit> units_;
  std::vector<bool> marks_;
  Fault fault_ = Fault::kNone;
  diag::Span fault_span_;
  bool used_default_ = false;
  std::vector<uint32_t> logged_;  // by address: the run that wrote it last
  uint32_t run_ = 0;
  bool locked_ = false;
  bool lock_taken_ = false;
  bool stopped_ = false;
  bool check_summaries_ = false;
  bool in_summary_ = false;
  int violated_summary_ = -1;
};

}  // namespace rondo::koord::semantics
