#include <algorithm>

#include "expr/substitute.h"
#include "koord/prove/execution/executor.h"

namespace rondo::koord {

namespace {

constexpr int64_t kMostSpelledOut = 64;

bool IsLeast(FoldKind kind) { return kind == FoldKind::kMin || kind == FoldKind::kArgmin; }
bool IsWhose(FoldKind kind) { return kind == FoldKind::kArgmin || kind == FoldKind::kArgmax; }

}  // namespace

// Over robots: each of them when N_sys is a small number, else a function of what is free in the body, of which `folds_`
// says what it is.
TermId Executor::Fold(ExprId id, const lang::Expr& e) {
  const FoldKind kind = *FoldOf(e.text);
  const uint32_t binding = model_.domains.at(id).bindings[0][0];
  const SortId sort = kind == FoldKind::kCount ? arena_.Bool() : vocabulary_.SortOf(model_.TypeOf(e.args[0]));
  const auto fixed = vocabulary_.fixed_robots();
  if (fixed && *fixed <= kMostSpelledOut) {
    std::vector<TermId> values;
    for (int64_t r = 0; r < *fixed; ++r) {
      frame_.bindings[binding] = arena_.IntNumber(r);
      values.push_back(As(Eval(e.args[0]), sort));
    }
    return Folded(kind, values);
  }
  // One variable for each fold, so that the same body is the same term.
  TermId& robot = fold_robots_[id];
  if (!robot.valid()) robot = arena_.FreshBound(model_.bindings[binding].name, arena_.Int());
  // What is free around the fold: variables of quantifiers, and those of summaries.
  std::vector<TermId> around = quantified_;
  for (const auto& [_, value] : frame_.bindings) {
    const bool variable = arena_.op(value) == expr::Op::kVariable && arena_.IsOpen(value);
    if (variable && std::ranges::find(around, value) == around.end()) around.push_back(value);
  }
  if (frame_.robot.valid() && !arena_.IsNumber(frame_.robot)) around.push_back(frame_.robot);
  frame_.bindings[binding] = robot;
  quantified_.push_back(robot);
  conditions_.push_back(vocabulary_.IsRobot(robot));
  const TermId body = As(Eval(e.args[0]), sort);
  conditions_.pop_back();
  quantified_.pop_back();
  std::unordered_set<TermId> occurring;
  expr::VisitPostorder(arena_, body, occurring, [](TermId) {});
  std::erase_if(around, [&](TermId t) { return !occurring.contains(t); });
  return Defined(kind, robot, body, around);
}

TermId Executor::Folded(FoldKind kind, const std::vector<TermId>& values) {
  if (kind == FoldKind::kCount || kind == FoldKind::kSum) {
    TermId sum;
    for (const TermId v : values) {
      const TermId one = kind == FoldKind::kSum ? v : arena_.Ite(v, arena_.IntNumber(1), arena_.IntNumber(0));
      sum = sum.valid() ? Plus(sum, one) : one;
    }
    return sum;
  }
  TermId best = values[0];
  TermId whose = arena_.IntNumber(0);
  for (size_t r = 1; r < values.size(); ++r) {
    const TermId better = IsLeast(kind) ? arena_.Lt(values[r], best) : arena_.Lt(best, values[r]);
    whose = arena_.Ite(better, arena_.IntNumber(static_cast<int64_t>(r)), whose);
    best = arena_.Ite(better, values[r], best);
  }
  return IsWhose(kind) ? whose : best;
}

// Numbers or points.
TermId Executor::Plus(TermId a, TermId b) {
  if (arena_.sort(arena_.sort_of(a)).kind != expr::SortKind::kRecord) return arena_.Add(a, b);
  std::vector<TermId> parts;
  for (uint32_t i = 0; i < 3; ++i) parts.push_back(arena_.Add(arena_.Field(a, i), arena_.Field(b, i)));
  return arena_.MakeRecord(arena_.sort_of(a), std::move(parts));
}

bool Executor::MentionsFold(TermId formula) const {
  bool found = false;
  std::unordered_set<TermId> seen;
  expr::VisitPostorder(arena_, formula, seen, [&](TermId t) {
    const expr::Op op = arena_.op(t);
    if (op == expr::Op::kApply || op == expr::Op::kVariable)
      found = found || fold_functions_.contains(arena_.symbol_of(t));
  });
  return found;
}

TermId Executor::Defined(FoldKind kind, TermId robot, TermId body, const std::vector<TermId>& parameters) {
  const auto [it, fresh] = folded_.try_emplace({kind, body, parameters});
  if (!fresh) return it->second;
  std::vector<SortId> sorts;
  for (const TermId p : parameters) sorts.push_back(arena_.sort_of(p));
  const auto function = [&](const char* name, SortId sort) {
    const expr::SymbolId symbol = arena_.Fresh(name, sorts, sort);
    fold_functions_.insert(symbol);
    return arena_.Apply(symbol, parameters);
  };
  const auto of = [&](TermId r) { return Substitute(arena_, body, expr::Substitution{{robot, r}}); };
  const auto all = [&](TermId what) {
    return arena_.Forall({robot}, arena_.Implies(vocabulary_.IsRobot(robot), what));
  };
  std::vector<TermId> facts;
  if (kind == FoldKind::kCount || kind == FoldKind::kSum) {
    vocabulary_.MarkTexts();  // a model may take another number
    if (kind == FoldKind::kSum) {
      it->second = function("sum", arena_.sort_of(body));
      return it->second;
    }
    // Of a number of robots it is known whether it is none, one, more, or all.
    const TermId count = function("count", arena_.Int());
    const TermId one = function("counted", arena_.Int());
    const TermId other = function("counted too", arena_.Int());
    const TermId missing = function("not counted", arena_.Int());
    const auto number = [&](int64_t n) { return arena_.IntNumber(n); };
    const TermId second = arena_.FreshBound("second", arena_.Int());
    facts = {
        arena_.Le(number(0), count),
        arena_.Le(count, vocabulary_.robots()),
        arena_.Implies(arena_.Le(count, number(0)), all(arena_.Not(body))),
        arena_.Implies(arena_.Le(number(1), count), arena_.And(vocabulary_.IsRobot(one), of(one))),
        arena_.Implies(arena_.Le(count, number(1)),
                       arena_.Forall({robot, second},
                                     arena_.Or({arena_.Not(vocabulary_.IsRobot(robot)),
                                                arena_.Not(vocabulary_.IsRobot(second)), arena_.Not(body),
                                                arena_.Not(of(second)), arena_.Eq(robot, second)}))),
        arena_.Implies(arena_.Le(number(2), count), arena_.And({vocabulary_.IsRobot(other), of(other),
                                                                arena_.Not(arena_.Eq(one, other))})),
        arena_.Implies(arena_.Le(vocabulary_.robots(), count), all(body)),
        arena_.Implies(arena_.Lt(count, vocabulary_.robots()),
                       arena_.And(vocabulary_.IsRobot(missing), arena_.Not(of(missing))))};
    it->second = count;
  } else {
    const TermId whose = function("whose", arena_.Int());
    const TermId best = of(whose);
    const TermId bound = IsLeast(kind) ? arena_.Le(best, body) : arena_.Le(body, best);
    facts = {vocabulary_.IsRobot(whose),
             all(arena_.And(bound, arena_.Implies(arena_.Eq(body, best), arena_.Le(whose, robot))))};
    it->second = IsWhose(kind) ? whose : best;
  }
  // For all values of what is free.
  expr::Substitution bound;
  std::vector<TermId> variables;
  for (const TermId p : parameters) {
    variables.push_back(arena_.FreshBound("any", arena_.sort_of(p)));
    bound[p] = variables.back();
  }
  for (const TermId fact : facts) {
    const TermId closed = Substitute(arena_, fact, bound);
    folds_.push_back(variables.empty() ? closed : arena_.Forall(variables, closed));
  }
  return it->second;
}

}  // namespace rondo::koord
