#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/stop.h"
#include "lang/smtlib/script.h"
#include "solve/portfolio/portfolio.h"

namespace rondo::solve::script {

struct ScriptOptions {
  std::vector<const solve::Solver*> portfolio;  ///< engines beside interval arithmetic
  const solve::Solver* only = nullptr;          ///< instead of all others
  unsigned jobs = 1;
  std::chrono::milliseconds timeout{60'000};  ///< for all of the script
  std::optional<double> precision;            ///< instead of the script's
  bool compare = false;
  bool lemmas = true;
  bool certificate = false;
  bool want_model = false;  ///< as if `(get-model)` followed each `(check-sat)`
};

/// What one `(check-sat)` found.
struct CheckOutcome {
  std::string answer;  ///< `sat`, `unsat`, `delta-sat` or `unknown`
  std::string reason;  ///< of `unknown`
  double seconds = 0;
  solve::portfolio::Report report;
  std::vector<std::pair<std::string, std::string>> model;  ///< variables and their values, of `sat`
};

struct ScriptOutcome {
  std::string text;  ///< what the script prints
  std::vector<CheckOutcome> checks;
};

/// Runs the commands of a script that was read without errors.
ScriptOutcome RunScript(const lang::smtlib::Script& script, const ScriptOptions& options,
                        const base::StopToken& stop);

/// What each `(check-sat)` asks, as certificates begin with it.
std::vector<std::string> Questions(const lang::smtlib::Script& script);

/// `text` with `prefix` before each line.
std::string Prefixed(const std::string& text, const std::string& prefix);

}  // namespace rondo::solve::script
