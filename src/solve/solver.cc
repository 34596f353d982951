#include "solve/solver.h"

namespace rondo::solve {

std::vector<expr::TermId> Formulas(const std::vector<Assertion>& assertions) {
  std::vector<expr::TermId> formulas;
  for (const Assertion& a : assertions) formulas.push_back(a.formula);
  return formulas;
}

std::string ToSmtLib(const Query& query, expr::SmtFunctions functions) {
  std::vector<expr::SmtAssertion> assertions;
  for (const Assertion& a : query.assertions) assertions.push_back({a.formula, a.group});
  return expr::ToSmtLib(*query.arena, assertions, functions);
}

}  // namespace rondo::solve
