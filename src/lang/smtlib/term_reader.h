#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "expr/arena.h"
#include "lang/smtlib/sexpr.h"

namespace rondo::lang::smtlib {

/// `(define-fun name (parameters) sort body)`: expanded where it is used.
struct Macro {
  std::vector<std::pair<std::string, expr::SortId>> parameters;
  expr::SortId result;
  SExpr body;
};

/// Reads terms. An invalid TermId stands for what was reported.
class TermReader {
 public:
  TermReader(expr::Arena& arena, diag::Diagnostics& diagnostics) : arena_(arena), diagnostics_(diagnostics) {}

  expr::TermId Read(const SExpr& e);
  expr::TermId ReadFormula(const SExpr& e);
  std::optional<expr::SortId> ReadSort(const SExpr& e);
  /// Integers become reals where reals are asked for.
  expr::TermId As(expr::TermId t, expr::SortId sort, const SExpr& e);

  /// Numbers, constants and operators of the language: they cannot be declared.
  static bool IsReserved(const std::string& name);
  void Declare(const SExpr& name, expr::TermId variable);
  /// Forgets every declaration and definition.
  void Forget() {
    variables_.clear();
    macros_.clear();
  }
  void Define(const SExpr& name, Macro macro);

 private:
  using TermId = expr::TermId;
  using Args = std::vector<TermId>;

  TermId Symbol(const SExpr& e);
  TermId Application(const SExpr& e);
  TermId Let(const SExpr& e);
  TermId Expand(const SExpr& e, const Macro& macro, Args args);
  // nullopt: the operator is none of this family.
  using Family = std::optional<TermId> (TermReader::*)(const SExpr& e, const Args& args);
  std::optional<TermId> Logic(const SExpr& e, const Args& args);
  std::optional<TermId> Arithmetic(const SExpr& e, const Args& given);
  std::optional<TermId> Function(const SExpr& e, const Args& given);
  TermId Power(const SExpr& e, TermId base, TermId exponent);
  TermId Compare(const SExpr& e, const Args& args);
  TermId Bounded(TermId t, const SExpr& e);
  bool Count(const SExpr& e, const Args& args, size_t least, size_t most);
  bool IsNumeric(TermId t) const;
  TermId Real(TermId t);
  /// All real if one is; nothing if one is no number.
  bool Unify(const SExpr& e, Args& args);
  TermId Wrong(const SExpr& e, const std::string& message);
  TermId Number(const expr::Rational& value) { return arena_.Number(arena_.Real(), value); }

  expr::Arena& arena_;
  diag::Diagnostics& diagnostics_;
  std::map<std::string, TermId, std::less<>> variables_;
  std::map<std::string, Macro, std::less<>> macros_;
  std::vector<std::map<std::string, TermId, std::less<>>> scopes_;  // of let and of parameters
  std::vector<uint32_t> depths_;                                    // by term
  std::vector<uint64_t> factors_;                                   // of products, by term
  size_t expansions_ = 0;
  size_t scope_floor_ = 0;  // parameters hide what is around a use of a macro
};

}  // namespace rondo::lang::smtlib
