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
  // One variable for all folds of a depth, so that the same body is the same term wherever it is written.
  if (fold_depth_ == fold_robots_.size()) fold_robots_.push_back(arena_.FreshBound("robot", arena_.Int()));
  const TermId robot = fold_robots_[fold_depth_];
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
  ++fold_depth_;
  const TermId body = As(Eval(e.args[0]), sort);
  --fold_depth_;
  conditions_.pop_back();
  quantified_.pop_back();
  std::unordered_set<TermId> occurring;
  std::unordered_set<TermId> bound{robot};  // by quantifiers in the body: their variables are not free in it
  expr::VisitPostorder(arena_, body, occurring, [&](TermId t) {
    if (arena_.op(t) != expr::Op::kForall && arena_.op(t) != expr::Op::kExists) return;
    const auto args = arena_.args(t);
    bound.insert(args.begin(), args.end() - 1);
  });
  std::erase_if(around, [&](TermId t) { return bound.contains(t) || !occurring.contains(t); });
  const TermId value = Defined(kind, robot, body, around);
  if (around.empty() && (kind == FoldKind::kCount || kind == FoldKind::kSum))
    Compare(kind, id, {robot, body, value});
  return value;
}

// How the numbers of one fold at different moments differ, by who changed: finite sums change by what their parts do.
void Executor::Compare(FoldKind kind, ExprId id, const Additive& now) {
  if (arena_.sort(arena_.sort_of(now.value)).kind == expr::SortKind::kRecord) return;
  constexpr size_t kMoments = 6;
  std::vector<Additive>& others = additive_[id];
  if (others.size() >= kMoments || std::ranges::find(others, now.value, &Additive::value) != others.end())
    return;
  if (kind == FoldKind::kSum) Signs(now);
  for (const Additive& before : others) {
    if (!compared_.emplace(std::min(before.value, now.value), std::max(before.value, now.value)).second)
      continue;
    if (kind == FoldKind::kCount) {
      Changes(before, now);
      Changes(now, before);
    } else {
      Differences(before, now);
      Grows(before, now);
      Grows(now, before);
    }
  }
  others.push_back(now);
}

TermId Executor::SomeRobot(const char* name) {
  const expr::SymbolId symbol = arena_.Fresh(name, {}, arena_.Int());
  fold_functions_.insert(symbol);
  return arena_.Variable(symbol);
}

TermId Executor::Of(const Additive& fold, TermId robot) {
  return Substitute(arena_, fold.body, expr::Substitution{{fold.robot, robot}});
}

// A sum is positive (negative) only if a part is.
void Executor::Signs(const Additive& sum) {
  const TermId zero = arena_.Number(arena_.sort_of(sum.value), expr::Rational(0));
  const TermId plus = SomeRobot("positive");
  const TermId minus = SomeRobot("negative");
  folds_.push_back(arena_.Or(arena_.Le(sum.value, zero),
                             arena_.And(vocabulary_.IsRobot(plus), arena_.Lt(zero, Of(sum, plus)))));
  folds_.push_back(arena_.Or(arena_.Le(zero, sum.value),
                             arena_.And(vocabulary_.IsRobot(minus), arena_.Lt(Of(sum, minus), zero))));
}

// If anybody is so, the first is; and who is so is the first of them, or there is another one.
void Executor::OneOrTwo(const std::function<TermId(TermId)>& is_so, TermId first, TermId another) {
  const TermId robot = fold_robots_[0];
  folds_.push_back(arena_.Forall(
      {robot}, arena_.Or(arena_.Not(is_so(robot)),
                         arena_.And(is_so(first), arena_.Or(arena_.Eq(robot, first), another)))));
}

// Of two counts: the later grows only if a robot joins, by one if a second one does not, and as a whole if none leaves.
void Executor::Changes(const Additive& from, const Additive& to) {
  const TermId first = SomeRobot("joins");
  const TermId second = SomeRobot("joins too");
  const TermId leaver = SomeRobot("leaves");
  const auto joins = [&](TermId r) {
    return arena_.And({vocabulary_.IsRobot(r), arena_.Not(Of(from, r)), Of(to, r)});
  };
  const TermId leaves =
      arena_.And({vocabulary_.IsRobot(leaver), Of(from, leaver), arena_.Not(Of(to, leaver))});
  const TermId longer = arena_.Add(from.value, arena_.IntNumber(1));
  const TermId another = arena_.And(joins(second), arena_.Not(arena_.Eq(first, second)));
  OneOrTwo(joins, first, another);
  folds_.push_back(arena_.Or(arena_.Le(to.value, from.value), joins(first)));
  folds_.push_back(arena_.Or(arena_.Le(to.value, longer), another));
  folds_.push_back(arena_.Or({arena_.Not(joins(first)), arena_.Le(longer, to.value), leaves}));
}

// Of two sums: the later grows only if a part does.
void Executor::Grows(const Additive& from, const Additive& to) {
  const TermId grows = SomeRobot("grows");
  folds_.push_back(
      arena_.Or(arena_.Le(to.value, from.value),
                arena_.And(vocabulary_.IsRobot(grows), arena_.Lt(Of(from, grows), Of(to, grows)))));
}

// Of two sums: they differ only if a part does, and by what it differs if no second one does.
void Executor::Differences(const Additive& a, const Additive& b) {
  const TermId first = SomeRobot("differs");
  const TermId second = SomeRobot("differs too");
  const auto differs = [&](TermId r) {
    return arena_.And(vocabulary_.IsRobot(r), arena_.Not(arena_.Eq(Of(a, r), Of(b, r))));
  };
  const TermId another = arena_.And(differs(second), arena_.Not(arena_.Eq(first, second)));
  OneOrTwo(differs, first, another);
  folds_.push_back(arena_.Or(arena_.Eq(a.value, b.value), differs(first)));
  folds_.push_back(
      arena_.Or(arena_.Eq(arena_.Sub(b.value, a.value), arena_.Sub(Of(b, first), Of(a, first))), another));
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
