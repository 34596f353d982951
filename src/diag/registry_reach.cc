#include "diag/registry_tables.h"

namespace rondo::diag {
namespace {

constexpr KindInfo kTable[] = {
    {Kind::kReachRefuted, "reach-refuted", Severity::kError, "a motion that breaks its contract",
     "From a state in which the motion may begin, the robot's dynamics lead to a state that the contract rules out. The trajectory\n"
     "is given: its start, and where and when it breaks the contract. Change the controller, or promise less.",
     "robot Ball {\n"
     "  state x: length in [-5 m, 5 m]\n"
     "  state v: speed in [-9 m / 1 s, 9 m / 1 s]\n"
     "  dynamics { x' = v; v' = -10 m / 1 s / 1 s }\n"
     "  motion Fall() noninterruptible [1 s, 1 s] {\n"
     "    modifies x, v\n"
     "    pre x == 2 m and v == 0\n"
     "    during x > 0 and v > -20 m / 1 s\n"
     "  }\n"
     "}\n",
     "reach"},
    {Kind::kReachUnknown, "reach-unknown", Severity::kError, "a contract that is neither proved nor refuted",
     "Either the robot's dynamics are not known well enough to look at the contract, or the enclosure of what they can do is too\n"
     "wide for it, and no trajectory breaks it. A longer `--timeout` allows more parts of the initial states.",
     "robot Ball {\n"
     "  state x: length in [-5 m, 5 m]\n"
     "  motion Roll() noninterruptible [1 s, 1 s] { modifies x\n"
     "    pre x == 0 }\n"
     "}\n",
     "reach"},
};

}  // namespace

std::span<const KindInfo> ReachKinds() { return kTable; }

}  // namespace rondo::diag
