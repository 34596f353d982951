#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "expr/arena.h"
#include "lang/smtlib/sexpr.h"

/// Terms of SMT-LIB scripts and certificates.
namespace rondo::lang::smtlib {

/// Is a definition, `(define-fun name (parameters) sort body)`: expanded where it is used.
struct Macro {
  std::vector<std::pair<std::string, expr::SortId>> parameters;
  expr::SortId result;
  SExpr body;
};

/// Reads terms into an arena. What is wrong is reported, and an invalid TermId stands for it; reading one
/// costs no second report.
class TermReader {
 public:
  TermReader(expr::Arena& arena, diag::Diagnostics& diagnostics) : arena_(arena), diagnostics_(diagnostics) {}

  /// Returns the term that an expression denotes.
  expr::TermId Read(const SExpr& e);
  /// Returns the term, which has to be a truth value.
  expr::TermId ReadFormula(const SExpr& e);
  /// Returns the sort that an expression denotes; nothing, with a report, if it is none that is known.
  std::optional<expr::SortId> ReadSort(const SExpr& e);
  /// Returns the term as one of this sort: integers become reals where reals are asked for. Reported at `e`
  /// if it is of another sort.
  expr::TermId As(expr::TermId t, expr::SortId sort, const SExpr& e);

  /// Reports whether the name is a number, constant or operator of the language: these cannot be declared.
  static bool IsReserved(const std::string& name);
  /// Lets the name stand for the variable from now on, whatever it stood for before.
  void Declare(const SExpr& name, expr::TermId variable);
  /// Forgets every declaration and definition.
  void Forget() {
    variables_.clear();
    macros_.clear();
  }
  /// Lets the name stand for the definition from now on.
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
  /// Makes all arguments real if one is. Reports, and returns false, if one is no number.
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
