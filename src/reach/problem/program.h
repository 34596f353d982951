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

struct Code {
  CodeOp op;
  uint32_t a = 0, b = 0, c = 0;
};

/// factor * node; the real factor differs from the double by at most `error`.
struct LinearPart {
  double factor;
  double error;
  uint32_t node;
};

/// Real functions of variables as straight-line code; each distinct subterm is one node, arguments first.
struct Program {
  std::vector<TermId> variables;
  std::vector<Code> code;
  std::vector<LinearPart> parts;
  std::vector<LinearPart> constants;  ///< by kLinear node: its constant (node: unused); else zero
  std::vector<uint32_t> variable_nodes;
  std::vector<uint32_t> outputs;
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

/// A double near the number, and how far it may be off.
LinearPart NearestConstant(const Rational& value);
/// Two neighbouring doubles, or one.
Interval Enclose(const Rational& value);

}  // namespace rondo::reach
