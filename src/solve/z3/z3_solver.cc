#include "solve/z3/z3_solver.h"

#include <fmt/format.h>
#include <z3++.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "solve/z3/translate.h"

namespace rondo::solve::z3 {
namespace {

// How long Z3 may go on after it was asked to stop.
constexpr std::chrono::milliseconds kGrace{300};

std::atomic<bool> abandoned{false};

/// One question on a thread of its own. Z3 keeps no time-out in some of its loops, and does not always heed
/// an interrupt: then the thread is left behind, with all that it works on.
class Job : public std::enable_shared_from_this<Job> {
 public:
  explicit Job(const expr::Arena& arena) : translate(arena, context) {}

  // Whatever refers to the context lives as long as the thread.
  ::z3::context context;
  ::z3::solver solver{context, ::z3::solver::simple()};
  ::z3::expr_vector assumptions{context};
  Translator translate;
  std::map<std::string, ::z3::expr> literals;
  std::map<expr::TermId, ::z3::expr> names;  // of what is wanted

  /// nullopt: it did not end in time.
  std::optional<::z3::check_result> Check(const base::StopToken& stop) {
    std::thread([job = shared_from_this()] { job->Run(); }).detach();
    std::unique_lock lock(mutex_);
    std::optional<base::StopToken::Clock::time_point> asked;
    while (!wake_.wait_for(lock, std::chrono::milliseconds(20), [this] { return done_; })) {
      const auto now = base::StopToken::Clock::now();
      if (!stop.StopRequested()) continue;
      if (!asked) asked = now;
      if (now - *asked > kGrace) {
        abandoned = true;
        return std::nullopt;
      }
      context.interrupt();
    }
    if (!failure_.empty()) throw ::z3::exception(failure_.c_str());
    return result_;
  }

 private:
  void Run() {
    ::z3::check_result result = ::z3::unknown;
    std::string failure;
    try {
      result = solver.check(assumptions);
    } catch (const ::z3::exception& e) {
      failure = e.msg();
    }
    const std::scoped_lock lock(mutex_);
    result_ = result;
    failure_ = failure;
    done_ = true;
    wake_.notify_one();
  }

  std::mutex mutex_;
  std::condition_variable wake_;
  bool done_ = false;
  ::z3::check_result result_ = ::z3::unknown;
  std::string failure_;
};

Answer Run(const Query& query, const Budget& budget, const base::StopToken& stop) {
  const auto job = std::make_shared<Job>(*query.arena);
  ::z3::context& context = job->context;
  ::z3::solver& solver = job->solver;
  ::z3::params parameters(context);
  parameters.set("timeout", static_cast<unsigned>(std::max<int64_t>(1, budget.time.count())));
  parameters.set("core.minimize", false);  // a third of the time for little
  parameters.set("ctrl_c", false);  // the signal handler of Z3 is not made for several threads; ours is
  solver.set(parameters);
  const base::StopToken limited = stop.WithDeadline(base::StopToken::Clock::now() + budget.time);
  Translator& translate = job->translate;
  std::map<std::string, ::z3::expr>& literals = job->literals;
  ::z3::expr_vector& assumptions = job->assumptions;
  std::map<unsigned, std::string> group_of;
  for (const Assertion& assertion : query.assertions) {
    const ::z3::expr formula = translate(assertion.formula);
    if (assertion.group.empty() || !budget.core) {
      solver.add(formula);
      continue;
    }
    auto it = literals.find(assertion.group);
    if (it == literals.end()) {
      const ::z3::expr literal = context.bool_const(("group " + assertion.group).c_str());
      it = literals.emplace(assertion.group, literal).first;
      assumptions.push_back(literal);
      group_of[literal.id()] = assertion.group;
    }
    solver.add(::z3::implies(it->second, formula));
  }
  // Evaluating a term in a model has no time limit: what is wanted gets a name, and the model knows its
  // value.
  for (const expr::TermId t : query.wanted) {
    const expr::SortKind kind = query.arena->sort(query.arena->sort_of(t)).kind;
    const ::z3::expr value = translate(t);
    if (query.arena->op(t) == expr::Op::kVariable || kind == expr::SortKind::kArray) continue;
    const ::z3::expr name(context, Z3_mk_fresh_const(context, "wanted", value.get_sort()));
    solver.add(name == value);
    job->names.emplace(t, name);
  }
  const std::optional<::z3::check_result> result = job->Check(limited);
  if (!result) {
    if (stop.cancelled()) return Unknown{"interrupted"};
    return Unknown{fmt::format("time-out after {} ms", budget.time.count()), true};
  }
  switch (*result) {
    case ::z3::unsat: {
      Unsat unsat;
      for (const ::z3::expr& literal : solver.unsat_core()) unsat.core.push_back(group_of.at(literal.id()));
      std::sort(unsat.core.begin(), unsat.core.end());
      return unsat;
    }
    case ::z3::sat: {
      Sat sat;
      const ::z3::model model = solver.get_model();
      for (const expr::TermId t : query.wanted) {
        try {
          const expr::SortKind kind = query.arena->sort(query.arena->sort_of(t)).kind;
          if (kind == expr::SortKind::kArray) continue;
          const auto name = job->names.find(t);
          const ::z3::expr value = model.eval(name != job->names.end() ? name->second : translate(t), true);
          if (const auto near = translate.Near(value)) {
            sat.near.emplace(t, *near);
          } else {
            sat.values.emplace(t, translate.Read(value, query.arena->sort_of(t)));
          }
        } catch (const ::z3::exception&) {
          // No finite value, such as a root: the term stays without one.
        }
      }
      return sat;
    }
    case ::z3::unknown:
      break;
  }
  if (stop.cancelled()) return Unknown{"interrupted"};
  const std::string reason = solver.reason_unknown();
  if (reason == "timeout" || reason == "canceled" || limited.expired())
    return Unknown{fmt::format("time-out after {} ms", budget.time.count()), true};
  return Unknown{"Z3: " + reason};
}

}  // namespace

bool LeftBehind() { return abandoned; }

std::string Z3Solver::name() const {
  unsigned major = 0;
  unsigned minor = 0;
  unsigned build = 0;
  unsigned revision = 0;
  Z3_get_version(&major, &minor, &build, &revision);
  return fmt::format("z3 {}.{}.{}", major, minor, build);
}

Answer Z3Solver::Check(const Query& query, const Budget& budget, const base::StopToken& stop) const {
  if (stop.StopRequested()) return Unknown{stop.cancelled() ? "interrupted" : "time-out", !stop.cancelled()};
  try {
    return Run(query, budget, stop);
  } catch (const ::z3::exception& failure) {
    return Unknown{std::string("Z3: ") + failure.msg()};
  }
}

}  // namespace rondo::solve::z3
