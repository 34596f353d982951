#include "koord/prove/obligations/theory.h"

#include <fmt/format.h>

#include <algorithm>

#include "expr/substitute.h"
#include "koord/check/spec_labels.h"

namespace rondo::koord {

using solve::Assertion;

Theory::Theory(Vocabulary& vocabulary, Executor& executor)
    : vocabulary_(vocabulary), executor_(executor), arena_(vocabulary.arena()), model_(vocabulary.model()) {}

TermId Theory::ForEachRobot(const std::function<TermId(TermId)>& body) {
  if (executor_.expands_robots()) {
    std::vector<TermId> parts;
    for (int64_t r = 0; r < *vocabulary_.fixed_robots(); ++r) parts.push_back(body(arena_.IntNumber(r)));
    return arena_.And(parts);
  }
  const TermId robot = arena_.FreshBound("robot", arena_.Int());
  return arena_.Forall({robot}, arena_.Implies(vocabulary_.IsRobot(robot), body(robot)));
}

// A formula that names ports or variables without a robot speaks of each robot.
TermId Theory::PerRobot(ExprId e, const View& view) {
  bool used = false;
  const TermId all = ForEachRobot([&](TermId robot) {
    const TermId one = executor_.Specification(e, view, robot, nullptr, {});
    used = used || executor_.used_robot();
    return one;
  });
  return used ? all : executor_.Specification(e, view, {}, nullptr, {});
}

TermId Theory::Invariant(size_t i, const View& view) { return PerRobot(model_.invariants[i]->body, view); }

std::vector<Assertion> Theory::Invariants(const View& view, bool between_rounds) {
  std::vector<Assertion> result;
  for (size_t i = 0; i < invariants(); ++i) {
    if (model_.invariants[i]->at_rounds && !between_rounds) continue;
    result.push_back({Invariant(i, view), "invariant " + InvariantName(model_, i)});
  }
  return result;
}

size_t Theory::FunctionOf(const SummaryDef& def) const {
  size_t index = 0;
  for (size_t i = 0; i < model_.functions.size(); ++i) {
    const Function& f = model_.functions[i];
    if (f.name == def.function || (f.port >= 0 && f.name.ends_with("." + def.function))) index = i;
  }
  return index;
}

bool Theory::CallsFunctions(ExprId id) const {
  const lang::Expr& e = model_.program->exprs[id];
  const Ref ref = model_.RefOf(id);
  if (ref.kind == RefKind::kOpaqueField ||
      (ref.kind == RefKind::kFunction && e.kind == lang::ExprKind::kCall))
    return true;
  if (ref.kind == RefKind::kBuiltin && static_cast<Builtin>(ref.index) == Builtin::kDist) return true;
  return std::any_of(e.args.begin(), e.args.end(), [&](ExprId arg) { return CallsFunctions(arg); });
}

std::vector<size_t> Theory::SummarisedFunctions() {
  std::vector<size_t> result;
  for (const SummaryDef* def : model_.summaries) {
    const size_t f = FunctionOf(*def);
    const bool simple = std::all_of(
        model_.summaries.begin(), model_.summaries.end(),
        [&](const SummaryDef* other) { return FunctionOf(*other) != f || !CallsFunctions(other->body); });
    const expr::SortKind kind = arena_.sort(vocabulary_.SortOf(model_.functions[f].result)).kind;
    const bool plain = kind == expr::SortKind::kBool || kind == expr::SortKind::kInt ||
                       kind == expr::SortKind::kReal || kind == expr::SortKind::kEnum ||
                       kind == expr::SortKind::kRecord;
    if (simple && plain && std::find(result.begin(), result.end(), f) == result.end()) result.push_back(f);
  }
  return result;
}

TermId Theory::NoResult(size_t index) {
  const Function& f = model_.functions[index];
  std::vector<TermId> arguments;
  for (const TypeId p : f.parameters)
    arguments.push_back(arena_.FreshConstant("argument", vocabulary_.SortOf(p)));
  const TermId result = arena_.FreshBound("result", vocabulary_.SortOf(f.result));
  const View parameters = vocabulary_.MakeView("");
  std::vector<TermId> wanted;
  for (const SummaryDef* def : model_.summaries) {
    if (FunctionOf(*def) != index) continue;
    std::map<uint32_t, TermId> bindings;
    const std::vector<uint32_t>& bound = model_.bound_by.at(def);
    for (size_t i = 0; i < arguments.size(); ++i) bindings[bound[i]] = arguments[i];
    bindings[bound.back()] = result;
    wanted.push_back(executor_.Specification(def->body, parameters, {}, nullptr, bindings));
  }
  return arena_.Forall({result}, arena_.Not(arena_.And(wanted)));
}

std::vector<Assertion> Theory::Facts() {
  std::vector<Assertion> result;
  const View parameters = vocabulary_.MakeView("");
  for (const AssumeDef* def : model_.assumptions) {
    if (def->kind != AssumeKind::kFact || CallsFunctions(def->body)) continue;
    result.push_back({executor_.Specification(def->body, parameters, {}, nullptr, {}), ""});
  }
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    const Variable& variable = model_.variables[v];
    if (variable.kind != VariableKind::kParam || !variable.initial.valid()) continue;
    result.push_back({executor_.HasInitialValue(v, parameters.value[v], parameters, {}), ""});
  }
  return result;
}

TermId Theory::Summary(const SummaryDef& def) {
  const size_t index = FunctionOf(def);
  const Function& f = model_.functions[index];
  const std::vector<uint32_t>& bound = model_.bound_by.at(&def);
  std::map<uint32_t, TermId> bindings;
  std::vector<TermId> variables;
  if (f.port >= 0) variables.push_back(arena_.FreshBound("robot", arena_.Int()));
  for (size_t i = 0; i < f.parameters.size(); ++i) {
    variables.push_back(arena_.FreshBound(def.parameters[i], vocabulary_.SortOf(f.parameters[i])));
    bindings[bound[i]] = variables.back();
  }
  const View parameters = vocabulary_.MakeView("");
  bindings[bound.back()] = arena_.Apply(vocabulary_.Function(index, ""), variables);
  return arena_.Forall(variables, executor_.Specification(def.body, parameters, {}, nullptr, bindings));
}

std::vector<Assertion> Theory::Background() {
  std::vector<Assertion> result;
  const View parameters = vocabulary_.MakeView("");
  for (const AssumeDef* def : model_.assumptions) {
    if (def->kind != AssumeKind::kFact) continue;
    result.push_back(
        {executor_.Specification(def->body, parameters, {}, nullptr, {}), AssumptionName(model_, *def)});
  }
  for (const SummaryDef* def : model_.summaries) result.push_back({Summary(*def), SummaryName(*def)});
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    const Variable& variable = model_.variables[v];
    if (variable.kind != VariableKind::kParam || !variable.initial.valid()) continue;
    result.push_back({executor_.HasInitialValue(v, parameters.value[v], parameters, {}), ""});
  }
  // An array has at least one item.
  for (const auto& [_, length] : model_.lengths)
    result.push_back(
        {arena_.Le(arena_.IntNumber(1), executor_.Specification(length, parameters, {}, nullptr, {})), ""});
  for (const TermId axiom : vocabulary_.Axioms()) result.push_back({axiom, ""});
  return result;
}

std::vector<Assertion> Theory::DeclaredValues(const View& view) {
  std::vector<Assertion> result;
  const View parameters = vocabulary_.MakeView("");
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    const Variable& variable = model_.variables[v];
    if (variable.kind == VariableKind::kParam || !variable.initial.valid()) continue;
    const auto has_value = [&](TermId whole, TermId robot) {
      return executor_.HasInitialValue(v, whole, parameters, robot);
    };
    const TermId fact =
        variable.PerRobot()
            ? ForEachRobot([&](TermId r) { return has_value(arena_.Select(view.value[v], r), r); })
            : has_value(view.value[v], {});
    result.push_back({fact, ""});
  }
  result.push_back({ForEachRobot([&](TermId r) { return arena_.Not(arena_.Select(view.stopped, r)); }), ""});
  return result;
}

std::vector<Assertion> Theory::Initially(const View& view) {
  std::vector<Assertion> result;
  for (const AssumeDef* def : model_.assumptions) {
    if (def->kind == AssumeKind::kInitially)
      result.push_back({PerRobot(def->body, view), AssumptionName(model_, *def)});
  }
  return result;
}

std::vector<Assertion> Theory::PortFacts(const View& view) {
  std::vector<Assertion> result;
  for (const AssumeDef* def : model_.assumptions) {
    if (def->kind == AssumeKind::kPort && HoldsAlways(model_, *def)) {
      result.push_back({PerRobot(def->body, view), AssumptionName(model_, *def)});
    }
  }
  return result;
}

std::vector<Theory::Promise> Theory::Promises(const View& settled, const View& end, TermId robot) {
  std::vector<Promise> result;
  for (const AssumeDef* def : model_.assumptions) {
    if (def->kind != AssumeKind::kPort || (HoldsAlways(model_, *def))) continue;
    const TermId condition =
        def->when.valid() ? executor_.Specification(def->when, settled, robot, nullptr, {}) : arena_.True();
    const TermId promise = executor_.Specification(def->body, end, robot, &settled, {});
    result.push_back({def, AssumptionName(model_, *def), condition, promise});
  }
  return result;
}

std::vector<Assertion> Theory::PortPromises(Round& round, TermId robot, bool over) {
  std::vector<Assertion> result;
  const std::vector<Round::Leg> legs = round.Legs(robot);
  for (size_t i = 0; i < legs.size(); ++i) {
    // What holds at the end is promised to actuators that stayed as they were for the whole round: the first leg.
    for (const Promise& p : Promises(legs[i].from, legs[i].to, robot)) {
      if (p.def->at_end && (!over || i > 0)) continue;
      // Without a condition it holds whatever the actuators do.
      if (p.def->at_end && !p.def->when.valid() && !UsesOld(model_, p.def->body)) {
        result.push_back({arena_.Or(arena_.Not(round.moved()), p.promise), p.name});
        continue;
      }
      result.push_back({arena_.Or({legs[i].still, arena_.Not(p.condition), p.promise}), p.name});
    }
  }
  return result;
}

std::vector<std::string> Theory::External(bool wanted) const {
  std::vector<std::string> result;
  for (const Function& f : model_.functions) {
    if (!f.external() || !f.declared || f.port >= 0) continue;
    const bool summarised = std::any_of(model_.summaries.begin(), model_.summaries.end(),
                                        [&](const SummaryDef* s) { return s->function == f.name; });
    if (summarised == wanted) result.push_back(f.name);
  }
  return result;
}

}  // namespace rondo::koord
