#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "diag/diagnostic.h"
#include "koord/semantics/compile/compiler.h"
#include "koord/semantics/machine/machine.h"

namespace rondo::koord::semantics {

struct EventCode {
  const EventDef* def;
  uint32_t guard;  ///< 0: always enabled
  uint32_t body;
  bool urgent;
  bool locks;  ///< contains `atomic`
};
/// A formula that is evaluated for each robot, or once.
struct FormulaCode {
  std::string name;
  diag::Span span;
  uint32_t entry;
  bool per_robot;
};
/// A controller assumption: where `when` holds at the end of the program transition, `always` holds until the
/// next round.
struct PromiseCode {
  std::string name;
  diag::Span span;
  uint32_t when;  ///< 0: always
  uint32_t always;
};
struct InitialCode {
  size_t variable;
  uint32_t entry;
};
/// A part of the specification that has no executable form: runs are not checked against it.
struct UncheckedPart {
  std::string name;
  diag::Span span;
  std::string reason;
};

struct TeamOptions {
  size_t robots = 1;
  /// Values of parameters, as words, instead of those in the program.
  std::map<size_t, std::vector<Word>> params;
  /// Values that a variable may take, one after the other, where `explore` declares none.
  std::map<size_t, std::vector<Word>> choices;
  /// External functions that the host computes.
  std::function<bool(size_t)> hosted;
};

/// A program compiled for a fixed number of robots and fixed parameters (Koord paper, Figs. 5 to 9). Points
/// into the model, which must outlive it.
class Team {
 public:
  /// nullptr, after a diagnostic, if the program cannot be executed: a parameter has no value, a function no
  /// body.
  static std::unique_ptr<Team> Make(const Model& model, const TeamOptions& options,
                                    diag::Diagnostics& diagnostics);

  const Model& model() const { return model_; }
  const Layout& layout() const { return *layout_; }
  Heap& heap() { return heap_; }
  const Heap& heap() const { return heap_; }
  Machine& machine() { return *machine_; }
  size_t robots() const { return layout_->robots(); }

  const std::vector<EventCode>& events() const { return events_; }
  const std::vector<uint32_t>& inits() const { return inits_; }
  const std::vector<InitialCode>& declared() const { return declared_; }
  /// From `assume initially: v == e`, for variables without a declared value.
  const std::vector<InitialCode>& derived() const { return derived_; }
  /// By variable: the code that pushes the list of values that `explore` declares.
  const std::map<size_t, uint32_t>& choices() const { return choices_; }
  const std::map<size_t, std::vector<Word>>& given_choices() const { return given_choices_; }
  const std::vector<FormulaCode>& invariants() const { return invariants_; }
  const std::vector<FormulaCode>& initially() const { return initially_; }
  const std::vector<FormulaCode>& facts() const { return facts_; }
  const std::vector<FormulaCode>& port_facts() const { return port_facts_; }
  const std::vector<PromiseCode>& promises() const { return promises_; }
  const std::vector<UncheckedPart>& unchecked() const { return unchecked_; }
  const std::vector<std::pair<const Stmt*, bool>>& branches() const { return branches_; }
  /// Variables that have neither a declared nor a derived value, nor choices: they start as zero.
  const std::vector<size_t>& zeroed() const { return zeroed_; }
  /// Is some number in the program no double?
  bool rounds_literals() const { return code_.rounded_literals; }
  bool robots_stop() const { return robots_stop_; }
  bool has_sensors() const { return has_sensors_; }

  /// Does the formula hold in the memory that the machine looks at? For every robot, if it is about robots;
  /// `robot` is then the first for which it does not.
  /// `defined`: no operation without a value was met on the way.
  bool Holds(const FormulaCode& formula, size_t* robot = nullptr, bool* defined = nullptr);
  std::string ShowLogged(size_t type, std::span<const Word> value) const;
  TypeId TypeOfVariable(size_t variable) const { return model_.variables[variable].type; }
  /// A state in which every variable is zero, empty or false.
  const std::vector<Word>& blank() const { return blank_; }
  /// The value of a variable in a state, for people.
  std::string ShowVariable(std::span<const Word> state, size_t variable, size_t robot) const;
  /// `x[2]`, `Motion[2].psn`, `sum`
  std::string NameOf(size_t variable, size_t robot) const;
  /// Frees the values that none of these states contains.
  void Collect(std::span<const std::span<const Word>> states);

 private:
  explicit Team(const Model& model) : model_(model) {}
  void MakeBlank();
  std::vector<Word> Default(TypeId type);
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
  std::vector<Word> params_;
  Lengths lengths_;
  std::vector<EventCode> events_;
  std::vector<uint32_t> inits_;
  std::vector<InitialCode> declared_;
  std::vector<InitialCode> derived_;
  std::map<size_t, uint32_t> choices_;
  std::map<size_t, std::vector<Word>> given_choices_;
  std::vector<FormulaCode> invariants_;
  std::vector<FormulaCode> initially_;
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
