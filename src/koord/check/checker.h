#pragma once

#include <set>

#include "koord/check/check.h"

/// Declares the checker behind `Check`; only its own sources include it.
namespace rondo::koord {

/// Checks one program and makes its model; to be run once. The rules are split over files by what they are
/// about: declarations, names, expressions, calls, statements, specifications, explorations.
class Checker {
 public:
  Checker(const Program& program, diag::Diagnostics& diagnostics)
      : program_(program), exprs_(program.exprs), diagnostics_(diagnostics) {}
  /// Applies every rule, reports all violations, and returns the model.
  Model Run();

 private:
  enum class Place : uint8_t { kInit, kEvent, kFunction, kSpec };

  // declarations.cc
  void DeclareTypes();
  void DeclareAll();
  void DeclareModule(const ModuleDef& module);
  void DeclareVariable(VariableKind kind, const std::string& module, const Decl& decl);
  void DeclareFunction(const FunctionDef& def);
  bool Claim(const std::string& name, diag::Span span);
  TypeId TypeOf(const lang::TypeSyntax& syntax);
  TypeId TypeOf(const Decl& decl);
  TypeId WithDimensions(TypeId base, const std::vector<ExprId>& dimensions);
  std::string LengthOf(ExprId length);
  bool IsFixed(ExprId length) const;
  void CheckOrder();

  // names.cc
  TypeId Name(ExprId id, const lang::Expr& e);
  TypeId Field(ExprId id, const lang::Expr& e);
  TypeId Index(ExprId id, const lang::Expr& e);
  TypeId ReadVariable(ExprId id, size_t variable, RefKind kind);
  int FindVariable(const std::string& name) const;
  int FindPort(const std::string& module, const std::string& port, diag::Span span, bool report);
  bool IsModule(const std::string& name) const { return modules_.contains(name); }
  bool IsModuleName(ExprId id) const;
  TypeId FieldOf(ExprId id, const lang::Expr& e, TypeId base);
  void Undeclared(const std::string& name, diag::Span span);

  // expressions.cc
  TypeId Expr(ExprId id);
  TypeId Visit(ExprId id, const lang::Expr& e);
  TypeId Unary(const lang::Expr& e);
  TypeId Binary(const lang::Expr& e);
  TypeId Arithmetic(const lang::Expr& e, TypeId a, TypeId b);
  TypeId Comparison(const lang::Expr& e, TypeId a, TypeId b);
  TypeId Membership(const lang::Expr& e, TypeId a);
  TypeId Quantifier(ExprId id, const lang::Expr& e);
  bool IsQueue(ExprId list) const;
  bool Bounds(const lang::Expr& quantifier, const std::vector<std::string>& names) const;
  TypeId Fold(ExprId id, const lang::Expr& e);  // folds.cc
  TypeId Conditional(const lang::Expr& e);
  TypeId Any(const lang::Expr& e);
  std::optional<TypeId> TypeNamed(const std::string& word) const;
  TypeId List(const lang::Expr& e);
  void NeedBool(ExprId e, std::string_view what);
  void NeedType(ExprId e, TypeId wanted, std::string_view what);
  bool IsArrayLiteral(ExprId e, TypeId wanted) const;
  void NeedArray(ExprId e, TypeId array, std::string_view what);
  void InitialValue(size_t variable);
  TypeId Mismatch(diag::Span span, std::string message);
  void Set(ExprId id, RefKind kind, size_t index) {
    model_.ref_of[id.index()] = {kind, static_cast<uint32_t>(index)};
  }
  uint32_t Bind(const std::string& name, TypeId type, diag::Span span);

  // calls.cc
  TypeId Call(ExprId id, const lang::Expr& e);
  TypeId CallBuiltin(ExprId id, const lang::Expr& e, Builtin builtin);
  TypeId CallFunction(ExprId id, const lang::Expr& e, size_t function);
  TypeId CallMethod(ExprId id, const lang::Expr& e);
  TypeId MakeRecord(ExprId id, const lang::Expr& e, TypeId record);
  void UnknownFunction(const std::string& name, diag::Span span);
  size_t FunctionNamed(const std::string& name, size_t arity, diag::Span span);
  bool Arity(const lang::Expr& e, size_t least, size_t most, std::string_view name);
  void CheckRecursion();
  void CheckSignatures();

  // statements.cc
  void Body(const std::vector<Stmt>& body);
  void Statement(const Stmt& stmt);
  void Assign(const Stmt& stmt);
  void DeclareLocal(const Stmt& stmt);
  /// Returns the type that can be assigned; checks that writing is allowed. Invalid after a report.
  TypeId Target(ExprId id);
  TypeId TargetRoot(ExprId id, size_t variable);
  void LoopIn(const Stmt& stmt);
  void LoopRange(const Stmt& stmt);

  // fallbacks.cc
  void CheckFallback(const FallbackDef& def);
  void RestrictFallback(const FallbackDef& def, const std::vector<Stmt>& body);
  void RestrictFallback(const FallbackDef& def, ExprId e);
  std::set<size_t> SetOnEveryPath(const std::vector<Stmt>& body) const;

  // specifications.cc
  void Specifications();
  void Assume(const AssumeDef& def);
  void Summary(const SummaryDef& def);
  void Invariant(const InvariantDef& def);

  // explorations.cc
  void Explore(const ExploreEntry& entry);
  void ExploreValue(const ExploreEntry& entry);
  void ExploreVariable(const ExploreEntry& entry, size_t variable);
  void ExploreFunction(const ExploreEntry& entry);
  int FindFunction(const std::string& name) const;

  /// Reports what an initial value must not mention: anything but parameters, functions and, where each robot
  /// has its own, `pid`.
  void RestrictInitial(ExprId e, const Variable& variable);
  /// Reports each name in `e` that this kind of specification must not mention.
  void RestrictScope(ExprId e, const AssumeDef* port, std::string_view what);

  const Program& program_;
  const lang::ExprPool& exprs_;
  diag::Diagnostics& diagnostics_;
  Model model_;

  std::set<size_t> queues_;  // variables that are declared as a `Queue`
  ExprId statement_call_;    // the call that is a statement
  std::map<std::string, diag::Span> claimed_;
  std::set<std::string> modules_;
  std::map<std::string, std::pair<TypeId, uint32_t>> enum_members_;
  std::vector<const ExploreDef*> explorations_;
  std::set<uint32_t> locals_;              // bindings that are local variables
  std::vector<uint32_t> scope_;            // bindings that are visible, innermost last
  std::map<int, std::set<size_t>> calls_;  // function (-1: none) -> functions that its body calls
  Place place_ = Place::kSpec;
  int function_ = -1;
  std::string fallback_;  // the module whose fallback is being checked
  int loops_ = 0;
  int atomic_ = 0;
  bool old_allowed_ = false;
  bool may_choose_ = false;  // in the statements of an event or `init`
  TypeId grid_element_;      // of a `grid(...)`, where one may stand
  bool writing_ = false;     // the target of an assignment may be an actuator
};

}  // namespace rondo::koord
