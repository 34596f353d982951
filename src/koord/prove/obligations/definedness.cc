#include <algorithm>

#include "expr/lists.h"
#include "expr/substitute.h"
#include "koord/check/spec_labels.h"
#include "koord/prove/obligations/problem.h"
#include "solve/instantiate.h"

namespace rondo::koord {

using solve::Assertion;

std::vector<DefinednessCheck> Problems::ChecksAt(size_t place, TermId robot) {
  if (place >= fallback(0))
    return executor_.Run(model_.fallbacks[place - fallback(0)]->code, round_.start(), robot).checks;
  if (place >= columns()) return ChecksOfPart(static_cast<Part>(place - columns()), robot);
  return EffectAt(place, robot).checks;
}

const Effect& Problems::EffectAt(size_t action, TermId robot) {
  return (init_ && action == 0 ? *init_ : round_).EffectOf(action, robot);
}

std::vector<DefinednessCheck> Problems::ChecksOfPart(Part part, TermId robot) {
  const View& view = round_.start();
  executor_.TakeSpecificationChecks();
  const auto evaluate = [&](ExprId e) {
    if (e.valid()) executor_.Specification(e, view, robot, &view, {});
  };
  const auto evaluate_all = [&](auto wanted) {
    for (const AssumeDef* def : model_.assumptions) {
      if (wanted(*def)) evaluate(def->body);
    }
  };
  switch (part) {
    case Part::kInvariants:
      for (const InvariantDef* def : model_.invariants) evaluate(def->body);
      for (const AssumeDef* def : model_.assumptions) evaluate(def->when);
      return executor_.TakeSpecificationChecks();
    case Part::kPorts:
      evaluate_all([](const AssumeDef& def) { return def.kind == AssumeKind::kPort; });
      break;
    case Part::kInitial:
      evaluate_all([](const AssumeDef& def) { return def.kind == AssumeKind::kInitially; });
      break;
    case Part::kFacts:
      theory_.Background();
      break;
  }
  return executor_.TakeSpecificationChecks();
}

std::string Problems::NameOf(size_t place) const {
  if (place == 0) return "init";
  if (place < round_.actions().size()) return round_.actions()[place];
  if (place >= fallback(0)) return model_.fallbacks[place - fallback(0)]->code.name;
  switch (static_cast<Part>(place - round_.actions().size())) {
    case Part::kInvariants:
      return "specification";
    case Part::kPorts:
      return "controller assumptions";
    case Part::kInitial:
      return "initial assumptions";
    case Part::kFacts:
      return "facts and summaries";
  }
  return "";
}

// Action 0 is `init`: it runs from the declared values.
Problem Problems::Defined(size_t place) {
  std::vector<TermId> undefined;
  for (const DefinednessCheck& check : ChecksOf(place))
    undefined.push_back(arena_.And(check.reached, Refute(check.holds)));
  return Undefined(place, arena_.Or(undefined), robot_);
}

Problem Problems::DefinedAt(size_t place, const DefinednessCheck& check, TermId robot) {
  return Undefined(place, arena_.And(check.reached, Refute(check.holds)), robot);
}

Problem Problems::Undefined(size_t place, TermId undefined, TermId robot) {
  std::vector<Assertion> assertions{{undefined, ""}, {vocabulary_.IsRobot(robot), ""}};
  if (place < columns()) assertions.push_back({EffectAt(place, robot).chosen, ""});
  if (place == 0) {
    Append(assertions, theory_.DeclaredValues(init_->start()));
    Append(assertions, theory_.PortFacts(init_->start()));
  } else if (place < columns() || place == specification(Part::kInvariants) || place >= fallback(0)) {
    // Formulas have values at each moment, and fallbacks run at any.
    Append(assertions, Everything(round_.start(), place < columns()));
  } else if (place == specification(Part::kInitial)) {
    Append(assertions, theory_.DeclaredValues(round_.start()));
    Append(assertions, theory_.Initially(round_.start()));
    Append(assertions, theory_.PortFacts(round_.start()));
  } else if (place == specification(Part::kPorts)) {
    Append(assertions, theory_.PortFacts(round_.start()));
  }
  return Ground(std::move(assertions), {});
}

}  // namespace rondo::koord
