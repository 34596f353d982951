#include "reach/problem/centred.h"

#include "expr/substitute.h"
#include "reach/problem/bounds.h"
#include "verdict/truth.h"

namespace rondo::reach {

namespace {

struct Sides {
  std::optional<Rational> least, most;
};

// What the comparisons that must hold at the start say about single states, exactly.
class Reader {
 public:
  explicit Reader(const Problem& problem)
      : p_(problem), arena_(*problem.arena), sides_(problem.states.size()) {}

  std::vector<Sides> Run() {
    auto formula = Normalise(arena_, p_.assume);
    if (!formula.ok()) return std::move(sides_);
    for (const TermId term : Necessary(formula.value())) {
      for (size_t i = 0; i < sides_.size(); ++i) Read(term, i);
    }
    return std::move(sides_);
  }

 private:
  // term <= 0, if it is linear in this state alone.
  void Read(TermId term, size_t state) {
    const auto line = LineIn(arena_, term, p_.states[state]);
    if (!line || !arena_.IsNumber(line->rest)) return;
    const Rational bound = Rational(0) - arena_.number(line->rest) / line->slope;
    Sides& s = sides_[state];
    if (line->slope > Rational(0)) {
      if (!s.most || bound < *s.most) s.most = bound;
    } else if (!s.least || bound > *s.least) {
      s.least = bound;
    }
  }

  const Problem& p_;
  expr::Arena& arena_;
  std::vector<Sides> sides_;
};

// What every state of the box satisfies need not be assumed: ranges that are far away.
TermId Needed(const Problem& problem) {
  expr::Arena& arena = *problem.arena;
  std::vector<TermId> open{problem.assume};
  std::vector<TermId> needed;
  while (!open.empty()) {
    const TermId f = open.back();
    open.pop_back();
    if (arena.op(f) == expr::Op::kAnd) {
      open.insert(open.end(), arena.args(f).begin(), arena.args(f).end());
      continue;
    }
    auto formula = Normalise(arena, f);
    if (formula.ok()) {
      const auto terms = Compile(arena, problem.states, formula.value().terms);
      if (terms.ok() && CheckBox(terms.value(), formula.value(), problem.initial) == verdict::Truth::kTrue)
        continue;
    }
    needed.push_back(f);
  }
  return arena.And(needed);
}

}  // namespace

CentredProblem Centred(const Problem& problem) {
  expr::Arena& arena = *problem.arena;
  CentredProblem result{problem, std::vector<Rational>(problem.states.size(), Rational(0))};
  Problem& centred = result.problem;
  const std::vector<Sides> sides = Reader(problem).Run();
  expr::Substitution from_middle;
  for (size_t i = 0; i < problem.states.size(); ++i) {
    const bool copy = i < problem.copy_of.size() && problem.copy_of[i].has_value();
    const Sides& s = sides[copy ? *problem.copy_of[i] : i];
    if (!s.least || !s.most) continue;
    // Only where the box is what these bounds say: it must not become larger.
    if (problem.initial[i].lo != Enclose(*s.least).lo || problem.initial[i].hi != Enclose(*s.most).hi)
      continue;
    const Rational middle = (*s.least + *s.most) / Rational(2);
    result.origin[i] = middle;
    from_middle.emplace(problem.states[i], arena.Add(problem.states[i], arena.Number(arena.Real(), middle)));
    centred.initial[i] = {Enclose(*s.least - middle).lo, Enclose(*s.most - middle).hi};
    if (i < problem.pinned.size() && problem.pinned[i]) centred.pinned[i] = *problem.pinned[i] - middle;
    const TermId back = arena.Number(arena.Real(), Rational(0) - middle);
    const auto moved = [&](std::vector<std::optional<TermId>>& updates) {
      if (updates[i]) updates[i] = arena.Add(*updates[i], back);
    };
    if (centred.controller) moved(centred.controller->updates);
    for (Event& e : centred.events) moved(e.updates);
  }
  const auto change = [&](TermId& term) { term = expr::Substitute(arena, term, from_middle); };
  const auto change_all = [&](std::vector<std::optional<TermId>>& updates) {
    for (auto& u : updates) {
      if (u) change(*u);
    }
  };
  for (TermId& rate : centred.rates) change(rate);
  if (centred.controller) change_all(centred.controller->updates);
  for (Event& e : centred.events) {
    change(e.condition);
    change_all(e.updates);
  }
  change(centred.assume);
  centred.assume = Needed(centred);
  for (Claim& c : centred.claims) change(c.formula);
  return result;
}

}  // namespace rondo::reach
