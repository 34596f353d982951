#include "koord/prove/prove.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <set>

#include "base/file.h"
#include "base/parallel.h"
#include "expr/smtlib/smtlib.h"
#include "koord/check/spec_labels.h"
#include "koord/prove/cut_off.h"
#include "koord/prove/obligations/task.h"
#include "koord/prove/report.h"
#include "verdict/verdict.h"

namespace rondo::koord {
namespace {

using Clock = std::chrono::steady_clock;

class Prover {
 public:
  Prover(const Model& model, const ProveOptions& options, diag::Diagnostics& diagnostics)
      : model_(model), options_(options), diagnostics_(diagnostics) {}

  Report Run() {
    const size_t errors = diagnostics_.errors();
    // Stated once here for names and for what cannot be proved at all; each task states its own again, in
    // parallel.
    expr::Arena arena;
    Problems problems(arena, model_, {options_.robots, false}, diagnostics_);
    problems.theory().DeclaredValues(problems.round().start());
    problems.theory().Background();
    if (diagnostics_.errors() > errors) return std::move(report_);
    tasks_ = ListTasks(problems);
    for (const Task& task : tasks_)
      report_.obligations += task.kind == TaskKind::kRound ? problems.columns() : task.IsObligation() ? 1 : 0;
    if (options_.quick) {
      std::vector<Task*> last;
      for (Task* task : Undecided()) {
        if (task->kind != TaskKind::kDefined && task->subject + 1 == model_.invariants.size())
          last.push_back(task);
      }
      Solve(last, Effort::kFew);
      report_.interrupted = options_.stop.cancelled();
      MakeRows(problems);
      return std::move(report_);
    }
    Solve(All(), Effort::kFew);
    TryConsequences();
    Solve(Undecided(), Effort::kMore);
    tasks_ = SplitRounds(std::move(tasks_), problems);
    Solve(Undecided(), Effort::kMore);
    FindWitnesses(Undecided());
    // Of what is neither proved nor refuted by now, one more attempt, with all the instances that there are.
    std::vector<Task*> rest;
    for (Task* task : Undecided()) {
      const auto it = witnesses_.find(task->subject);
      if (task->kind == TaskKind::kDefined || it == witnesses_.end() || !it->second.confirmed)
        rest.push_back(task);
    }
    Solve(rest, Effort::kMost);
    SpellOut(rest);
    if (!model_.fallbacks.empty()) CutOff(problems);
    report_.interrupted = options_.stop.cancelled();
    MakeRows(problems);
    Reporter reporter(model_, options_, problems, diagnostics_, report_, witnesses_);
    for (Task& task : tasks_) Sanity(task, problems, reporter);
    reporter.Failures();
    Conclude(problems, reporter);
    return std::move(report_);
  }

 private:
  std::vector<Task*> All() {
    std::vector<Task*> result;
    for (Task& task : tasks_) result.push_back(&task);
    return result;
  }
  std::vector<Task*> Undecided() {
    std::vector<Task*> result;
    for (Task& task : tasks_) {
      if (task.IsObligation() && !task.Proved() && !options_.stop.cancelled()) result.push_back(&task);
    }
    return result;
  }

  void Solve(const std::vector<Task*>& todo, Effort effort) {
    std::mutex mutex;
    size_t done = 0;
    base::ParallelFor(todo.size(), options_.jobs, [&](size_t i) {
      Task& task = *todo[i];
      if (options_.stop.StopRequested()) {
        task.answer = solve::Unknown{"interrupted"};
        return;
      }
      const auto start = Clock::now();
      expr::Arena arena;
      diag::Diagnostics ignored;
      Problems problems(arena, model_, {options_.robots, effort == Effort::kAll}, ignored);
      const Problem problem = StateTask(task, problems, effort);
      const solve::Query asked = Ask(task, problem, effort);
      task.seconds += std::chrono::duration<double>(Clock::now() - start).count();
      // The question that decided, or the last one.
      const bool last = task.Proved() || effort == Effort::kMore;
      std::optional<solve::Answer> other;
      if (options_.cross_check != nullptr && task.IsObligation() && last) {
        other = options_.cross_check->Check(asked, {options_.timeout, false}, options_.stop);
      }
      if (!options_.smt_out.empty() && task.IsObligation() && last) WriteFile(task, asked, mutex);
      const std::scoped_lock lock(mutex);
      if (other) Compare(task, *other);
      ++done;
      if (options_.progress) options_.progress(done, todo.size(), task.name);
    });
  }

  // An invariant that other invariants imply needs no induction of its own. The premises are proved by
  // induction, so the argument is not circular: at each moment first they hold, then what follows from them.
  void TryConsequences() {
    std::vector<size_t> premises;
    for (const Task& task : tasks_) {
      if (task.kind == TaskKind::kRound && task.Proved()) premises.push_back(task.subject);
    }
    std::vector<Task> attempts;
    for (const Task* task : Undecided()) {
      if (task->kind != TaskKind::kRound) continue;
      attempts.push_back({TaskKind::kFollows, task->subject, 0, task->name, solve::Unknown{"not asked"},
                          task->seconds, premises});
    }
    for (const Effort effort : {Effort::kFew, Effort::kMore}) {
      std::vector<Task*> todo;
      for (Task& attempt : attempts) {
        if (!attempt.Proved()) todo.push_back(&attempt);
      }
      Solve(todo, effort);
    }
    for (Task& attempt : attempts) {
      if (!attempt.Proved()) continue;
      for (Task& task : tasks_) {
        if (task.kind != TaskKind::kRound || task.subject != attempt.subject) continue;
        task.answer = attempt.answer;
        task.seconds = attempt.seconds;
      }
    }
  }

  // A team of a fixed size has finitely many robots. Rounds are spelled out as a whole: the cases of a round
  // are told apart by what the robots do that the goal reads, which are others where all are named. (That
  // operations are defined is asked of an arbitrary robot.)
  void SpellOut(const std::vector<Task*>& tasks) {
    if (!options_.robots || !CanExpand(model_, *options_.robots)) return;
    std::vector<Task*> initially;
    std::vector<Task> rounds;
    for (Task* task : tasks) {
      if (task->Proved()) continue;
      if (task->kind == TaskKind::kInitially) initially.push_back(task);
      const auto same = [&](const Task& r) { return r.subject == task->subject; };
      const bool round = task->kind == TaskKind::kStep || task->kind == TaskKind::kRound;
      if (round && std::ranges::none_of(rounds, same))
        rounds.push_back(
            {TaskKind::kRound, task->subject, 0, InvariantName(model_, task->subject) + " (round)"});
    }
    std::vector<Task*> todo = initially;
    for (Task& round : rounds) todo.push_back(&round);
    Solve(todo, Effort::kAll);
    for (const Task& round : rounds) {
      if (!round.Proved()) continue;
      for (Task& task : tasks_) {
        if ((task.kind == TaskKind::kStep || task.kind == TaskKind::kRound) && task.subject == round.subject)
          task.answer = round.answer;
      }
    }
  }

  void CutOff(Problems& problems) {
    cut_off_ =
        ProveCutOff(problems, [this](const std::vector<Task*>& todo, Effort effort) { Solve(todo, effort); });
    report_.obligations += cut_off_.size();
    std::vector<Task*> undecided;
    for (Task& task : cut_off_) {
      if (!task.Proved() && !witnesses_.contains(task.subject)) undecided.push_back(&task);
    }
    if (!options_.stop.cancelled()) FindWitnesses(undecided);
  }

  // For each invariant, of the first obligation that is not proved.
  void FindWitnesses(const std::vector<Task*>& undecided) {
    std::vector<Task*> first;
    std::set<size_t> seen;
    for (Task* task : undecided) {
      if (task->kind != TaskKind::kDefined && seen.insert(task->subject).second) first.push_back(task);
    }
    std::mutex mutex;
    base::ParallelFor(first.size(), options_.jobs, [&](size_t i) {
      const Task& task = *first[i];
      if (options_.progress) {
        const std::scoped_lock lock(mutex);
        options_.progress(i, first.size(), "looking for a counterexample of " + task.name);
      }
      const solve::Budget budget{std::min(options_.timeout, std::chrono::milliseconds(2000)), false};
      const WitnessOf of = task.kind == TaskKind::kInitially ? WitnessOf::kInitial
                           : task.kind == TaskKind::kCutOff  ? WitnessOf::kCutOff
                                                             : WitnessOf::kRound;
      auto witness =
          FindWitness(model_, task.subject, of, options_.robots, *options_.solver, budget, options_.stop);
      const std::scoped_lock lock(mutex);
      if (witness) witnesses_.emplace(task.subject, std::move(*witness));
    });
  }

  // Returns the question that the answer is to.
  solve::Query Ask(Task& task, const Problem& problem, Effort effort) const {
    solve::Budget budget{options_.timeout, true};
    // A sanity check that takes long is no reason to wait: it can only warn.
    if (!task.IsObligation()) budget.time = std::min(budget.time, std::chrono::milliseconds(2000));
    // Each attempt gets a part of the time: most answers come at once.
    if (effort == Effort::kFew) budget.time = std::min(budget.time, options_.timeout / 5);
    if (effort == Effort::kMore) budget.time = std::min(budget.time, options_.timeout / 4);
    if (effort == Effort::kMost) budget.time = std::min(budget.time, options_.timeout / 20);
    task.answer = options_.solver->Check(problem.query, budget, options_.stop);
    if (effort != Effort::kMost || !std::holds_alternative<solve::Unknown>(task.answer)) return problem.query;
    // The instances were too many or too hard: let the solver choose its own.
    solve::Query whole = problem.query;
    whole.assertions = problem.assertions;
    solve::Answer second = options_.solver->Check(whole, budget, options_.stop);
    if (!std::holds_alternative<solve::Unsat>(second)) return problem.query;
    task.answer = std::move(second);
    return whole;
  }

  void WriteFile(const Task& task, const solve::Query& query, std::mutex& mutex) {
    const std::filesystem::path path = options_.smt_out / (task.name + ".smt2");
    const auto written =
        base::WriteFileAtomically(path, "; unsatisfiable if the obligation holds\n" + solve::ToSmtLib(query));
    if (written.ok()) return;
    const std::scoped_lock lock(mutex);
    report_.problems.push_back(fmt::format("{}: {}", path.string(), written.error().message));
  }

  void Compare(const Task& task, const solve::Answer& other) {
    if (std::holds_alternative<solve::Unknown>(other) ||
        std::holds_alternative<solve::Unknown>(task.answer)) {
      ++report_.cross_unknown;
      return;
    }
    ++report_.cross_checked;
    if (task.answer.index() == other.index()) return;
    report_.disagreement = true;
    const auto word = [](const solve::Answer& a) {
      return std::holds_alternative<solve::Unsat>(a) ? "unsat" : "sat";
    };
    diagnostics_
        .Report(diag::Kind::kKoordDisagreement, {},
                fmt::format("{} says {} and {} says {} of `{}`", options_.solver->name(), word(task.answer),
                            options_.cross_check->name(), word(other), task.name))
        .Help("one of the solvers is wrong: `--smt-out DIR` writes the question");
  }

  static Cell MakeCell(const Task& task, std::string column, std::optional<size_t> action) {
    Cell cell{std::move(column), action, verdict::Verdict::kUnknown, {}, {}, task.seconds};
    if (const auto* unsat = std::get_if<solve::Unsat>(&task.answer)) {
      cell.verdict = verdict::Verdict::kProved;
      cell.core = unsat->core;
    } else if (const auto* unknown = std::get_if<solve::Unknown>(&task.answer)) {
      cell.reason = unknown->reason;
      cell.timed_out = unknown->timed_out;
    } else {
      cell.verdict = verdict::Verdict::kRefuted;
    }
    return cell;
  }

  void MakeRows(Problems& problems) {
    const std::vector<std::string>& actions = problems.round().actions();
    for (size_t i = 0; i < problems.theory().invariants(); ++i)
      report_.rows.push_back({InvariantName(model_, i), model_.invariants[i]->span, {}, {}, {}, {}});
    Row defined{"well-defined", {}, {}, {}, {}, {}};
    for (const Task& task : tasks_) {
      if (task.kind == TaskKind::kInitially)
        report_.rows[task.subject].cells.push_back(MakeCell(task, "initially", std::nullopt));
      if (task.kind == TaskKind::kStep)
        report_.rows[task.subject].cells.push_back(MakeCell(task, actions[task.action], task.action));
      if (task.kind == TaskKind::kDefined)
        defined.cells.push_back(MakeCell(task, problems.NameOf(task.action), task.action));
      if (task.kind != TaskKind::kRound) continue;
      for (const size_t a : Columns(problems)) {
        report_.rows[task.subject].cells.push_back(MakeCell(task, actions[a], a));
        report_.rows[task.subject].cells.back().seconds /= static_cast<double>(actions.size());
      }
    }
    for (const Task& task : cut_off_)
      report_.rows[task.subject].cells.push_back(MakeCell(task, kCutOffColumn, std::nullopt));
    if (!defined.cells.empty()) report_.rows.push_back(std::move(defined));
  }

  void Sanity(Task& task, Problems& problems, Reporter& reporter) {
    if (report_.contradiction) return;  // the rest follows from it
    const auto* unsat = std::get_if<solve::Unsat>(&task.answer);
    switch (task.kind) {
      case TaskKind::kInitially:
      case TaskKind::kRound:
      case TaskKind::kStep:
      case TaskKind::kFollows:
      case TaskKind::kCutOff:
      case TaskKind::kCutOffStep:
      case TaskKind::kDefined:
      case TaskKind::kSomeCondition:
        return;
      case TaskKind::kImpossible:
        if (std::holds_alternative<solve::Sat>(task.answer)) {
          std::vector<std::string> names;
          for (const SummaryDef* def : model_.summaries) {
            if (problems.theory().FunctionOf(*def) == task.subject) names.push_back(SummaryName(*def));
          }
          reporter.Contradiction(fmt::format("for some arguments no result of `{}` is possible",
                                             model_.functions[task.subject].name),
                                 names);
        }
        return;
      case TaskKind::kSomeInitial:
        if (unsat != nullptr) reporter.Contradiction("no initial state is possible", unsat->core);
        return;
      case TaskKind::kSomeValues:
        if (unsat != nullptr)
          reporter.Contradiction(fmt::format("what `{}` computes cannot exist", problems.NameOf(task.action)),
                                 unsat->core);
        return;
      case TaskKind::kSomeEnabled:
        if (unsat != nullptr) never_.emplace_back(task.action, unsat->core);
        return;
      case TaskKind::kSomePromise: {
        if (unsat == nullptr) return;
        // A promise whose condition is never true promises nothing.
        Task condition{TaskKind::kSomeCondition, task.subject, 0, "sanity.condition"};
        Solve({&condition}, Effort::kFew);
        if (!condition.Proved()) reporter.Contradiction("no controller can keep this promise", unsat->core);
        return;
      }
      case TaskKind::kNow:
        if (std::holds_alternative<solve::Sat>(task.answer)) not_now_.push_back(task.subject);
        return;
    }
  }

  void Conclude(Problems& problems, Reporter& reporter) {
    reporter.Verdicts();
    if (report_.contradiction || report_.interrupted) return;
    if (report_.AllProved()) {
      for (const size_t p : not_now_) reporter.Unrealisable(p);
      reporter.Excluding();
      for (const auto& [action, core] : never_) reporter.NeverEnabled(action, core);
    }
    std::set<std::string> used;
    for (const Row& row : report_.rows) {
      for (const Cell& cell : row.cells) used.insert(cell.core.begin(), cell.core.end());
    }
    std::vector<std::pair<std::string, diag::Span>> stated;
    for (const AssumeDef* def : model_.assumptions)
      stated.emplace_back(AssumptionName(model_, *def), def->span);
    for (const SummaryDef* def : model_.summaries) stated.emplace_back(SummaryName(*def), def->span);
    for (const auto& [name, span] : stated) {
      if (used.contains(name)) {
        if (std::find(report_.basis.assumed.begin(), report_.basis.assumed.end(), name) ==
            report_.basis.assumed.end())
          report_.basis.assumed.push_back(name);
      } else if (report_.AllProved()) {
        report_.basis.unused.push_back(name);
        diagnostics_.Report(diag::Kind::kKoordUnusedAssumption, span,
                            fmt::format("no proof uses `{}`", name));
      }
    }
    const bool proved = std::any_of(report_.rows.begin(), report_.rows.end(),
                                    [](const Row& r) { return r.verdict == verdict::Verdict::kProved; });
    if (proved && UsesFloatArithmetic(model_))
      report_.basis.assumed.push_back("floats are exact (on robots, doubles round)");
    if (proved) {
      for (std::string& text : AssumedOfCutOff(model_, cut_off_))
        report_.basis.assumed.push_back(std::move(text));
    }
    report_.unconstrained = problems.theory().External(false);
    std::vector<std::string> functions = report_.unconstrained;
    for (std::string& f : problems.theory().External(true)) functions.push_back(std::move(f));
    if (proved && !functions.empty())
      report_.basis.assumed.push_back(
          fmt::format("the same result for the same arguments of {}", fmt::join(functions, ", ")));
  }

  const Model& model_;
  const ProveOptions& options_;
  diag::Diagnostics& diagnostics_;
  std::vector<Task> tasks_;
  std::vector<Task> cut_off_;            // by invariant; empty if the program has no fallback
  std::map<size_t, Witness> witnesses_;  // by invariant
  std::vector<size_t> not_now_;
  std::vector<std::pair<size_t, std::vector<std::string>>> never_;
  Report report_;
};

}  // namespace

bool Report::AllProved() const {
  return !contradiction && !disagreement && !rows.empty() &&
         std::all_of(rows.begin(), rows.end(),
                     [](const Row& r) { return r.verdict == verdict::Verdict::kProved; });
}

bool Report::AnyFailed() const {
  return contradiction || std::any_of(rows.begin(), rows.end(), [](const Row& r) {
           return r.verdict == verdict::Verdict::kRefuted || r.verdict == verdict::Verdict::kNotInductive;
         });
}

Report Prove(const Model& model, const ProveOptions& options, diag::Diagnostics& diagnostics) {
  return Prover(model, options, diagnostics).Run();
}

}  // namespace rondo::koord
