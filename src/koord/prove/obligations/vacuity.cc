#include <algorithm>

#include "expr/lists.h"
#include "expr/substitute.h"
#include "koord/check/spec_labels.h"
#include "koord/prove/obligations/problem.h"
#include "solve/instantiate.h"

namespace rondo::koord {

using solve::Assertion;

Problem Problems::ImpossibleSummary(size_t f) {
  Problem problem;
  problem.query.arena = &arena_;
  problem.query.assertions = {{theory_.NoResult(f), ""},
                              {arena_.Le(arena_.IntNumber(1), vocabulary_.robots()), ""}};
  for (const Assertion& a : theory_.Facts()) problem.query.assertions.push_back(a);
  problem.assertions = problem.query.assertions;
  return problem;
}

Problem Problems::SomeInitialState() {
  std::vector<Assertion> assertions{{vocabulary_.IsRobot(robot_), ""}};
  const View& first = round_.start();
  if (init_) {
    // The state of one robot after `init` is enough to meet what is assumed of each.
    Append(assertions, init_->Relate(arena_.True(), {robot_}));
    Append(assertions, theory_.DeclaredValues(init_->start()));
  } else {
    Append(assertions, theory_.DeclaredValues(first));
  }
  Append(assertions, theory_.Initially(first));
  Append(assertions, theory_.PortFacts(first));
  return Ground(std::move(assertions), {});
}

Problem Problems::SomeValues(size_t action) {
  std::vector<Assertion> assertions{{vocabulary_.IsRobot(robot_), ""}};
  const Effect& effect = round_.EffectOf(action, robot_);
  // Mentions each value that the action computes, so that the summaries of the functions it calls come into
  // play.
  std::vector<TermId> mentioned = effect.value;
  mentioned.push_back(effect.enabled);
  for (const TermId value : mentioned) {
    if (value.valid())
      assertions.push_back({arena_.Eq(arena_.FreshConstant("value", arena_.sort_of(value)), value), ""});
  }
  Append(assertions, theory_.PortFacts(round_.start()));
  return Ground(std::move(assertions), {});
}

Problem Problems::SomeEnabled(size_t action) {
  std::vector<Assertion> assertions{{vocabulary_.IsRobot(robot_), ""},
                                    {round_.EffectOf(action, robot_).enabled, ""}};
  Append(assertions, Everything(round_.start(), true));
  return Ground(std::move(assertions), {});
}

// The environment moves sensors only.
void Problems::ActuatorsStay(std::vector<Assertion>& assertions) {
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    if (model_.variables[v].kind != VariableKind::kActuator) continue;
    assertions.push_back({arena_.Eq(arena_.Select(round_.end().value[v], robot_),
                                    arena_.Select(round_.start().value[v], robot_)),
                          ""});
  }
}

Problem Problems::SomePromise(size_t p, bool with) {
  const Theory::Promise promise = theory_.Promises(round_.start(), round_.end(), robot_)[p];
  std::vector<Assertion> assertions{{vocabulary_.IsRobot(robot_), ""}, {promise.condition, ""}};
  if (with) {
    for (const Theory::Promise& other : theory_.Promises(round_.start(), round_.end(), robot_)) {
      assertions.push_back({arena_.Implies(other.condition, other.promise), other.name});
    }
    ActuatorsStay(assertions);
    Append(assertions, theory_.PortFacts(round_.end()));
  }
  Append(assertions, theory_.PortFacts(round_.start()));
  return Ground(std::move(assertions), {});
}

Problem Problems::BothPromises(size_t a, size_t b, bool kept) {
  const std::vector<Theory::Promise> all = theory_.Promises(round_.start(), round_.end(), robot_);
  std::vector<Assertion> assertions{
      {vocabulary_.IsRobot(robot_), ""}, {all[a].condition, ""}, {all[b].condition, ""}};
  if (kept) {
    assertions.push_back({all[a].promise, ""});
    assertions.push_back({all[b].promise, ""});
    ActuatorsStay(assertions);
    Append(assertions, theory_.PortFacts(round_.end()));
  } else {
    Append(assertions, Everything(round_.start(), false));
  }
  Append(assertions, theory_.PortFacts(round_.start()));
  return Ground(std::move(assertions), {});
}

Problem Problems::PromiseNow(size_t p) {
  const Theory::Promise promise = theory_.Promises(round_.start(), round_.start(), robot_)[p];
  std::vector<Assertion> assertions{
      {vocabulary_.IsRobot(robot_), ""}, {promise.condition, ""}, {arena_.Not(promise.promise), ""}};
  Append(assertions, Everything(round_.start(), false));
  return Ground(std::move(assertions), {});
}

}  // namespace rondo::koord
