#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "koord/check/model.h"
#include "koord/semantics/compile/domains.h"
#include "koord/semantics/compile/element.h"
#include "koord/semantics/machine/code.h"
#include "koord/semantics/machine/layout.h"

/// Compiles checked Koord expressions and statements to the instructions of `Machine`.
namespace rondo::koord::semantics {

/// Says which formula or part of an event has no executable form, and why.
struct Unsupported {
  diag::Span span;
  std::string reason;
};

/// Turns expressions and statements into code for one layout. Each function that returns a number appends
/// code and returns its entry, for `Machine::Run`. The rules are split over files by what they are about:
/// expressions, quantifiers, calls, statements.
class Compiler {
 public:
  Compiler(const Model& model, const Layout& layout, Heap& heap, Code& code);

  /// Compiles code that pushes the value of `e`, converted to `type`.
  uint32_t Expression(ExprId e, TypeId type);
  /// Compiles code that pushes the truth value of a formula.
  uint32_t Formula(ExprId e) { return Expression(e, model_.types.boolean()); }
  /// Compiles code that runs the statements from top to bottom.
  uint32_t Statements(const std::vector<Stmt>& body);
  /// Compiles code that sets variable `v` of the robot that runs it, or the one of all robots, to the value
  /// of `e`.
  uint32_t Initial(size_t v, ExprId e);
  /// Compiles the functions that are called so far and have no code yet. `Expression`, `Statements` and
  /// `Initial` end with it.
  void Functions();

  /// Reports whether what was compiled last mentions the robot that it is about: `pid`, or what each robot
  /// has its own of.
  bool used_robot() const { return used_robot_; }
  /// Reports whether the statements that were compiled last contain `atomic`.
  bool locks() const { return locks_; }
  /// Returns why what was compiled last cannot be executed, and forgets it; nothing if it can.
  std::optional<Unsupported> TakeUnsupported();
  /// Returns, by number of the branch, the statement, and whether it is its `else`.
  const std::vector<std::pair<const Stmt*, bool>>& branches() const { return branches_; }
  /// Returns, by log type (an operand of kLog and kShow), the type of the value that is written.
  const std::vector<TypeId>& logged() const { return logged_; }
  /// Reports whether some statement compiled so far assigns this variable.
  bool assigned(size_t variable) const { return assigned_.contains(variable); }
  /// Returns the functions without a body that the code calls, by number.
  const std::vector<size_t>& externals() const { return externals_; }
  /// Returns the summaries that cannot be evaluated, so that calls are not checked against them, with the
  /// reasons.
  const std::map<size_t, Unsupported>& unchecked_summaries() const { return unchecked_summaries_; }

 private:
  uint32_t Width(TypeId type) const { return Layout::Width(model_.types, type); }
  size_t Emit(Op op, size_t a = 0, size_t b = 0, size_t c = 0, size_t d = 0);
  size_t Here() const { return code_.instructions.size(); }
  void Patch(size_t at) { code_.instructions[at].a = static_cast<uint32_t>(Here()); }
  void Constant(Word word);
  void Fail(diag::Span span, std::string reason);
  uint32_t FrameOf(uint32_t binding);
  uint32_t NewFrame(uint32_t width);
  void Begin();

  // compile_expressions.cc
  void Gen(ExprId e);
  void GenAs(ExprId e, TypeId type);
  void Convert(TypeId from, TypeId to);
  void Unary(const lang::Expr& e);
  void Binary(ExprId id, const lang::Expr& e);
  void Junction(const lang::Expr& e);
  void Conditional(ExprId id, const lang::Expr& e);
  void Comparison(const lang::Expr& e);
  void Arithmetic(ExprId id, const lang::Expr& e);
  void Membership(const lang::Expr& e);
  void ReadVariable(size_t variable);
  void ReadCell(size_t variable);
  void Index(ExprId id);
  void Slice(ExprId base, uint32_t field);
  /// Pushes the number of the item, or of the array of items, among those of its kind.
  void FlatIndex(const Element& element);
  size_t ItemsBehind(const Layout::Place& place, size_t indices) const;
  size_t ShapeBehind(const Layout::Place& place, size_t indices);
  uint32_t FieldOffset(TypeId record, uint32_t field) const;

  // compile_quantifiers.cc
  void Quantifier(ExprId id, const lang::Expr& e);
  void Fold(ExprId id, const lang::Expr& e);
  void Loop(const std::vector<Bound>& all, size_t i, ExprId body, bool forall, std::vector<size_t>& decided);
  void Range(const std::vector<Limit>& limits, Op pick, uint32_t slot);

  // compile_calls.cc
  void Call(ExprId id, const lang::Expr& e);
  void CallFunction(const lang::Expr& e, size_t function);
  void CallPlain(size_t function, uint32_t argument_words, uint32_t result_words);
  void CallBuiltin(const lang::Expr& e, Builtin builtin, TypeId type);

  // compile_statements.cc
  void Body(const std::vector<Stmt>& body);
  void Execute(const Stmt& stmt);
  void Log(const Stmt& stmt);
  void If(const Stmt& stmt);
  void LoopIn(const Stmt& stmt);
  void LoopRange(const Stmt& stmt);
  void LoopWhile(const Stmt& stmt);
  void LoopBody(const Stmt& stmt, uint32_t index, uint32_t end, const std::vector<size_t>& before);
  void Assign(ExprId target);
  void Store(size_t variable);
  void Method(const Stmt& stmt);
  void Mark(const Stmt* stmt, bool otherwise);

  const Model& model_;
  const lang::ExprPool& exprs_;
  const Layout& layout_;
  Heap& heap_;
  Code& code_;
  diag::Span span_;
  std::map<uint32_t, uint32_t> frames_;
  bool used_robot_ = false;
  bool locks_ = false;
  bool in_summary_ = false;
  std::optional<Unsupported> unsupported_;
  std::map<size_t, Unsupported> unchecked_summaries_;
  std::vector<std::pair<const Stmt*, bool>> branches_;
  std::vector<TypeId> logged_;
  std::vector<size_t> externals_;
  std::set<size_t> assigned_;
  std::vector<size_t> wanted_;  // functions whose code is still to be made
  struct LoopJumps {
    std::vector<size_t> breaks;
    std::vector<size_t> continues;
  };
  std::vector<LoopJumps> loops_;
  std::vector<size_t> returns_;  // jumps to the end of the statements
  int function_ = -1;            // whose body is being compiled
};

}  // namespace rondo::koord::semantics
