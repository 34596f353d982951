#include "solve/solver.h"

#include "expr/smtlib.h"

namespace rondo::solve {

std::string ToSmtLib(const Query& query) {
  std::vector<expr::SmtAssertion> assertions;
  for (const Assertion& a : query.assertions) assertions.push_back({a.formula, a.group});
  return expr::ToSmtLib(*query.arena, assertions);
}

}  // namespace rondo::solve
