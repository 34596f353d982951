#include "diag/registry_tables.h"

namespace rondo::diag {
namespace {

constexpr KindInfo kTable[] = {
    {Kind::kRobotUnit, "robot-unit", Severity::kError, "a quantity that measures something else",
     "Lengths, times and angles do not mix: sums, comparisons and arguments are of one dimension. Numbers carry units: `m`,\n"
     "`cm`, `mm`, `s`, `ms`, `rad`, `deg`. A bare 0 fits everywhere.",
     "robot R {\n  state x : length in [0 m, 2 s]\n}\n", "check"},
    {Kind::kRobotType, "robot-type", Severity::kError, "a value of the wrong kind",
     "Quantities, formulas, coordinates, points of the world, frames and shapes are different things. `point(x, y, z)` is a\n"
     "point of the world, `(x, y)` are coordinates, `coordinates(frame, p)` leads from one to the other.",
     "robot R {\n  state x : length in [0 m, 2 m]\n  body x\n}\n", "check"},
    {Kind::kRobotRange, "robot-range", Severity::kError, "a range without values",
     "The range of a variable is `[least, most]`; a robot with an empty one could be in no state at all.",
     "robot R {\n  state x : length in [2 m, 1 m]\n}\n", "check"},
    {Kind::kRobotMount, "robot-mount", Severity::kError, "a robot that stands nowhere",
     "A robot stands in the world (`at`), or on a mount that the type of another robot declares (`on cart.top`); nobody\n"
     "carries itself, not even by way of others.",
     "robot R {\n  motion Idle() interruptible [0 s, inf) {}\n}\nworld W { a: R b: R on a.top }\n", "check"},
};

}  // namespace

std::span<const KindInfo> RobotKinds() { return kTable; }

}  // namespace rondo::diag
