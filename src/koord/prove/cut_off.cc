#include "koord/prove/cut_off.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "koord/check/spec_labels.h"
#include "koord/check/targets.h"

namespace rondo::koord {
namespace {

bool HasUrgent(const Model& model) {
  return std::ranges::any_of(model.events, [](const EventDef* e) { return e->urgent; });
}

// Do these statements write actuators?
bool Acts(const Model& model, const std::vector<Stmt>& body) {
  return std::ranges::any_of(body, [&](const Stmt& s) {
    const Ref root = s.target.valid() ? model.RefOf(RootOf(model, s.target)) : Ref();
    const bool writes =
        root.kind == RefKind::kVariable && model.variables[root.index].kind == VariableKind::kActuator;
    return writes || s.kind == StmtKind::kCall || Acts(model, s.body) || Acts(model, s.orelse);
  });
}

class CutOffProof {
 public:
  CutOffProof(Problems& problems, const SolveTasks& solve)
      : problems_(problems), model_(problems.vocabulary().model()), solve_(solve) {}

  std::vector<Task> Run() {
    for (size_t i = 0; i < problems_.theory().invariants(); ++i)
      tasks_.push_back({TaskKind::kCutOff, i, 0, InvariantName(model_, i) + " (cut off)"});
    for (const bool runs_urgent : {false, true}) {
      if (runs_urgent && !HasUrgent(model_)) break;
      for (const bool acts_at_once : {false, true}) Try({acts_at_once, runs_urgent});
    }
    return std::move(tasks_);
  }

 private:
  std::vector<Task*> Open() {
    std::vector<Task*> open;
    for (Task& task : tasks_) {
      if (!task.Proved()) open.push_back(&task);
    }
    return open;
  }

  void Try(CutOffLimits limits) {
    for (Task* task : Open()) task->limits = limits;
    solve_(Open(), Effort::kFew);
    Consequences();
    solve_(Open(), Effort::kMore);
    for (Task* task : Open()) Split(*task);
  }

  // What follows from others at each moment needs no round of its own (see `Prover::TryConsequences`).
  void Consequences() {
    std::vector<size_t> premises;
    for (const Task& task : tasks_) {
      if (task.Proved()) premises.push_back(task.subject);
    }
    for (Task* task : Open()) {
      Task follows{TaskKind::kFollows, task->subject, 0, task->name};
      follows.premises = premises;
      solve_({&follows}, Effort::kFew);
      if (follows.Proved()) task->answer = follows.answer;
    }
  }

  void Split(Task& task) {
    std::vector<Task> steps = SplitCutOff(task, problems_);
    std::vector<Task*> todo;
    for (Task& step : steps) todo.push_back(&step);
    solve_(todo, Effort::kMore);
    std::set<std::string> core;
    for (const Task& step : steps) {
      const auto* proof = std::get_if<solve::Unsat>(&step.answer);
      if (proof == nullptr) {
        task.answer = step.answer;
        return;
      }
      core.insert(proof->core.begin(), proof->core.end());
    }
    task.answer = solve::Unsat{{core.begin(), core.end()}};
  }

  Problems& problems_;
  const Model& model_;
  const SolveTasks& solve_;
  std::vector<Task> tasks_;
};

}  // namespace

std::vector<Task> ProveCutOff(Problems& problems, const SolveTasks& solve) {
  return CutOffProof(problems, solve).Run();
}

std::vector<std::string> AssumedOfCutOff(const Model& model, const std::vector<Task>& proved) {
  const auto any = [&](auto limit) {
    return proved.empty() || std::ranges::any_of(proved, [&](const Task& t) { return t.limits.*limit; });
  };
  std::set<std::string> without;  // modules
  for (size_t v = 0; v < model.variables.size(); ++v) {
    if (model.variables[v].kind == VariableKind::kActuator && !model.FallsBack(v))
      without.insert(model.variables[v].module);
  }
  std::vector<std::string> assumed;
  if (!without.empty())
    assumed.push_back(
        fmt::format("robots act as a round begins, and lose nobody (there is no `fallback` of {})",
                    fmt::join(without, ", ")));
  if (!proved.empty() && any(&CutOffLimits::acts_at_once))
    assumed.push_back("robots act as a round begins, or fall back");
  const bool begins =
      std::ranges::any_of(model.inits, [&](const InitDef* init) { return Acts(model, init->body); });
  if (!proved.empty() && begins)
    assumed.push_back("robots act on what `init` says before anything else happens");
  if (HasUrgent(model) && any(&CutOffLimits::runs_urgent))
    assumed.push_back("no robot that has an urgent event to run is cut off");
  return assumed;
}

}  // namespace rondo::koord
