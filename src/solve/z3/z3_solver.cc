#include "solve/z3/z3_solver.h"

#include <fmt/format.h>
#include <z3++.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "solve/z3/translate.h"

namespace rondo::solve::z3 {
namespace {

// Interrupts the context when the token asks for it or its deadline passes: Z3 does not keep its own
// time-outs in all of its loops.
class Watchdog {
 public:
  Watchdog(::z3::context& context, const base::StopToken& stop)
      : thread_([this, &context, &stop] {
          std::unique_lock lock(mutex_);
          while (!wake_.wait_for(lock, std::chrono::milliseconds(50), [this] { return done_; })) {
            if (stop.StopRequested()) context.interrupt();
          }
        }) {}
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;
  ~Watchdog() {
    {
      const std::scoped_lock lock(mutex_);
      done_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  bool done_ = false;
  std::thread thread_;
};

Answer Run(const Query& query, const Budget& budget, const base::StopToken& stop) {
  ::z3::context context;
  ::z3::solver solver(context, ::z3::solver::simple());
  ::z3::params parameters(context);
  parameters.set("timeout", static_cast<unsigned>(std::max<int64_t>(1, budget.time.count())));
  parameters.set("core.minimize", false);  // a third of the time for little
  parameters.set("ctrl_c", false);  // the signal handler of Z3 is not made for several threads; ours is
  solver.set(parameters);
  const base::StopToken limited = stop.WithDeadline(base::StopToken::Clock::now() + budget.time);
  Translator translate(*query.arena, context);
  std::map<std::string, ::z3::expr> literals;
  ::z3::expr_vector assumptions(context);
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
  ::z3::check_result result = ::z3::unknown;
  {
    const Watchdog watchdog(context, limited);
    result = solver.check(assumptions);
  }
  switch (result) {
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
          sat.values.emplace(t, translate.Read(model.eval(translate(t), true), query.arena->sort_of(t)));
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
    return Unknown{fmt::format("time-out after {} ms", budget.time.count())};
  return Unknown{"Z3: " + reason};
}

}  // namespace

std::string Z3Solver::name() const {
  unsigned major = 0;
  unsigned minor = 0;
  unsigned build = 0;
  unsigned revision = 0;
  Z3_get_version(&major, &minor, &build, &revision);
  return fmt::format("z3 {}.{}.{}", major, minor, build);
}

Answer Z3Solver::Check(const Query& query, const Budget& budget, const base::StopToken& stop) const {
  if (stop.StopRequested()) return Unknown{stop.cancelled() ? "interrupted" : "time-out"};
  try {
    return Run(query, budget, stop);
  } catch (const ::z3::exception& failure) {
    return Unknown{std::string("Z3: ") + failure.msg()};
  }
}

}  // namespace rondo::solve::z3
