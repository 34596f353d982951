#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "interval/interval.h"
#include "solve/icp/prepare/prepare.h"

/// A formula as straight-line code: one node for each distinct subterm, arguments before the nodes that use
/// them.
namespace rondo::solve::icp {

/// Names the operations of a tape: numbers first, then comparisons with constants, then formulas.
enum class NodeOp : uint8_t {
  // Numbers: arguments a, b.
  kVariable,
  kConstant,
  kAdd,
  kSub,
  kMul,
  kDiv,
  kNeg,
  kSqr,
  kPow,  // exponent: n
  kSqrt,
  kAbs,
  kMin,
  kMax,
  kSin,
  kCos,
  kTan,
  kAsin,
  kAcos,
  kAtan,
  kAtan2,
  kExp,
  kLog,
  kChoose,  // a or b; first of the two formulas that decide: n
  // How the number a compares with a constant: threshold n.
  kThreshold,
  // Formulas.
  kAtom,  // threshold a, relation n
  kAnd,   // children: from a, n of them
  kOr,
};

/// Is one node of a tape; what a, b and n mean depends on the operation.
struct Node {
  NodeOp op;
  uint32_t a = 0;
  uint32_t b = 0;
  uint32_t n = 0;
};

/// Is a constant that a number is compared with.
struct Threshold {
  uint32_t node;  ///< the kThreshold node
  Rational value;
  double below;        ///< the largest double <= value
  double above;        ///< the smallest double >= value
  bool lemma = false;  ///< of a comparison that holds anyway
};

/// Is a variable of a tape.
struct TapeVariable {
  TermId term;    ///< in the arena of what was prepared
  uint32_t node;  ///< the kVariable node
  bool integral;  ///< whether its values are integers
  /// Whether it is no use to split it; see MarkSingle.
  bool single;
  interval::Interval root;  ///< encloses all values that the bounds allow
};

/// Is a formula as straight-line code.
struct Tape {
  std::vector<Node> nodes;
  std::vector<interval::Interval> constants;              ///< by node; the whole line for other nodes
  std::vector<uint32_t> children;                         ///< of kAnd and kOr
  std::vector<std::pair<uint32_t, uint32_t>> conditions;  ///< of kChoose: when a is chosen, when b
  std::vector<Threshold> thresholds;
  std::vector<TapeVariable> variables;
  uint32_t root = 0;     ///< the node of the whole formula
  bool partial = false;  ///< whether a function occurs that is not defined everywhere
};

/// Reports whether the node is a number that is made of others.
inline bool IsComposite(NodeOp op) { return op > NodeOp::kConstant && op < NodeOp::kThreshold; }
/// Reports whether the node is a number that is made of two others.
bool IsBinary(NodeOp op);

/// Marks the variables that need not be split: those used once, in a number that is used once, and so on, for
/// which contraction is exact, given the others; and those used once, in a sum with a variable that is split.
void MarkSingle(Tape& tape);

/// Encloses a rational number, at most one unit in the last place wide.
interval::Interval Enclose(const Rational& value);

/// Returns the tape of everything in `prepared`. Cost: linear in the number of distinct subterms.
Tape BuildTape(expr::Arena& arena, const std::unordered_map<TermId, Variable>& variables,
               const Prepared& prepared);

}  // namespace rondo::solve::icp
