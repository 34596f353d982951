#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/stop.h"
#include "lang/smtlib/script.h"
#include "solve/portfolio/portfolio.h"

/// SMT-LIB scripts that are run: `rondo solve`.
namespace rondo::solve::script {

/// Says which engines answer, and what is asked besides.
struct ScriptOptions {
  std::vector<const solve::Solver*> portfolio;  ///< engines beside interval arithmetic
  const solve::Solver* only = nullptr;          ///< asked instead of all others, if there is one
  unsigned jobs = 1;                            ///< threads of interval arithmetic
  std::chrono::milliseconds timeout{60'000};    ///< for all of the script
  std::optional<double> precision;              ///< instead of what the script says
  bool compare = false;                         ///< whether to wait for all engines and compare their answers
  bool lemmas = true;                           ///< whether rotations are looked for (`icp::Options`)
  bool certificate = false;                     ///< whether refutations are written down
  bool want_model = false;                      ///< as if `(get-model)` followed each `(check-sat)`
};

/// Is what one `(check-sat)` found.
struct CheckOutcome {
  solve::AnswerKind answer = solve::AnswerKind::kUnknown;
  std::string reason;  ///< of `unknown`
  double seconds = 0;
  solve::portfolio::Report report;
  std::vector<std::pair<std::string, std::string>> model;  ///< variables and their values, of `sat`
};

/// Is what a script printed and found.
struct ScriptOutcome {
  std::string text;  ///< what the script prints
  std::vector<CheckOutcome> checks;
};

/// Runs the commands of a script that was read without errors.
ScriptOutcome RunScript(const lang::smtlib::Script& script, const ScriptOptions& options,
                        const base::StopToken& stop);

/// Returns what each `(check-sat)` asks, as certificates begin with it.
std::vector<std::string> Questions(const lang::smtlib::Script& script);

/// Returns `text` with `prefix` before each line.
std::string Prefixed(const std::string& text, const std::string& prefix);

}  // namespace rondo::solve::script
