#pragma once

#include <z3++.h>

#include <optional>
#include <unordered_map>

#include "expr/arena.h"
#include "expr/value.h"

/// Terms in Z3, and values back.
namespace rondo::solve::z3 {

/// Translates terms to Z3 expressions of one context, and values of that context back. Not thread-safe.
class Translator {
 public:
  Translator(const expr::Arena& arena, ::z3::context& context) : arena_(arena), context_(context) {}

  /// Returns the term as an expression; equal subterms are translated once.
  ::z3::expr operator()(expr::TermId term);

  /// Returns a rational number near an evaluated expression that is an irrational algebraic number; else
  /// nothing.
  std::optional<expr::Rational> Near(const ::z3::expr& value);
  /// Returns the value of an evaluated expression of this sort. Throws z3::exception when it is not a value,
  /// e.g. an irrational algebraic number.
  expr::Value Read(const ::z3::expr& value, expr::SortId sort);

 private:
  struct SortInfo {
    ::z3::sort sort;
    ::z3::func_decl_vector constructors;  // record: one; enumeration: one for each member
    ::z3::func_decl_vector fields;
  };
  const SortInfo& Sort(expr::SortId id);
  ::z3::func_decl Function(expr::SymbolId id);
  ::z3::func_decl ListFunction(expr::TermId term);
  ::z3::expr Power(expr::TermId exponent, const ::z3::expr& base);
  ::z3::expr Build(expr::TermId term, const ::z3::expr_vector& args);
  ::z3::expr_vector Args(expr::TermId term);

  const expr::Arena& arena_;
  ::z3::context& context_;
  std::unordered_map<expr::SortId, SortInfo> sorts_;
  std::unordered_map<expr::SymbolId, ::z3::func_decl> functions_;
  std::unordered_set<expr::TermId> seen_;
  std::unordered_map<expr::TermId, ::z3::expr> terms_;
};

}  // namespace rondo::solve::z3
