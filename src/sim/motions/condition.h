#pragma once

#include <memory>
#include <random>
#include <span>
#include <vector>

#include "base/result.h"
#include "reach/problem/formula.h"
#include "reach/problem/numeric.h"

/// Simulates choreographies: robots that move as their contracts allow, in virtual time.
namespace rondo::sim::motions {

/// Returns a number that is equally likely anywhere in [low, high): the same on every machine.
double Between(std::mt19937_64& random, double low, double high);

/// Holds terms as code over variables that are given by position. Not thread-safe.
class Functions {
 public:
  /// @error names what has no meaning in numbers.
  static base::Result<Functions> Of(const expr::Arena& arena, const std::vector<expr::TermId>& terms,
                                    const std::vector<expr::TermId>& variables);
  /// Returns the values of the terms; valid until the next call.
  std::span<const double> operator()(std::span<const double> variables);

 private:
  struct Code {
    explicit Code(reach::Program made) : program(std::move(made)), evaluate(program) {}
    reach::Program program;
    reach::Evaluator evaluate;
  };
  explicit Functions(reach::Program program)
      : code_(std::make_unique<Code>(std::move(program))), values_(code_->program.outputs.size()) {}

  std::unique_ptr<Code> code_;
  std::vector<double> values_;
};

/// Holds a formula as code over variables that are given by position. Not thread-safe.
class Condition {
 public:
  /// Is what rounding may make of an equation that holds: a comparison counts as true up to this (SI units).
  static constexpr double kTolerance = 1e-7;

  /// @error names what is no comparison of reals.
  static base::Result<Condition> Of(expr::Arena& arena, expr::TermId formula,
                                    const std::vector<expr::TermId>& variables);
  /// Returns by how much the formula fails, at most; 0 or less if it holds. Infinite where a term has no value.
  double Miss(std::span<const double> values);
  /// Reports whether it holds, up to `kTolerance`.
  bool Holds(std::span<const double> values) { return Miss(values) <= kTolerance; }
  /// Moves the `free` values to near ones for which the formula holds, by Gauss-Newton steps of least length. Returns
  /// whether it found some; if not, the values are where the search ended.
  bool Approach(std::span<double> values, std::span<const size_t> free);

 private:
  Condition(reach::Formula formula, Functions terms)
      : formula_(std::move(formula)), terms_(std::move(terms)) {}
  void Violated(size_t node, std::span<const double> terms, std::vector<size_t>& atoms) const;
  double Miss(size_t node, std::span<const double> terms) const;

  reach::Formula formula_;
  Functions terms_;
};

}  // namespace rondo::sim::motions
