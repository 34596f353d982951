#include "koord/prove/obligations/problem.h"

#include <algorithm>

#include "expr/lists.h"
#include "expr/substitute.h"
#include "koord/check/spec_labels.h"
#include "solve/instantiate.h"

namespace rondo::koord {

using solve::Assertion;

Problems::Problems(expr::Arena& arena, const Model& model, const Options& options,
                   diag::Diagnostics& diagnostics)
    : arena_(arena),
      model_(model),
      options_(options),
      vocabulary_(arena, model, options.robots),
      executor_(vocabulary_, diagnostics, ExecutionOptions{.expand_robots = options.expand}),
      theory_(vocabulary_, executor_),
      round_(vocabulary_, executor_, Round::Kind::kEvents) {
  if (!model.inits.empty()) init_.emplace(vocabulary_, executor_, Round::Kind::kInit);
  robot_ = options.expand ? arena.IntNumber(0) : arena.FreshConstant("robot", arena.Int());
}

std::vector<TermId> Problems::Everyone() {
  std::vector<TermId> result;
  if (options_.expand) {
    for (int64_t r = 0; r < *options_.robots; ++r) result.push_back(arena_.IntNumber(r));
  }
  return result;
}

// The negation of `goal` for arbitrary but fixed values of its universal variables.
TermId Problems::Refute(TermId goal) {
  switch (arena_.op(goal)) {
    case expr::Op::kForall: {
      const std::vector<TermId> args(arena_.args(goal).begin(), arena_.args(goal).end());
      expr::Substitution map;
      for (size_t i = 0; i + 1 < args.size(); ++i) {
        map[args[i]] = arena_.FreshConstant("some " + arena_.symbol(arena_.symbol_of(args[i])).name,
                                            arena_.sort_of(args[i]));
      }
      return Refute(Substitute(arena_, args.back(), map));
    }
    case expr::Op::kAnd:
    case expr::Op::kOr: {
      const bool conjunction = arena_.op(goal) == expr::Op::kAnd;
      std::vector<TermId> parts;
      for (const TermId part : std::vector<TermId>(arena_.args(goal).begin(), arena_.args(goal).end()))
        parts.push_back(Refute(part));
      return conjunction ? arena_.Or(parts) : arena_.And(parts);
    }
    default:
      return arena_.Not(goal);  // nothing universal is in sight
  }
}

const std::vector<Assertion>& Problems::Everything(const View& view, bool between_rounds) {
  std::vector<Assertion>& result = everything_[{view.stopped, between_rounds}];
  if (result.empty()) {
    result = theory_.Invariants(view, between_rounds);
    Append(result, theory_.PortFacts(view));
  }
  return result;
}

solve::Query Problem::Whole() const {
  solve::Query whole = query;
  if (!complete) whole.assertions.insert(whole.assertions.end(), assertions.begin(), assertions.end());
  return whole;
}

Problem Problems::Ground(std::vector<Assertion> assertions, std::vector<TermId> participants) {
  // The background comes last: only now is it known which literals are in use.
  if (background_.empty()) background_ = theory_.Background();
  Append(assertions, background_);
  for (const TermId fold : executor_.Folds()) assertions.push_back({fold, ""});
  if (!options_.expand) {
    if (!extremes_) extremes_.emplace(vocabulary_);
    Append(assertions, extremes_->Axioms(assertions));
  }
  Problem problem;
  problem.participants = std::move(participants);
  problem.assertions = std::move(assertions);
  Instantiate(problem);
  return problem;
}

// Instances bring new list terms, whose axioms bring new quantifiers: repeat until nothing new comes up.
void Problems::Instantiate(Problem& problem) {
  std::vector<TermId> fallback = problem.participants;
  fallback.push_back(robot_);
  // There always is a first robot and a last one: where a goal denies that somebody exists, that helps.
  const bool denies = !problem.assertions.empty() && arena_.HasQuantifier(problem.assertions[0].formula);
  if (denies) {
    fallback.push_back(arena_.IntNumber(0));
    fallback.push_back(arena_.Sub(vocabulary_.robots(), arena_.IntNumber(1)));
  }
  for (int pass = 0; pass < 4; ++pass) {
    solve::Ground ground =
        solve::Instantiate(arena_, problem.assertions, {{arena_.Int(), fallback}}, limits, witnesses_);
    const std::vector<TermId> axioms =
        expr::ListAxioms(arena_, solve::Formulas(ground.assertions), problem.lists);
    problem.query.arena = &arena_;
    problem.query.assertions = std::move(ground.assertions);
    problem.complete = ground.complete;
    if (axioms.empty()) break;
    for (const TermId axiom : axioms) problem.assertions.push_back({axiom, ""});
  }
  if (vocabulary_.uses_dist()) AddDistances(problem);
  if (vocabulary_.uses_roundings()) {
    for (const TermId axiom : Roundings(vocabulary_).Axioms(solve::Formulas(problem.query.assertions))) {
      problem.query.assertions.push_back({axiom, ""});
      problem.assertions.push_back({axiom, ""});
    }
  }
}

// What is known of distances speaks of further distances, but of no further points: soon there is no more to
// say.
void Problems::AddDistances(Problem& problem) {
  Distances known(vocabulary_, distances);
  std::vector<TermId> formulas = solve::Formulas(problem.query.assertions);
  constexpr int kPasses = 4;
  for (int pass = 0; pass < kPasses && !formulas.empty(); ++pass) {
    formulas = known.Axioms(formulas);
    for (const TermId axiom : formulas) {
      problem.query.assertions.push_back({axiom, ""});
      problem.assertions.push_back({axiom, ""});
    }
  }
}

Problem Problems::Initially(size_t invariant) {
  const View& first = round_.start();
  const TermId refuted = Refute(theory_.Invariant(invariant, first));
  return WithWitnesses(refuted,
                       [&](const std::vector<TermId>& others) { return InitiallyFor(refuted, others); });
}

Problem Problems::InitiallyFor(TermId refuted, const std::vector<TermId>& others) {
  const View& first = round_.start();
  std::vector<Assertion> assertions{{refuted, ""}};
  std::vector<TermId> participants = Everyone();
  if (init_) {
    Append(assertions, init_->Relate(refuted, Everyone(), others));
    Append(assertions, theory_.DeclaredValues(init_->start()));
    participants = init_->participants();
  } else {
    Append(assertions, theory_.DeclaredValues(first));
  }
  Append(assertions, theory_.Initially(first));
  Append(assertions, theory_.PortFacts(first));
  return Ground(std::move(assertions), std::move(participants));
}

// `action` is taken by somebody whose state the goal reads, and nobody of those takes an earlier one.
TermId Problems::First(Round& round, size_t action) {
  std::vector<TermId> facts;
  std::vector<TermId> somebody;
  for (const TermId r : round.readers()) {
    somebody.push_back(round.Acts(r, action));
    std::vector<TermId> allowed{round.Acts(r, 0)};
    for (size_t a = action; action > 0 && a < columns(); ++a) allowed.push_back(round.Acts(r, a));
    facts.push_back(arena_.Or(allowed));
  }
  if (action > 0) facts.push_back(arena_.Or(somebody));
  return arena_.And(facts);
}

// No operation fails in what the participants do: a counterexample is a round that can be completed.
TermId Problems::Succeeds(Round& round) {
  std::vector<TermId> facts;
  for (const TermId r : round.participants()) {
    for (size_t a = 1; a < columns(); ++a) {
      for (const DefinednessCheck& c : round.EffectOf(a, r).checks) {
        facts.push_back(arena_.Or({arena_.Not(round.Acts(r, a)), arena_.Not(c.reached), c.holds}));
      }
    }
  }
  return arena_.And(facts);
}

// A goal that denies that somebody exists says nothing of a robot in particular. Those who may show the
// contrary are the robots that existed before, those that participants read (`x[(w + 1) % N_sys]`), and last
// writers: all whose state the instances mention become participants.
Problem Problems::WithWitnesses(TermId refuted,
                                const std::function<Problem(const std::vector<TermId>&)>& state) {
  std::vector<TermId> others;
  Problem problem = state(others);
  constexpr int kPasses = 2;
  constexpr size_t kMostOthers = 16;
  // Of a number of robots, those who are counted are named by what is known of it.
  const bool unnamed = arena_.HasQuantifier(refuted) || executor_.MentionsFold(refuted);
  for (int pass = 0; pass < kPasses && unnamed && !options_.expand; ++pass) {
    const size_t before = others.size();
    for (const TermId robot : Witnesses(problem)) {
      if (others.size() < kMostOthers) others.push_back(robot);
    }
    if (others.size() == before) break;
    problem = state(others);
  }
  return problem;
}

Problem Problems::Step(size_t invariant, std::optional<size_t> action, bool reachable) {
  const TermId refuted = Refute(theory_.Invariant(invariant, round_.end()));
  return WithWitnesses(refuted, [&](const std::vector<TermId>& others) {
    return StepFor(round_, refuted, others, action, reachable, model_.invariants[invariant]->at_rounds);
  });
}

Round& Problems::cut_off(CutOffLimits leaves_out) {
  return cut_offs_
      .try_emplace({leaves_out.acts_at_once, leaves_out.runs_urgent}, vocabulary_, executor_,
                   Round::Kind::kCutOff, leaves_out)
      .first->second;
}

Problem Problems::CutOff(size_t invariant, std::optional<size_t> action, CutOffLimits leaves_out,
                         bool reachable) {
  Round& round = cut_off(leaves_out);
  const TermId refuted = Refute(theory_.Invariant(invariant, round.end()));
  return WithWitnesses(refuted, [&](const std::vector<TermId>& others) {
    return StepFor(round, refuted, others, action, reachable, model_.invariants[invariant]->at_rounds);
  });
}

bool Problems::HasCases(size_t invariant) {
  round_.Relate(Refute(theory_.Invariant(invariant, round_.end())), {});
  return !round_.readers().empty();
}

// Robots whose state occurs in the query and that are no participants.
std::vector<TermId> Problems::Witnesses(const Problem& problem) {
  std::unordered_set<TermId> arrays;
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    if (!model_.variables[v].PerRobot() || model_.variables[v].function >= 0) continue;
    arrays.insert(round_.start().value[v]);
    arrays.insert(round_.end().value[v]);
    if (init_) arrays.insert(init_->start().value[v]);
  }
  arrays.insert(round_.start().stopped);
  arrays.insert(round_.end().stopped);
  std::vector<TermId> result;
  std::unordered_set<TermId> seen;
  const auto add = [&](const std::vector<TermId>& known, TermId robot) {
    if (std::find(known.begin(), known.end(), robot) == known.end() &&
        std::find(result.begin(), result.end(), robot) == result.end())
      result.push_back(robot);
  };
  for (const Assertion& a : problem.query.assertions) {
    expr::VisitPostorder(arena_, a.formula, seen, [&](TermId t) {
      if (arena_.op(t) == expr::Op::kSelect && arrays.contains(arena_.arg(t, 0)) && !arena_.IsOpen(t))
        add(problem.participants, arena_.arg(t, 1));
    });
  }
  return result;
}

Problem Problems::StepFor(Round& round, TermId refuted, const std::vector<TermId>& others,
                          std::optional<size_t> action, bool reachable, bool at_rounds) {
  std::vector<Assertion> assertions{{refuted, ""}};
  Append(assertions, round.Relate(refuted, Everyone(), others));
  if (at_rounds) assertions.push_back({round.moved(), ""});  // the round is over
  const std::vector<TermId> participants = round.participants();
  if (action) assertions.push_back({First(round, *action), ""});
  if (options_.expand) assertions.push_back({Succeeds(round), ""});
  for (const TermId r : participants) {
    std::vector<Assertion>& promises = promises_[{&round, r, at_rounds}];
    if (promises.empty()) promises = theory_.PortPromises(round, r, at_rounds);
    for (const Assertion& p : promises)
      assertions.push_back({arena_.Implies(vocabulary_.IsRobot(r), p.formula), p.group});
  }
  Append(assertions, Everything(round.start(), true));
  for (const View& moment : round.moments()) Append(assertions, theory_.PortFacts(moment));
  if (reachable) {
    Append(assertions, theory_.DeclaredValues(round.start()));
    Append(assertions, theory_.Initially(round.start()));
  }
  return Ground(std::move(assertions), participants);
}

Problem Problems::Follows(size_t invariant, const std::vector<size_t>& premises) {
  const View& view = round_.start();
  std::vector<Assertion> assertions{{Refute(theory_.Invariant(invariant, view)), ""}};
  for (const size_t p : premises) {
    // What holds between rounds only is no reason for what holds at each moment.
    if (model_.invariants[p]->at_rounds && !model_.invariants[invariant]->at_rounds) continue;
    assertions.push_back({theory_.Invariant(p, view), "invariant " + InvariantName(model_, p)});
  }
  Append(assertions, theory_.PortFacts(view));
  return Ground(std::move(assertions), Everyone());
}

}  // namespace rondo::koord
