#include "solve/smtlib/smtlib_solver.h"

#include <fmt/format.h>

#include <filesystem>
#include <sstream>

#include "expr/smtlib.h"
#include "solve/smtlib/process.h"

namespace rondo::solve::smtlib {

SmtLibSolver::SmtLibSolver(const std::string& command) : name_(command) {
  std::istringstream words(command);
  for (std::string word; words >> word;) command_.push_back(word);
  if (command_.size() != 1) return;
  const std::string program = std::filesystem::path(command_[0]).filename();
  if (program == "cvc5" || program == "cvc4")
    command_.insert(command_.end(), {"--lang=smt2", "--quiet", "-"});
  if (program == "z3") command_.insert(command_.end(), {"-in", "-smt2"});
}

Answer SmtLibSolver::Check(const Query& query, const Budget& budget, const base::StopToken& stop) const {
  if (command_.empty()) return Unknown{"no command was given"};
  std::vector<expr::SmtAssertion> assertions;
  for (const Assertion& a : query.assertions) assertions.push_back({a.formula, a.group});
  const auto output = RunProcess(command_, expr::ToSmtLib(*query.arena, assertions), budget.time, stop);
  if (!output.ok()) return Unknown{output.error().message};
  if (output.value().timed_out) {
    return Unknown{stop.cancelled() ? "interrupted"
                                    : fmt::format("time-out after {} ms", budget.time.count())};
  }
  std::istringstream lines(output.value().text);
  for (std::string line; std::getline(lines, line);) {
    if (line == "unsat") return Unsat{};
    if (line == "sat") return Sat{};
    if (line == "unknown") return Unknown{name_ + " answers unknown"};
    if (line.starts_with("(error")) return Unknown{name_ + ": " + line};
  }
  return Unknown{fmt::format("{} ended with status {} and no answer", name_, output.value().status)};
}

}  // namespace rondo::solve::smtlib
