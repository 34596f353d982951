#include "solve/icp/prepare/proof.h"

#include <fmt/format.h>

#include "expr/substitute.h"

namespace rondo::solve::icp {

using expr::Op;

Proof::Proof(const Lowered& lowered)
    : arena_(lowered.arena), printer_(lowered.arena, expr::SmtFunctions::kNamed) {
  // A truth value that has become a number.
  for (const auto& [term, variable] : lowered.variables) {
    if (variable.kind == Variable::Kind::kBool)
      printer_.Define(term, fmt::format("(ite {} 1.0 0.0)", printer_.Print(term, true)));
  }
}

// Compound terms inside others get names, so that what is shared is written once.
std::string Proof::Say(TermId term) {
  expr::VisitPostorder(arena_, term, seen_, [&](TermId t) {
    const bool scaled = arena_.op(t) == Op::kMul && arena_.IsNumber(arena_.arg(t, 0));
    const bool whole = t == term && arena_.sort_of(t) == arena_.Bool();
    if (arena_.args(t).empty() || scaled || whole || printer_.IsDefined(t)) return;
    std::string name;
    do {
      name = fmt::format("$p{}", names_++);
    } while (arena_.IsDeclared(name));
    text_ += fmt::format("(let {} {})\n", name, printer_.Print(t, true));
    printer_.Define(t, name);
  });
  return printer_.Print(term);
}

void Proof::Step(const char* head, TermId formula) {
  const std::string said = Say(formula);
  text_ += fmt::format("({} {})\n", head, said);
}

void Proof::Substitute(TermId variable, TermId value) {
  const std::string said = Say(value);
  text_ += fmt::format("(substitute {} {})\n", printer_.Print(variable, true), said);
}

void Proof::Period(TermId variable, const Rational& lo, const Rational& hi) {
  text_ += fmt::format("(period {} {} {})\n", printer_.Print(variable, true), Say(lo), Say(hi));
}

void Proof::Squares(TermId formula) { Step("squares", formula); }
void Proof::Fact(TermId formula) { Step("fact", formula); }
void Proof::Cases(TermId disjunction) { Step("cases", disjunction); }
void Proof::Case(TermId alternative) { Step("case", alternative); }

std::string Proof::Say(const Rational& value) {
  const bool negative = value < Rational(0);
  const Rational size = negative ? Rational(0) - value : value;
  const std::string text = fmt::format("(/ {}.0 {}.0)", size.Numerator(), size.Denominator());
  return negative ? fmt::format("(- {})", text) : text;
}

void Proof::Identity(const std::vector<std::pair<Rational, TermId>>& parts, const Rational& constant) {
  std::string said;
  for (const auto& [coefficient, term] : parts) said += fmt::format("({} {}) ", Say(coefficient), Say(term));
  text_ += fmt::format("(identity {}{})\n", said, Say(constant));
}

void Proof::Search(const std::vector<TermId>& variables, const std::string& tree) {
  text_ += "(search (";
  for (size_t v = 0; v < variables.size(); ++v)
    text_ += (v == 0 ? "" : " ") + printer_.Print(variables[v], true);
  text_ += fmt::format(") \"{}\")\n", tree);
}

}  // namespace rondo::solve::icp
