#pragma once

#include <Eigen/Dense>
#include <vector>

#include "interval/interval.h"
#include "reach/problem/program.h"

/// Slopes of programs on boxes: the mean value theorem, and Clarke's at kinks.
namespace rondo::reach::certify {

/// Says which value a node without derivative has on a box.
enum class Choice : uint8_t {
  kFirst,   ///< kAbs: the argument; kMax, kChoose: the first one
  kSecond,  ///< kAbs: its negation; kMax, kChoose: the second one
  kOpen,    ///< it differs, or cannot be told; of kAtan2: the angle may jump
};

/// Is a program on a box: what every node can be, and how the outputs change with the variables.
struct OnBox {
  std::vector<interval::Interval> values;  ///< by node: encloses its values on the box
  std::vector<Choice> choices;             ///< by node
  /// By output and variable: J with f(y) - f(x) in J (y - x) for all x, y of the box. Where a kChoose is
  /// open, f(x) is any of both values there; where an angle may jump, it is any angle, whatever x is.
  std::vector<interval::Interval> slopes;
};

/// Holds what is known of the nodes besides the box: states are p + e, where f(p) lies in `nodes` for each
/// node f, and |e_i| <= errors[i].
struct Nearby {
  std::vector<interval::Interval> nodes;
  Eigen::VectorXd errors;  ///< by state: the first variables
};

/// Encloses all nodes on the box, and the slopes of the first `count` outputs. Returns false if some node is
/// not defined on all of the box, or not bounded.
///
/// @param count  so many outputs, the first ones.
/// @param nearby  if there is one, only states that are also near what it says are looked at.
bool Linearise(const Program& program, const interval::Box& box, size_t count, OnBox& out,
               const Nearby* nearby = nullptr);

}  // namespace rondo::reach::certify
