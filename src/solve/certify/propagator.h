#pragma once

#include <array>
#include <map>
#include <vector>

#include "expr/arena.h"
#include "solve/certify/arithmetic/enclosure.h"

/// Contraction of boxes, as the checker of certificates does it.
namespace rondo::solve::certify {

/// Holds bounds of the variables of a Propagator in turn.
using Box = std::vector<Enclosure>;

/// Contracts boxes by formulas (HC4 over the graph of their terms, Benhamou et al. 1999, in MPFR arithmetic):
/// what is cut off holds no solution.
class Propagator {
 public:
  explicit Propagator(const expr::Arena& arena) : arena_(arena) {}

  /// Adds a formula that solutions satisfy; all that are required hold together. Throws a Rejection for terms
  /// that it does not know.
  void Require(expr::TermId formula);
  /// Adds the equation constant + the sum of coefficient * term = 0; the terms are kept whole.
  void RequireSum(const std::vector<std::pair<expr::Rational, expr::TermId>>& parts,
                  const expr::Rational& constant);

  /// Returns the variables met so far, in the order of a Box.
  const std::vector<expr::TermId>& variables() const { return variables_; }
  /// Contracts the box, at most `sweeps` times forward and backward, fewer once little changes. Returns false
  /// if no solution lies in it.
  bool Contract(Box& box, int sweeps);

 private:
  enum class Kind : uint8_t {
    kVariable,
    kConstant,
    kAdd,
    kSub,
    kNeg,
    kMul,
    kDiv,
    kPow,  // exponent: n
    kFunction,
    kChoose,  // conditions: n
  };
  struct Node {
    Kind kind;
    uint32_t a = 0;
    uint32_t b = 0;
    uint32_t n = 0;
    expr::Elementary function = expr::Elementary::kCount_;
    friend auto operator<=>(const Node&, const Node&) = default;
  };
  struct Comparison {
    uint32_t node;
    Enclosure bound;
    uint8_t possible;
  };
  // A formula: a comparison and its relation, or a conjunction or disjunction of others.
  struct Form {
    enum class Kind : uint8_t { kLiteral, kAnd, kOr } kind;
    uint32_t comparison = 0;
    uint8_t relation = 0;
    std::vector<uint32_t> parts;
    uint64_t size;  // as a tree
  };

  uint32_t Number(expr::TermId term);
  uint32_t NewNumber(expr::TermId term);
  uint32_t Sum(expr::TermId term);
  uint32_t Product(expr::TermId term);
  uint32_t Push(const Node& node);
  uint32_t Constant(const expr::Rational& value);
  uint32_t Variable(expr::TermId variable);
  uint32_t Formula(expr::TermId formula, bool positive);
  uint32_t NewFormula(expr::TermId formula, bool positive);
  uint32_t Literal(expr::TermId a, expr::TermId b, uint8_t relation);
  uint32_t Compare(uint32_t node, const expr::Rational& bound, uint8_t relation);

  void Forward(bool again);
  Enclosure Evaluate(const Node& node) const;
  uint8_t Possible(const Comparison& comparison) const;
  bool MayHold(uint32_t form) const;
  bool Demand(uint32_t form);
  bool DemandComparison(const Form& form);
  bool Backward();
  bool BackwardNode(uint32_t id);
  bool BackwardFunction(const Node& node, const Enclosure& z);
  bool BackwardChoice(const Node& node, const Enclosure& z);
  bool Narrow(uint32_t node, const Enclosure& to);

  const expr::Arena& arena_;
  std::vector<Node> nodes_;
  std::vector<Enclosure> constants_;
  std::vector<std::array<uint32_t, 2>> conditions_;  // of kChoose: that a is chosen, that b is
  std::vector<Comparison> comparisons_;
  std::vector<Form> forms_;
  std::vector<uint32_t> required_;
  std::vector<expr::TermId> variables_;
  std::vector<uint32_t> variable_nodes_;
  std::map<expr::TermId, uint32_t> numbers_;
  std::map<Node, uint32_t> interned_;
  std::map<expr::Rational, uint32_t> constant_ids_;
  std::map<std::pair<expr::TermId, bool>, uint32_t> forms_of_;
  std::map<std::pair<uint32_t, expr::Rational>, uint32_t> comparison_ids_;
  // Of one contraction.
  std::vector<Enclosure> values_;
  std::vector<char> needed_;
  bool progress_ = false;  // of one sweep
};

}  // namespace rondo::solve::certify
