#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/stop.h"
#include "expr/arena.h"
#include "expr/smtlib/smtlib.h"
#include "expr/value.h"

/// One question, several engines: is there an interpretation that satisfies all assertions?
namespace rondo::solve {

/// Is a formula that must hold. Assertions with the same non-empty group are reported together in an
/// unsatisfiable core.
struct Assertion {
  expr::TermId formula;
  std::string group;
};

/// Returns what is asserted, without the groups.
std::vector<expr::TermId> Formulas(const std::vector<Assertion>& assertions);

using Value = expr::Value;

/// Is one question: is there an interpretation that satisfies all assertions?
struct Query {
  const expr::Arena* arena = nullptr;
  std::vector<Assertion> assertions;
  /// Closed terms whose values a model should give.
  std::vector<expr::TermId> wanted;
};

/// Returns the assertions as an SMT-LIB 2.6 script, groups as comments.
std::string ToSmtLib(const Query& query, expr::SmtFunctions functions = expr::SmtFunctions::kSpelledOut);

/// Says that no interpretation satisfies the assertions.
struct Unsat {
  std::vector<std::string>
      core;  ///< groups that the engine's refutation used; a superset of what is necessary
  /// The script of the query and its refutation, as `solve/certify` reads it. Empty: the engine writes none.
  std::string certificate{};
};

/// Says that the engine found an interpretation; `values` are those of the wanted terms that it could
/// evaluate.
struct Sat {
  std::map<expr::TermId, Value> values;
  /// False if a solution was proved to exist, but the values are only near it.
  bool exact = true;
  /// Rational numbers near those wanted values that are irrational.
  std::map<expr::TermId, expr::Rational> near{};
};

/// Says that the engine gave up, and why.
struct Unknown {
  std::string reason;
  bool timed_out = false;  ///< more time might have helped
};

/// Says that there is a small box in which nothing could be excluded, though no solution was verified: no
/// claim either way. The name is that of Gao et al., whose guarantee about a weakened formula is not made.
/// `box`: bounds (lower, upper) of the variables.
struct DeltaSat {
  std::map<expr::TermId, std::pair<double, double>> box;
};

/// Is what an engine says to a question.
using Answer = std::variant<Unsat, Sat, DeltaSat, Unknown>;

/// Says what kind of answer it is, without what comes with it.
enum class AnswerKind : uint8_t { kUnsat, kSat, kDeltaSat, kUnknown };

/// Returns the kind of an answer.
AnswerKind KindOf(const Answer& answer);

/// Returns the word of scripts: `unsat`, `sat`, `delta-sat` or `unknown`.
std::string_view Name(AnswerKind kind);

/// Returns whether the answer settles the question: `unsat` or `sat`.
bool IsDefinite(const Answer& answer);

/// Says how long an engine may take, and what a refutation should come with.
struct Budget {
  std::chrono::milliseconds time{10'000};
  bool core = true;          ///< compute a core when unsatisfiable
  bool certificate = false;  ///< write a certificate when unsatisfiable
};

/// Answers questions. Thread-safe: one object may serve several threads, each call is independent. Errors of
/// the engine are `Unknown`.
class Solver {
 public:
  virtual ~Solver() = default;
  /// Returns the name of the engine, as messages and the proof cache know it.
  virtual std::string name() const = 0;
  /// Answers the question within the budget, or says `Unknown`. Polls `stop`.
  virtual Answer Check(const Query& query, const Budget& budget, const base::StopToken& stop) const = 0;
};

}  // namespace rondo::solve
