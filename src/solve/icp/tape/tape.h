#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "interval/interval.h"
#include "solve/icp/prepare/prepare.h"

/// A formula as straight-line code: one node for each distinct subterm, arguments before the nodes that use
/// them.
namespace rondo::solve::icp {

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

struct Node {
  NodeOp op;
  uint32_t a = 0;
  uint32_t b = 0;
  uint32_t n = 0;
};

struct Threshold {
  uint32_t node;  ///< the kThreshold node
  Rational value;
  double below;        ///< the largest double <= value
  double above;        ///< the smallest double >= value
  bool lemma = false;  ///< of a comparison that holds anyway
};

struct TapeVariable {
  TermId term;
  uint32_t node;
  bool integral;
  /// Is it no use to split it? See MarkSingle.
  bool single;
  interval::Interval root;  ///< encloses all values that the bounds allow
};

struct Tape {
  std::vector<Node> nodes;
  std::vector<interval::Interval> constants;              ///< by node; the whole line for other nodes
  std::vector<uint32_t> children;                         ///< of kAnd and kOr
  std::vector<std::pair<uint32_t, uint32_t>> conditions;  ///< of kChoose: when a is chosen, when b
  std::vector<Threshold> thresholds;
  std::vector<TapeVariable> variables;
  uint32_t root = 0;
  bool partial = false;  ///< does a function occur that is not defined everywhere?
};

/// Is the node a number that is made of others?
inline bool IsComposite(NodeOp op) { return op > NodeOp::kConstant && op < NodeOp::kThreshold; }
/// Of two others?
bool IsBinary(NodeOp op);

/// Marks the variables that need not be split: those used once, in a number that is used once, and so on, for
/// which contraction is exact, given the others; and those used once, in a sum with a variable that is split.
void MarkSingle(Tape& tape);

/// An enclosure of a rational number, at most one unit in the last place wide.
interval::Interval Enclose(const Rational& value);

/// The tape of everything in `prepared`. Cost: linear in the number of distinct subterms.
Tape BuildTape(expr::Arena& arena, const std::unordered_map<TermId, Variable>& variables,
               const Prepared& prepared);

}  // namespace rondo::solve::icp
