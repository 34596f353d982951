#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "diag/diagnostic.h"
#include "koord/semantics/compile/compiler.h"
#include "koord/semantics/machine/machine.h"
#include "koord/semantics/native.h"

/// Turns a checked Koord program into code for a fixed number of robots, which simulations, explorations and
/// replays run.
namespace rondo::koord::semantics {

/// Says where in `Code` the compiled guard and body of an event begin.
struct EventCode {
  const EventDef* def;
  uint32_t guard;  ///< the entry of its `pre`; 0 if it is always enabled
  uint32_t body;
  bool urgent;
  bool locks;  ///< its body contains `atomic`
};
/// Holds a formula of the specification that is evaluated for each robot if it is about robots, else once.
struct FormulaCode {
  std::string name;
  diag::Span span;
  uint32_t entry;
  bool per_robot;
  bool at_rounds = false;  ///< an invariant that has to hold between rounds only
  ExprId body{};           ///< what it says
};
/// Holds a controller assumption (the paper's (P, Q)): if `when` holds at the end of the program transition,
/// `always` holds at every moment until the next round.
struct PromiseCode {
  std::string name;
  diag::Span span;
  uint32_t when;  ///< the entry of P; 0 if Q holds in any case
  uint32_t always;
  bool at_end = false;  ///< Q holds when the round is over
  ExprId p{}, q{};      ///< P, invalid if there is none, and Q
};
/// Holds the code of a bounded response.
struct ResponseCode {
  std::string name;
  diag::Span span;
  FormulaCode when, then;  ///< of each robot
  uint32_t rounds = 0;
};
/// Holds the code that sets a variable to its initial value.
struct InitialCode {
  size_t variable;
  uint32_t entry;
  ExprId value{};
};
/// Names a part of the specification that has no executable form, so that runs are not checked against it,
/// and says why.
struct UncheckedPart {
  std::string name;
  diag::Span span;
  std::string reason;
};

/// Says what a program is compiled for.
struct TeamOptions {
  size_t robots = 1;
  /// Gives parameters, by number of the variable, values as words that replace those in the program.
  std::map<size_t, std::vector<Word>> params;
  /// Gives variables the values that they may take, one after the other, where neither an initial value nor
  /// `explore` says so.
  std::map<size_t, std::vector<Word>> choices;
  /// Reports whether the host computes an external function, by its number; empty: it computes none.
  std::function<bool(size_t)> hosted;
};

/// Holds a program compiled for a fixed number of robots and fixed parameters (Koord paper, Figs. 5 to 9),
/// with the machine that runs it. Points into the model, which must outlive it.
class Team {
 public:
  /// Compiles the program. Returns nullptr, after a diagnostic, if it cannot be executed: a parameter has no
  /// value, say, or a function no body.
  ///
  /// @param heap  what the words of `params` and `choices` are handles into: lists and texts; the team begins with it.
  static std::unique_ptr<Team> Make(const Model& model, const TeamOptions& options,
                                    diag::Diagnostics& diagnostics, Heap heap = {});

  const Model& model() const { return model_; }
  const Code& code() const { return code_; }
  const Layout& layout() const { return *layout_; }
  /// Returns the lengths of arrays, by the texts that types have for them.
  const Lengths& lengths() const { return lengths_; }
  /// Returns the words of the parameters, in the order of the layout.
  std::span<const Word> params() const { return params_; }
  Heap& heap() { return heap_; }
  const Heap& heap() const { return heap_; }
  Machine& machine() { return *machine_; }
  /// Sets who runs events, `init` and fallbacks in place of the machine, which answers formulas still; nullptr: nobody.
  void SetNative(std::unique_ptr<Native> native) { native_ = std::move(native); }
  Native* native() const { return native_.get(); }
  size_t robots() const { return layout_->robots(); }

  const std::vector<EventCode>& events() const { return events_; }
  /// Returns the code of the fallbacks, in the order of `Model::fallbacks`: without guards.
  const std::vector<EventCode>& fallbacks() const { return fallbacks_; }
  const std::vector<uint32_t>& inits() const { return inits_; }
  const std::vector<InitialCode>& declared() const { return declared_; }
  /// Returns the code of values that follow from `assume initially: v == e`, for variables without a declared
  /// value.
  const std::vector<InitialCode>& derived() const { return derived_; }
  /// Returns, by variable, the entry of the code that pushes the list of values that `explore` declares for
  /// it.
  const std::map<size_t, uint32_t>& choices() const { return choices_; }
  const std::map<size_t, std::vector<Word>>& given_choices() const { return given_choices_; }
  const std::vector<FormulaCode>& invariants() const { return invariants_; }
  const std::vector<FormulaCode>& initially() const { return initially_; }
  const std::vector<ResponseCode>& responses() const { return responses_; }
  const std::vector<FormulaCode>& facts() const { return facts_; }
  const std::vector<FormulaCode>& port_facts() const { return port_facts_; }
  const std::vector<PromiseCode>& promises() const { return promises_; }
  const std::vector<UncheckedPart>& unchecked() const { return unchecked_; }
  const std::vector<std::pair<const Stmt*, bool>>& branches() const { return branches_; }
  /// Returns the variables that have neither a declared nor a derived value, nor choices: they start as zero,
  /// which a report should say.
  const std::vector<size_t>& zeroed() const { return zeroed_; }
  /// Reports whether some number in the program is no double and was rounded, so that runs may differ from
  /// proofs.
  bool rounds_literals() const { return code_.rounded_literals; }
  bool robots_stop() const { return robots_stop_; }
  bool has_sensors() const { return has_sensors_; }

  /// Reports whether the formula holds in the memory that the machine looks at: for every robot, if it is
  /// about robots.
  /// @param robot  gets the first robot for which it does not hold.
  /// @param defined  becomes false if an operation without a value was met on the way; the result then says
  /// nothing about the program.
  bool Holds(const FormulaCode& formula, size_t* robot = nullptr, bool* defined = nullptr);
  /// Reports whether every operation in the formula that was run last had a value.
  bool LastWasDefined() const;
  /// Returns the text of a value of log type `type` that a robot wrote to a stream.
  std::string ShowLogged(size_t type, std::span<const Word> value) const;
  TypeId TypeOfVariable(size_t variable) const { return model_.variables[variable].type; }
  /// Returns a state in which every variable is zero, empty, false or the first member of its enumeration.
  const std::vector<Word>& blank() const { return blank_; }
  /// Returns the value of a variable in a state as text for people; of the robot's own, if each robot has
  /// one.
  std::string ShowVariable(std::span<const Word> state, size_t variable, size_t robot) const;
  /// Returns what reports call a variable of a robot: `x[2]`, `Motion[2].psn`, or `sum` if all robots share
  /// it.
  std::string NameOf(size_t variable, size_t robot) const;
  /// Frees the lists and texts of the heap that occur in none of these states and are not pinned. Handles in
  /// any other state are invalid from then on.
  void Collect(std::span<const std::span<const Word>> states);

 private:
  Team(const Model& model, Heap heap) : model_(model), heap_(std::move(heap)) {}
  void MakeBlank();
  std::vector<Word> Default(TypeId type);
  std::optional<std::vector<Word>> Filled(
      const Variable& variable,
      const std::function<std::optional<std::vector<Word>>(ExprId, TypeId)>& evaluate,
      diag::Diagnostics& diagnostics);
  bool Parameters(const TeamOptions& options, diag::Diagnostics& diagnostics);
  bool Compile(const TeamOptions& options, diag::Diagnostics& diagnostics);
  void Specification(Compiler& compiler);
  void Derive(Compiler& compiler, ExprId e);
  std::optional<FormulaCode> CompileFormula(Compiler& compiler, std::string name, diag::Span span, ExprId e);

  const Model& model_;
  Heap heap_;
  Code code_;
  std::unique_ptr<Layout> layout_;
  std::unique_ptr<Machine> machine_;
  std::unique_ptr<Native> native_;
  std::vector<Word> params_;
  Lengths lengths_;
  std::vector<EventCode> events_;
  std::vector<EventCode> fallbacks_;
  std::vector<uint32_t> inits_;
  std::vector<InitialCode> declared_;
  std::vector<InitialCode> derived_;
  std::map<size_t, uint32_t> choices_;
  std::map<size_t, std::vector<Word>> given_choices_;
  std::vector<FormulaCode> invariants_;
  std::vector<FormulaCode> initially_;
  std::vector<ResponseCode> responses_;
  std::vector<FormulaCode> facts_;
  std::vector<FormulaCode> port_facts_;
  std::vector<PromiseCode> promises_;
  std::vector<UncheckedPart> unchecked_;
  std::vector<std::pair<const Stmt*, bool>> branches_;
  std::vector<TypeId> logged_;
  std::vector<size_t> zeroed_;
  std::vector<Word> blank_;
  bool robots_stop_ = false;
  bool has_sensors_ = false;
};

}  // namespace rondo::koord::semantics
