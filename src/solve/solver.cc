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

AnswerKind KindOf(const Answer& answer) {
  if (std::holds_alternative<Unsat>(answer)) return AnswerKind::kUnsat;
  if (std::holds_alternative<Sat>(answer)) return AnswerKind::kSat;
  return std::holds_alternative<DeltaSat>(answer) ? AnswerKind::kDeltaSat : AnswerKind::kUnknown;
}

std::string_view Name(AnswerKind kind) {
  switch (kind) {
    case AnswerKind::kUnsat:
      return "unsat";
    case AnswerKind::kSat:
      return "sat";
    case AnswerKind::kDeltaSat:
      return "delta-sat";
    case AnswerKind::kUnknown:
      return "unknown";
  }
  return "";
}

bool IsDefinite(const Answer& answer) {
  return std::holds_alternative<Sat>(answer) || std::holds_alternative<Unsat>(answer);
}

}  // namespace rondo::solve
