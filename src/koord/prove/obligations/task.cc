#include "koord/prove/obligations/task.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "koord/check/spec_labels.h"

namespace rondo::koord {

namespace {

// How many variables over robots stand around one another?
int Depth(const Model& model, ExprId id) {
  const lang::Expr& e = model.program->exprs[id];
  int depth = 0;
  for (const ExprId arg : e.args) depth = std::max(depth, Depth(model, arg));
  if (const auto it = model.domains.find(id); it != model.domains.end()) {
    for (size_t b = 0; b < it->second.kinds.size(); ++b) {
      if (it->second.kinds[b] == DomainKind::kRobots)
        depth += static_cast<int>(it->second.bindings[b].size());
    }
  }
  return depth;
}

}  // namespace

bool CanExpand(const Model& model, int64_t robots) {
  constexpr double kMostInstances = 1e5;
  int depth = 1;
  for (const InvariantDef* def : model.invariants) depth = std::max(depth, Depth(model, def->body));
  for (const AssumeDef* def : model.assumptions) depth = std::max(depth, Depth(model, def->body));
  return std::pow(static_cast<double>(robots), depth) <= kMostInstances;
}

std::vector<size_t> Columns(Problems& problems) {
  std::vector<size_t> result;
  for (size_t a = 1; a < problems.columns(); ++a) result.push_back(a);
  result.push_back(0);
  return result;
}

std::vector<Task> ListTasks(Problems& problems) {
  const std::vector<std::string>& actions = problems.round().actions();
  std::vector<Task> tasks;
  const auto add = [&](TaskKind kind, size_t subject, size_t action, std::string name) {
    tasks.push_back({kind, subject, action, std::move(name)});
  };
  for (size_t i = 0; i < problems.theory().invariants(); ++i) {
    const std::string name = InvariantName(problems.vocabulary().model(), i);
    add(TaskKind::kInitially, i, 0, name + " (initially)");
    add(TaskKind::kRound, i, 0, name + " (round)");
  }
  for (size_t a = problems.has_init() ? 0 : 1; a < actions.size(); ++a) {
    if (!problems.ChecksOf(a).empty()) add(TaskKind::kDefined, 0, a, "defined." + problems.NameOf(a));
  }
  for (size_t p = 0; p < Problems::kParts; ++p) {
    const size_t place = problems.specification(static_cast<Problems::Part>(p));
    if (!problems.ChecksOf(place).empty())
      add(TaskKind::kDefined, 0, place, "defined (" + problems.NameOf(place) + ")");
  }
  for (size_t f = 0; f < problems.vocabulary().model().fallbacks.size(); ++f) {
    const size_t place = problems.fallback(f);
    if (!problems.ChecksOf(place).empty())
      add(TaskKind::kDefined, 0, place, "defined (" + problems.NameOf(place) + ")");
  }
  for (const size_t f : problems.theory().SummarisedFunctions())
    add(TaskKind::kImpossible, f, 0, "sanity.summary");
  add(TaskKind::kSomeInitial, 0, 0, "sanity.initially");
  for (size_t a = 1; a < actions.size(); ++a) {
    add(TaskKind::kSomeValues, 0, a, "sanity.values." + actions[a]);
    add(TaskKind::kSomeEnabled, 0, a, "sanity.enabled." + actions[a]);
  }
  for (size_t p = 0; p < problems.promises().size(); ++p) {
    add(TaskKind::kSomePromise, p, 0, "sanity.promise");
    add(TaskKind::kNow, p, 0, "sanity.now");
  }
  return tasks;
}

std::vector<Task> SplitRounds(std::vector<Task> tasks, Problems& problems) {
  std::vector<Task> result;
  for (Task& task : tasks) {
    if (task.kind != TaskKind::kRound || task.Proved() || !problems.HasCases(task.subject)) {
      result.push_back(std::move(task));
      continue;
    }
    for (const size_t a : Columns(problems)) {
      const std::string invariant = InvariantName(problems.vocabulary().model(), task.subject);
      const std::string name =
          a == 0 ? invariant + " (skip)" : invariant + "." + problems.round().actions()[a];
      result.push_back({TaskKind::kStep, task.subject, a, name});
    }
  }
  return result;
}

std::vector<Task> SplitCutOff(const Task& task, Problems& problems) {
  std::vector<Task> result;
  for (const size_t a : Columns(problems)) {
    result.push_back(
        {TaskKind::kCutOffStep, task.subject, a, task.name + " " + problems.round().actions()[a]});
    result.back().limits = task.limits;
  }
  return result;
}

Problem StateTask(const Task& task, Problems& problems, Effort effort) {
  problems.distances = effort == Effort::kFew ? Distances::Detail::kDistance : Distances::Detail::kAll;
  switch (effort) {
    case Effort::kFew:
      problems.limits = {.rounds = 3};
      break;
    case Effort::kMore:
      problems.limits = {.rounds = 5};
      break;
    case Effort::kMost:
    case Effort::kAll:
      problems.limits = {.mode = solve::InstantiationMode::kPlaces, .rounds = 4};
      break;
  }
  switch (task.kind) {
    case TaskKind::kInitially:
      return problems.Initially(task.subject);
    case TaskKind::kRound:
      return problems.Step(task.subject, std::nullopt, false);
    case TaskKind::kStep:
      return problems.Step(task.subject, task.action, false);
    case TaskKind::kFollows:
      return problems.Follows(task.subject, task.premises);
    case TaskKind::kCutOff:
      return problems.CutOff(task.subject, std::nullopt, task.limits);
    case TaskKind::kCutOffStep:
      return problems.CutOff(task.subject, task.action, task.limits);
    case TaskKind::kDefined:
      return problems.Defined(task.action);
    case TaskKind::kImpossible:
      return problems.ImpossibleSummary(task.subject);
    case TaskKind::kSomeInitial:
      return problems.SomeInitialState();
    case TaskKind::kSomeValues:
      return problems.SomeValues(task.action);
    case TaskKind::kSomeEnabled:
      return problems.SomeEnabled(task.action);
    case TaskKind::kSomeCondition:
      return problems.SomePromise(task.subject, false);
    case TaskKind::kSomePromise:
      return problems.SomePromise(task.subject, true);
    case TaskKind::kNow:
      return problems.PromiseNow(task.subject);
  }
  CHECK(false);
  return {};
}

}  // namespace rondo::koord
