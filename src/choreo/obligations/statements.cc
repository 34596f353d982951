#include "choreo/obligations/statements.h"

#include <algorithm>

#include "choreo/obligations/facts.h"
#include "expr/defined.h"
#include "expr/substitute.h"

namespace rondo::choreo {

using expr::Rational;
using expr::TermId;

Claim Noun(const std::string& title) { return {title, title + " may not hold"}; }
Claim State(const std::string& state) { return {"a state " + state, "there is no state " + state}; }

Statements::Statements(const Graph& graph, expr::Arena& arena) : graph_(graph), arena_(arena) {
  const auto range = [&](const robot::Variable& v) {
    std::vector<TermId>& bounds = ranges_[v.term];
    if (v.least) bounds.push_back(arena_.Le(*v.least, v.term));
    if (v.most) bounds.push_back(arena_.Le(v.term, *v.most));
  };
  for (const robot::Body& body : graph_.world->bodies) {
    std::ranges::for_each(body.states, range);
    std::ranges::for_each(body.inputs, range);
  }
  std::ranges::for_each(graph_.world->environment, range);
}

void Statements::Unsat(ObligationKind kind, diag::Span span, const Claim& claim,
                       const std::vector<TermId>& formulas) {
  std::vector<TermId> others(formulas.begin(), formulas.end() - 1);
  const TermId related = Related({formulas.back()}, others);
  Add({kind,
       span,
       claim.title,
       claim.failure,
       false,
       arena_.And(related, formulas.back()),
       arena_.And(others),
       {},
       {},
       {},
       {}});
}

void Statements::Apart(ObligationKind kind, diag::Span span, const Claim& claim, robot::Meeting meeting) {
  std::vector<TermId> others{meeting.configuration};
  meeting.configuration = arena_.True();
  meeting.configuration = Related({robot::Formula(arena_, graph_.world->point, meeting)}, others);
  const TermId formula = robot::Formula(arena_, graph_.world->point, meeting);
  Add({kind,
       span,
       claim.title,
       claim.failure,
       false,
       formula,
       arena_.And(others),
       std::move(meeting),
       {},
       {},
       {}});
}

void Statements::Sat(diag::Span span, const Claim& claim, std::vector<TermId> formulas, ObligationKind kind) {
  std::vector<TermId> others;
  formulas.push_back(Related(formulas, others));
  Add({kind, span, claim.title, claim.failure, true, arena_.And(formulas), arena_.True(), {}, {}, {}, {}});
}

void Statements::Keep(diag::Span span, const Claim& claim, TermId formula, Keeping keeping) {
  Obligation o;
  o.kind = ObligationKind::kKeeping;
  o.span = span;
  o.title = claim.title;
  o.failure = claim.failure;
  o.formula = formula;
  o.rest = arena_.True();
  o.keeping = std::move(keeping);
  Add(std::move(o));
}

void Statements::Lacks(diag::Span span, std::string what, bool region) {
  const bool said = std::ranges::any_of(result_.missing, [&](const Missing& m) { return m.what == what; });
  if (!said) result_.missing.push_back({span, std::move(what), region});
}

// What is plain is not stated. Equal formulas are one only if what else is known is the same: a contradiction
// there would prove the one and not the other.
void Statements::Add(Obligation obligation) {
  obligation.nodes.assign(node.valid() ? 1 : 0, node);
  obligation.instances = instances;
  obligation.bridge = bridge;
  if (!obligation.keeping && obligation.formula == arena_.Constant(obligation.satisfiable)) return;
  const auto [it, fresh] = known_.try_emplace({obligation.formula, obligation.rest}, result_.all.size());
  if (!fresh) {
    Obligation& same = result_.all[it->second];
    same.bridge = same.bridge && bridge;
    std::vector<NodeId>& nodes = same.nodes;
    // What is about no node in particular stays so.
    if (!node.valid()) nodes.clear();
    if (!nodes.empty() && std::ranges::find(nodes, node) == nodes.end()) nodes.push_back(node);
    return;
  }
  result_.all.push_back(std::move(obligation));
}

const std::set<TermId>& Statements::VariablesOf(TermId formula) {
  const auto it = variables_.find(formula);
  if (it != variables_.end()) return it->second;
  return variables_.emplace(formula, robot::VariablesOf(arena_, {formula})).first->second;
}

TermId Statements::Related(const std::vector<TermId>& roots, std::vector<TermId>& formulas) {
  std::vector<TermId> open;
  for (const TermId f : formulas) {
    const Conjunction parts = Conjuncts(arena_, f);
    open.insert(open.end(), parts.begin(), parts.end());
  }
  std::set<TermId> variables;
  for (const TermId root : roots) variables.insert(VariablesOf(root).begin(), VariablesOf(root).end());
  std::vector<TermId> related = TakeConnected(
      variables, open, [this](TermId part) -> const std::set<TermId>& { return VariablesOf(part); });
  formulas = std::move(open);
  std::ranges::sort(related);
  for (const TermId v : variables) related.push_back(RangeOf(v));
  return arena_.And(related);
}

TermId Statements::RangeOf(TermId variable) const {
  const auto it = ranges_.find(variable);
  return it == ranges_.end() ? arena_.True() : arena_.And(it->second);
}

TermId Statements::Fails(TermId formula) const { return expr::Complement(arena_, formula); }

TermId Statements::NoneOf(const std::vector<TermId>& formulas) const {
  std::vector<TermId> all;
  for (const TermId f : formulas) all.push_back(Fails(f));
  return arena_.And(all);
}

TermId Statements::Number(const Rational& value) const { return arena_.Number(arena_.Real(), value); }

TermId Statements::AtClock(TermId formula, const Rational& seconds) const {
  return expr::Substitute(arena_, formula, {{graph_.world->clock, Number(seconds)}});
}

TermId Statements::Elapsed(const Duration& d) const {
  const TermId clock = graph_.world->clock;
  const TermId from = arena_.Le(Number(0), clock);
  return d.most ? arena_.And(from, arena_.Le(clock, Number(*d.most))) : from;
}

TermId Statements::Ended(const Duration& d) const {
  return arena_.And(Elapsed(d), arena_.Le(Number(d.least), graph_.world->clock));
}

}  // namespace rondo::choreo
