#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "base/stop.h"
#include "expr/arena.h"
#include "expr/smtlib/smtlib.h"
#include "expr/value.h"

/// One question, several engines: is there an interpretation that satisfies all assertions?
namespace rondo::solve {

/// Assertions with the same non-empty group are reported together in an unsatisfiable core.
struct Assertion {
  expr::TermId formula;
  std::string group;
};

/// What is asserted, without the groups.
std::vector<expr::TermId> Formulas(const std::vector<Assertion>& assertions);

using Value = expr::Value;

struct Query {
  const expr::Arena* arena = nullptr;
  std::vector<Assertion> assertions;
  /// Closed terms whose values a model should give.
  std::vector<expr::TermId> wanted;
};

/// The assertions as an SMT-LIB 2 script, groups as comments.
std::string ToSmtLib(const Query& query, expr::SmtFunctions functions = expr::SmtFunctions::kSpelledOut);

/// No interpretation satisfies the assertions.
struct Unsat {
  std::vector<std::string>
      core;  ///< groups that the engine's refutation used; a superset of what is necessary
  /// The script of the query and its refutation, as `solve/certify` reads it. Empty: the engine writes none.
  std::string certificate{};
};

/// The engine found an interpretation; values of the wanted terms that it could evaluate.
struct Sat {
  std::map<expr::TermId, Value> values;
  /// False: a solution was proved to exist; the values are near it.
  bool exact = true;
  /// Numbers near the values that are irrational.
  std::map<expr::TermId, expr::Rational> near{};
};

/// The engine gave up.
struct Unknown {
  std::string reason;
  bool timed_out = false;  ///< more time might have helped
};

/// Neither: a small box in which nothing could be excluded, and no solution was verified. Bounds of the
/// variables.
struct DeltaSat {
  std::map<expr::TermId, std::pair<double, double>> box;
};

using Answer = std::variant<Unsat, Sat, DeltaSat, Unknown>;

struct Budget {
  std::chrono::milliseconds time{10'000};
  bool core = true;          ///< compute a core when unsatisfiable
  bool certificate = false;  ///< write a certificate when unsatisfiable
};

/// Thread-safe: one object may serve several threads, each call is independent. Errors of the engine are
/// `Unknown`.
class Solver {
 public:
  virtual ~Solver() = default;
  virtual std::string name() const = 0;
  virtual Answer Check(const Query& query, const Budget& budget, const base::StopToken& stop) const = 0;
};

}  // namespace rondo::solve
