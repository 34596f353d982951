#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "expr/arena.h"
#include "interval/interval.h"

/// Validated reachability: enclosures of everything that controlled dynamics can do.
namespace rondo::reach {

using expr::Rational;
using expr::TermId;
using interval::Interval;

/// Names the operations of straight-line code. Arguments are numbers of nodes unless said otherwise.
enum class CodeOp : uint8_t {
  kVariable,    ///< a: index of the variable
  kLinear,      ///< parts from a, b of them, plus a constant
  kProduct,     ///< a * b
  kReciprocal,  ///< 1 / a
  kRoot,
  kSine,    ///< its cosine is the next node
  kCosine,  ///< its sine is the node before
  kExp,
  kLog,
  kAtan,   ///< b: the node 1 + a^2
  kAtan2,  ///< atan2(a, b); c: the node a^2 + b^2
  kAbs,
  kMax,     ///< of a and b
  kChoose,  ///< b if a <= 0, else c; which one holds at a = 0 is left open
};

/// Is one node of a program.
struct Code {
  CodeOp op;
  uint32_t a = 0, b = 0, c = 0;
};

/// Is a summand, factor * node; the real factor differs from the double by at most `error`.
struct LinearPart {
  double factor;
  double error;
  uint32_t node;
};

/// Holds real functions of variables as straight-line code; each distinct subterm is one node, arguments
/// first.
struct Program {
  std::vector<TermId> variables;
  std::vector<Code> code;
  std::vector<LinearPart> parts;         ///< summands of kLinear nodes
  std::vector<LinearPart> constants;     ///< by kLinear node: its constant (node: unused); else zero
  std::vector<uint32_t> variable_nodes;  ///< by variable: its node
  std::vector<uint32_t> outputs;         ///< by function: its node
  /// The first `core` outputs depend only on nodes before this one.
  uint32_t core_end = 0;
  /// By node: the variables that it depends on, ascending.
  std::vector<std::vector<uint32_t>> depends;
  /// Nodes without derivatives somewhere: kAbs, kMax, kChoose.
  std::vector<uint32_t> kinks;
};

/// Compiles the functions. Variables that occur in them must be in `variables`.
///
/// `core`: how many of the functions the program is mainly for; the others may be evaluated separately.
///
/// @error names what has no meaning for reachability: integer division, uninterpreted functions, quantifiers.
base::Result<Program> Compile(const expr::Arena& arena, std::vector<TermId> variables,
                              const std::vector<TermId>& functions, size_t core = SIZE_MAX);

/// Returns a double next to the number, and how far it may be off. Of two neighbours the one that is nearer
/// to zero, so that opposite numbers give opposite doubles.
LinearPart NearestConstant(const Rational& value);
/// Returns the least interval with double bounds that holds the number: two neighbouring doubles, or one.
Interval Enclose(const Rational& value);

}  // namespace rondo::reach
