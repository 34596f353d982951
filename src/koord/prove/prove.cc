#include "koord/prove/prove.h"

#include <algorithm>
#include <mutex>
#include <set>

#include <fmt/format.h>

#include "base/file.h"
#include "base/parallel.h"
#include "expr/smtlib.h"
#include "koord/prove/problem.h"
#include "koord/prove/report.h"

namespace rondo::koord {
namespace {

using Clock = std::chrono::steady_clock;

enum class TaskKind : uint8_t { kInitially, kStep, kDefined, kSomeInitial, kSomeValues, kSomeEnabled, kSomeCondition, kSomePromise, kNow };

struct Task {
  TaskKind kind;
  size_t subject = 0;  // invariant or promise
  size_t action = 0;
  std::string name;  // of the file and of the progress line
  Problem problem;
  solve::Answer answer = solve::Unknown{"not asked"};
  double seconds = 0;

  bool Undecided() const { return IsObligation() && !std::holds_alternative<solve::Unsat>(answer); }
  bool IsObligation() const { return kind == TaskKind::kInitially || kind == TaskKind::kStep || kind == TaskKind::kDefined; }
};

class Prover {
 public:
  Prover(const diag::SourceSet& sources, const Model& model, const ProveOptions& options, diag::Diagnostics& diagnostics)
      : sources_(sources), model_(model), options_(options), diagnostics_(diagnostics) {}

  Report Run() {
    const size_t errors = diagnostics_.errors();
    Problems problems(arena_, model_, {options_.robots, false}, diagnostics_);
    if (diagnostics_.errors() > errors) return std::move(report_);
    State(problems);
    if (diagnostics_.errors() > errors) return std::move(report_);
    Solve(0);
    // What the few instances did not decide gets many.
    const size_t more = std::count_if(tasks_.begin(), tasks_.end(), [](const Task& t) { return t.Undecided(); });
    if (more > 0 && !options_.stop.cancelled()) {
      for (Task& task : tasks_) {
        if (task.Undecided()) problems.Strengthen(task.problem);
      }
      Solve(1);
    }
    WriteFiles();
    report_.interrupted = options_.stop.cancelled();
    MakeRows(problems);
    Reporter reporter(sources_, model_, options_, problems, diagnostics_, report_);
    for (Task& task : tasks_) Sanity(task, problems, reporter);
    reporter.Failures();
    Conclude(problems, reporter);
    return std::move(report_);
  }

 private:
  void Add(TaskKind kind, size_t subject, size_t action, std::string name, Problem problem) {
    tasks_.push_back({kind, subject, action, std::move(name), std::move(problem)});
  }

  void State(Problems& problems) {
    const std::vector<std::string>& actions = problems.round().actions();
    const size_t count = problems.theory().invariants();
    for (size_t i = 0; i < count; ++i) {
      const std::string name = problems.theory().InvariantName(i);
      Add(TaskKind::kInitially, i, 0, name + ".initially", problems.Initially(i));
      for (size_t a = 1; a < actions.size(); ++a) Add(TaskKind::kStep, i, a, name + "." + actions[a], problems.Step(i, a, false));
      Add(TaskKind::kStep, i, 0, name + ".skip", problems.Step(i, 0, false));
    }
    for (size_t a = problems.has_init() ? 0 : 1; a < actions.size(); ++a) {
      if (problems.ChecksOf(a).empty()) continue;
      Add(TaskKind::kDefined, 0, a, "defined." + (a == 0 ? "init" : actions[a]), problems.Defined(a));
    }
    Add(TaskKind::kSomeInitial, 0, 0, "sanity.initially", problems.SomeInitialState());
    for (size_t a = 1; a < actions.size(); ++a) {
      Add(TaskKind::kSomeValues, 0, a, "sanity.values." + actions[a], problems.SomeValues(a));
      Add(TaskKind::kSomeEnabled, 0, a, "sanity.enabled." + actions[a], problems.SomeEnabled(a));
    }
    for (size_t p = 0; p < problems.promises().size(); ++p) {
      Add(TaskKind::kSomeCondition, p, 0, "sanity.condition", problems.SomePromise(p, false));
      Add(TaskKind::kSomePromise, p, 0, "sanity.promise", problems.SomePromise(p, true));
      Add(TaskKind::kNow, p, 0, "sanity.now", problems.PromiseNow(p));
    }
    for (const Task& task : tasks_) report_.obligations += task.IsObligation() ? 1 : 0;
  }

  void WriteFiles() {
    if (options_.smt_out.empty()) return;
    for (const Task& task : tasks_) {
      if (!task.IsObligation()) continue;
      std::vector<expr::SmtAssertion> assertions;
      for (const solve::Assertion& a : task.problem.query.assertions) assertions.push_back({a.formula, a.group});
      const auto written = base::WriteFileAtomically(options_.smt_out / (task.name + ".smt2"),
                                                     "; unsatisfiable if and only if the obligation holds\n" + expr::ToSmtLib(arena_, assertions));
      if (!written.ok()) {
        report_.problems.push_back(fmt::format("{}: {}", (options_.smt_out / (task.name + ".smt2")).string(), written.error().message));
        return;
      }
    }
  }

  // Round 0 asks everything, round 1 what is undecided.
  void Solve(int round) {
    std::vector<Task*> todo;
    for (Task& task : tasks_) {
      if (round == 0 || task.Undecided()) todo.push_back(&task);
    }
    std::mutex mutex;
    size_t done = 0;
    base::ParallelFor(todo.size(), options_.jobs, [&](size_t i) {
      Task& task = *todo[i];
      const auto start = Clock::now();
      solve::Budget budget{options_.timeout, true};
      // A sanity check that takes long is no reason to wait: it can only warn.
      if (!task.IsObligation()) budget.time = std::min(budget.time, std::chrono::milliseconds(2000));
      task.answer = options_.solver->Check(task.problem.query, budget, options_.stop);
      if (round == 1 && std::holds_alternative<solve::Unknown>(task.answer) && !options_.stop.StopRequested()) {
        // The instances were too many or too hard: let the solver choose its own.
        solve::Query whole = task.problem.query;
        whole.assertions = task.problem.assertions;
        solve::Answer second = options_.solver->Check(whole, budget, options_.stop);
        if (std::holds_alternative<solve::Unsat>(second)) task.answer = std::move(second);
      }
      task.seconds += std::chrono::duration<double>(Clock::now() - start).count();
      std::optional<solve::Answer> other;
      if (options_.cross_check != nullptr && task.IsObligation() && (round == 1 || !task.Undecided())) {
        other = options_.cross_check->Check(task.problem.query, budget, options_.stop);
      }
      const std::scoped_lock lock(mutex);
      if (other) Compare(task, *other);
      ++done;
      if (options_.progress) options_.progress(done, todo.size(), task.name);
    });
  }

  void Compare(const Task& task, const solve::Answer& other) {
    if (std::holds_alternative<solve::Unknown>(other) || std::holds_alternative<solve::Unknown>(task.answer)) {
      ++report_.cross_unknown;
      return;
    }
    ++report_.cross_checked;
    if (task.answer.index() == other.index()) return;
    report_.disagreement = true;
    const auto word = [](const solve::Answer& a) { return std::holds_alternative<solve::Unsat>(a) ? "unsat" : "sat"; };
    diagnostics_.Report(diag::Kind::kKoordDisagreement, {}, fmt::format("{} says {} and {} says {} of `{}`", options_.solver->name(), word(task.answer),
                                                                    options_.cross_check->name(), word(other), task.name))
        .Help("one of the solvers is wrong: `--smt-out DIR` writes the question");
  }

  static Cell MakeCell(const Task& task, std::string column) {
    Cell cell{std::move(column), Outcome::kUnknown, {}, {}, task.seconds};
    if (const auto* unsat = std::get_if<solve::Unsat>(&task.answer)) {
      cell.outcome = Outcome::kProved;
      cell.core = unsat->core;
    } else if (const auto* unknown = std::get_if<solve::Unknown>(&task.answer)) {
      cell.reason = unknown->reason;
    } else {
      cell.outcome = Outcome::kFailed;
    }
    return cell;
  }

  void MakeRows(Problems& problems) {
    const std::vector<std::string>& actions = problems.round().actions();
    for (size_t i = 0; i < problems.theory().invariants(); ++i) report_.rows.push_back({problems.theory().InvariantName(i), {}, {}, {}});
    Row defined{"defined", {}, {}, {}};
    for (const Task& task : tasks_) {
      if (task.kind == TaskKind::kInitially) report_.rows[task.subject].cells.push_back(MakeCell(task, "initially"));
      if (task.kind == TaskKind::kStep) report_.rows[task.subject].cells.push_back(MakeCell(task, actions[task.action]));
      if (task.kind == TaskKind::kDefined) defined.cells.push_back(MakeCell(task, task.action == 0 ? "init" : actions[task.action]));
    }
    if (!defined.cells.empty()) report_.rows.push_back(std::move(defined));
  }

  void Sanity(Task& task, Problems& problems, Reporter& reporter) {
    const auto* unsat = std::get_if<solve::Unsat>(&task.answer);
    const std::string& action = problems.round().actions()[task.action];
    switch (task.kind) {
      case TaskKind::kInitially:
      case TaskKind::kStep:
      case TaskKind::kDefined: return;
      case TaskKind::kSomeInitial:
        if (unsat != nullptr) reporter.Contradiction("no initial state is possible", unsat->core);
        return;
      case TaskKind::kSomeValues:
        if (unsat != nullptr) reporter.Contradiction(fmt::format("what `{}` computes cannot exist", action), unsat->core);
        return;
      case TaskKind::kSomeEnabled:
        if (unsat != nullptr && !report_.contradiction) reporter.NeverEnabled(task.action, unsat->core);
        return;
      case TaskKind::kSomeCondition: condition_possible_ = unsat == nullptr; return;
      case TaskKind::kSomePromise:
        if (unsat != nullptr && condition_possible_) reporter.Contradiction("no controller can keep this promise", unsat->core);
        return;
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
    }
    std::set<std::string> used;
    for (const Row& row : report_.rows) {
      for (const Cell& cell : row.cells) used.insert(cell.core.begin(), cell.core.end());
    }
    std::vector<std::pair<std::string, diag::Span>> stated;
    for (const AssumeDef* def : model_.assumptions) stated.emplace_back(problems.theory().NameOf(*def), def->span);
    for (const SummaryDef* def : model_.summaries) stated.emplace_back(Theory::NameOf(*def), def->span);
    for (const auto& [name, span] : stated) {
      if (used.contains(name)) {
        if (std::find(report_.assumed.begin(), report_.assumed.end(), name) == report_.assumed.end()) report_.assumed.push_back(name);
      } else if (report_.AllProved()) {
        report_.unused.push_back(name);
        diagnostics_.Report(diag::Kind::kKoordUnusedAssumption, span, fmt::format("no proof uses `{}`", name));
      }
    }
    report_.unconstrained = problems.theory().Unconstrained();
  }

  const diag::SourceSet& sources_;
  const Model& model_;
  const ProveOptions& options_;
  diag::Diagnostics& diagnostics_;
  expr::Arena arena_;
  std::vector<Task> tasks_;
  std::vector<size_t> not_now_;
  bool condition_possible_ = true;
  Report report_;
};

}  // namespace

bool Report::AllProved() const {
  return !contradiction && !disagreement && !rows.empty() &&
         std::all_of(rows.begin(), rows.end(), [](const Row& r) { return r.verdict == Verdict::kProved; });
}

bool Report::AnyFailed() const {
  return contradiction || std::any_of(rows.begin(), rows.end(), [](const Row& r) {
           return r.verdict == Verdict::kRefuted || r.verdict == Verdict::kNotInductive;
         });
}

Report Prove(const diag::SourceSet& sources, const Model& model, const ProveOptions& options, diag::Diagnostics& diagnostics) {
  return Prover(sources, model, options, diagnostics).Run();
}

}  // namespace rondo::koord
