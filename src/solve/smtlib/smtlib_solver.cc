#include "solve/smtlib/smtlib_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "solve/smtlib/process.h"

namespace rondo::solve::smtlib {

SmtLibSolver::SmtLibSolver(const std::string& command) : name_(command) {
  std::istringstream words(command);
  for (std::string word; words >> word;) command_.push_back(word);
  if (command_.size() != 1) return;
  const std::string program = std::filesystem::path(command_[0]).filename();
  if (program == "cvc5" || program == "cvc4")
    command_.insert(command_.end(), {"--lang=smt2", "--quiet", "-"});
  if (program == "dreal") command_.insert(command_.end(), {"--in"});
  if (program == "z3") command_.insert(command_.end(), {"-in", "-smt2"});
}

base::Result<bool> SmtLibSolver::Try() const {
  if (command_.empty()) return base::Error{"no command was given"};
  const base::StopToken stop;
  const auto output = RunProcess(command_, "(set-logic ALL)\n(check-sat)\n", std::chrono::seconds(10), stop);
  if (!output.ok()) return output.error();
  for (const char* answer : {"sat", "unknown"}) {
    if (output.value().text.find(answer) != std::string::npos) return true;
  }
  return base::Error{fmt::format("`{}` does not answer questions in SMT-LIB 2 on its standard input", name_)};
}

Answer SmtLibSolver::Check(const Query& query, const Budget& budget, const base::StopToken& stop) const {
  if (command_.empty()) return Unknown{"no command was given"};
  const auto output = RunProcess(command_, ToSmtLib(query), budget.time, stop);
  if (!output.ok()) return Unknown{output.error().message};
  if (output.value().timed_out) {
    if (stop.cancelled()) return Unknown{"interrupted"};
    return Unknown{fmt::format("time-out after {} ms", budget.time.count()), true};
  }
  const bool partial = std::ranges::any_of(
      query.assertions, [&](const Assertion& a) { return query.arena->IsPartial(a.formula); });
  std::istringstream lines(output.value().text);
  for (std::string line; std::getline(lines, line);) {
    if (line == "unsat") return Unsat{};
    // Programs take roots and logarithms for total functions: what satisfies the question for them need not for us
    // (docs/adr/0005-undefined-terms.md). Their `unsat` is about more interpretations, not fewer.
    if (line == "sat" && partial) return Unknown{name_ + " gives undefined terms values of its own"};
    if (line == "sat") return Sat{};
    if (line.starts_with("delta-sat")) return DeltaSat{};
    if (line == "unknown") return Unknown{name_ + " answers unknown"};
    if (line.starts_with("(error")) return Unknown{name_ + ": " + line};
  }
  return Unknown{fmt::format("{} ended with status {} and no answer", name_, output.value().status)};
}

}  // namespace rondo::solve::smtlib
