#include "solve/script/script_run.h"

#include <fmt/format.h>

#include <cmath>

#include "expr/evaluate.h"
#include "expr/numeric.h"
#include "expr/smtlib/smtlib.h"

namespace rondo::solve::script {
namespace {

using lang::smtlib::Command;
using Clock = std::chrono::steady_clock;

/// Boxes narrower than what the script asks for are tried before giving up: most questions that a wide box
/// leaves open are decided in narrow ones.
constexpr double kFinest = 1e-9;
/// dReal's default.
constexpr double kDefaultPrecision = 1e-3;

/// The assertions that hold between commands.
class Levels {
 public:
  explicit Levels(const lang::smtlib::Script& script) : script_(script), levels_(1) {}

  void Take(const Command& command) {
    if (command.kind == Command::Kind::kAssert) levels_.back().push_back({command.terms[0], ""});
    if (command.kind == Command::Kind::kPush) levels_.resize(levels_.size() + command.levels);
    if (command.kind == Command::Kind::kPop) levels_.resize(levels_.size() - command.levels);
    if (command.kind == Command::Kind::kReset || command.kind == Command::Kind::kResetAssertions)
      levels_.assign(1, {});
  }

  solve::Query Query(const std::vector<expr::TermId>& assumed) const {
    solve::Query query{&script_.arena, {}, script_.variables};
    for (const auto& level : levels_)
      query.assertions.insert(query.assertions.end(), level.begin(), level.end());
    for (const expr::TermId t : assumed) query.assertions.push_back({t, ""});
    return query;
  }

 private:
  const lang::smtlib::Script& script_;
  std::vector<std::vector<solve::Assertion>> levels_;
};

class Runner {
 public:
  Runner(const lang::smtlib::Script& script, const ScriptOptions& options, const base::StopToken& stop)
      : script_(script), options_(options), stop_(stop), levels_(script) {}

  ScriptOutcome Run() {
    for (const Command& command : script_.commands) {
      if (stop_.StopRequested()) break;
      One(command);
    }
    return std::move(outcome_);
  }

 private:
  void One(const Command& command) {
    switch (command.kind) {
      case Command::Kind::kAssert:
      case Command::Kind::kPush:
      case Command::Kind::kPop:
      case Command::Kind::kResetAssertions:
        levels_.Take(command);
        return;
      case Command::Kind::kReset:
        levels_.Take(command);
        declared_.clear();
        return;
      case Command::Kind::kDeclare:
        Declare(command.terms[0]);
        return;
      case Command::Kind::kEcho:
        outcome_.text += command.text + "\n";
        return;
      case Command::Kind::kCheckSat:
        Check(command.terms);
        if (options_.want_model) PrintModel();
        return;
      case Command::Kind::kGetModel:
        if (!options_.want_model) PrintModel();
        return;
      case Command::Kind::kGetValue:
        PrintValues(command);
        return;
    }
  }

  // Of several with one name the last one is meant.
  void Declare(expr::TermId variable) {
    std::erase_if(declared_, [&](expr::TermId v) { return Name(v) == Name(variable); });
    declared_.push_back(variable);
    if (const auto it = script_.names.find(variable); it != script_.names.end())
      printer_.Define(variable, expr::Quoted(it->second));
  }

  double Precision() const {
    if (options_.precision) return *options_.precision;
    return script_.precision ? script_.precision->ToDouble() : kDefaultPrecision;
  }

  void Check(const std::vector<expr::TermId>& assumed) {
    const solve::Query query = levels_.Query(assumed);
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline_ - Clock::now());
    const solve::Budget budget{std::max(left, std::chrono::milliseconds(1)), false, options_.certificate};
    const Clock::time_point start = Clock::now();
    CheckOutcome check;
    if (options_.only != nullptr) {
      check.report.answer = options_.only->Check(query, budget, stop_);
      check.report.outcomes.push_back(
          {options_.only->name(), solve::portfolio::Describe(check.report.answer), 0});
    } else {
      solve::portfolio::Options portfolio;
      portfolio.others = options_.portfolio;
      portfolio.compare = options_.compare;
      portfolio.icp.jobs = options_.jobs;
      portfolio.icp.lemmas = options_.lemmas;
      portfolio.icp.precision = std::min(kFinest, Precision());
      portfolio.icp.widest = Precision();
      check.report = solve::portfolio::PortfolioSolver(portfolio).Decide(query, budget, stop_);
    }
    check.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    Tell(check);
    outcome_.checks.push_back(std::move(check));
  }

  void Tell(CheckOutcome& check) {
    values_.clear();
    const solve::Answer& answer = check.report.answer;
    check.answer = solve::KindOf(answer);
    has_model_ = std::holds_alternative<solve::Sat>(answer);
    if (const auto* unknown = std::get_if<solve::Unknown>(&answer)) {
      check.reason = unknown->reason;
      outcome_.text += fmt::format("unknown\n; {}\n", unknown->reason);
      return;
    }
    outcome_.text += fmt::format("{}\n", solve::Name(check.answer));
    if (const auto* sat = std::get_if<solve::Sat>(&answer)) {
      values_ = sat->values;
      for (const auto& [variable, near] : sat->near) values_.emplace(variable, expr::Value{near});
      // Variables that nothing constrains may have any value.
      for (const expr::TermId v : declared_) {
        const bool truth = script_.arena.sort_of(v) == script_.arena.Bool();
        values_.emplace(v, truth ? expr::Value{false} : expr::Value{expr::Rational(0)});
      }
      if (!sat->exact || !sat->near.empty())
        outcome_.text += "; a solution exists; the values of a model are near it\n";
      for (const expr::TermId v : declared_) {
        if (const auto it = values_.find(v); it != values_.end())
          check.model.emplace_back(Name(v), expr::ToString(it->second));
      }
    }
    if (const auto* delta = std::get_if<solve::DeltaSat>(&answer)) {
      for (const auto& [variable, range] : delta->box)
        outcome_.text += fmt::format("; {} in [{}, {}]\n", Name(variable), range.first, range.second);
    }
  }

  std::string Name(expr::TermId v) const { return script_.NameOf(v); }

  bool HasModel() {
    if (!has_model_) outcome_.text += "(error \"there is no model: the last answer was not `sat`\")\n";
    return has_model_;
  }

  void PrintModel() {
    if (!has_model_ && options_.want_model) return;
    if (!HasModel()) return;
    outcome_.text += "(\n";
    for (const expr::TermId v : declared_) {
      const auto it = values_.find(v);
      if (it == values_.end()) continue;
      outcome_.text += fmt::format("  (define-fun {} () {} {})\n", printer_.Print(v),
                                   script_.arena.sort(script_.arena.sort_of(v)).name, Literal(it->second));
    }
    outcome_.text += ")\n";
  }

  static std::string Literal(const expr::Value& value) {
    if (!value.IsNumber()) return expr::ToString(value);
    const expr::Rational& r = value.AsNumber();
    const bool negative = r < expr::Rational(0);
    const expr::Rational size = negative ? expr::Rational(0) - r : r;
    const std::string text =
        size.IsInteger() ? size.Numerator() : fmt::format("(/ {} {})", size.Numerator(), size.Denominator());
    return negative ? fmt::format("(- {})", text) : text;
  }

  // Of a function that has no rational value there: what doubles make of it.
  std::string Nearly(expr::TermId term) {
    if (script_.arena.sort_of(term) == script_.arena.Bool()) return "?";
    expr::Numeric::Point point;
    for (const auto& [variable, value] : values_) {
      if (value.IsNumber()) point[variable] = value.AsNumber().ToDouble();
    }
    const double near = expr::Numeric(script_.arena, point)(term);
    return std::isfinite(near) ? Literal(expr::Value{expr::Rational::FromDouble(near)}) : "?";
  }

  void PrintValues(const Command& command) {
    if (!HasModel()) return;
    const expr::Valuation valuation = [&](expr::TermId t) -> std::optional<expr::Value> {
      const auto it = values_.find(t);
      return it == values_.end() ? std::nullopt : std::optional(it->second);
    };
    outcome_.text += "(";
    for (size_t i = 0; i < command.terms.size(); ++i) {
      const auto value = expr::Evaluate(script_.arena, command.terms[i], valuation);
      outcome_.text += fmt::format("{}({} {})", i == 0 ? "" : "\n ", printer_.Print(command.terms[i]),
                                   value ? Literal(*value) : Nearly(command.terms[i]));
    }
    outcome_.text += ")\n";
  }

  const lang::smtlib::Script& script_;
  const ScriptOptions& options_;
  const base::StopToken& stop_;
  Levels levels_;
  std::vector<expr::TermId> declared_;  // in sight, in order
  expr::SmtPrinter printer_{script_.arena, expr::SmtFunctions::kNamed};
  std::map<expr::TermId, expr::Value> values_;
  bool has_model_ = false;  // after `sat`
  Clock::time_point deadline_ = Clock::now() + options_.timeout;
  ScriptOutcome outcome_;
};

}  // namespace

ScriptOutcome RunScript(const lang::smtlib::Script& script, const ScriptOptions& options,
                        const base::StopToken& stop) {
  return Runner(script, options, stop).Run();
}

std::vector<std::string> Questions(const lang::smtlib::Script& script) {
  std::vector<std::string> result;
  Levels levels(script);
  for (const Command& command : script.commands) {
    levels.Take(command);
    if (command.kind == Command::Kind::kCheckSat)
      result.push_back(solve::ToSmtLib(levels.Query(command.terms), expr::SmtFunctions::kNamed));
  }
  return result;
}

std::string Prefixed(const std::string& text, const std::string& prefix) {
  if (prefix.empty()) return text;
  std::string result;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    result += prefix + text.substr(begin, end - begin) + "\n";
    begin = end + 1;
  }
  return result;
}

}  // namespace rondo::solve::script
