#include "sim/cores/fault.h"

#include <fmt/format.h>

namespace rondo::sim::cores {

std::string_view Name(FaultKind kind) {
  switch (kind) {
    case FaultKind::kLoss:
      return "loss";
    case FaultKind::kDelay:
      return "delay";
    case FaultKind::kDuplicate:
      return "duplicate";
    case FaultKind::kCorrupt:
      return "corrupt";
    case FaultKind::kOneWay:
      return "one-way";
    case FaultKind::kCut:
      return "cut";
    case FaultKind::kAlone:
      return "alone";
    case FaultKind::kCrash:
      return "crash";
    case FaultKind::kForget:
      return "forget";
    case FaultKind::kPause:
      return "pause";
    case FaultKind::kDiskFull:
      return "disk-full";
    case FaultKind::kSlow:
      return "slow";
    case FaultKind::kPlanner:
      return "planner";
    case FaultKind::kClock:
      return "clock";
  }
  return "";
}

std::string Tell(const Fault& f) {
  const auto what = [&]() -> std::string {
    switch (f.kind) {
      case FaultKind::kLoss:
        return fmt::format("{:.0f} % of all datagrams are lost", 100 * f.amount);
      case FaultKind::kDelay:
        return fmt::format("datagrams take up to {:.3g} s", f.amount);
      case FaultKind::kDuplicate:
        return fmt::format("{:.0f} % of all datagrams come twice", 100 * f.amount);
      case FaultKind::kCorrupt:
        return fmt::format("{:.0f} % of all datagrams are damaged", 100 * f.amount);
      case FaultKind::kOneWay:
        return fmt::format("nothing comes from robot {} to robot {}", f.robot, f.other);
      case FaultKind::kCut:
        return fmt::format("robots {} and {} do not hear each other", f.robot, f.other);
      case FaultKind::kAlone:
        return fmt::format("robot {} hears nobody and is not heard", f.robot);
      case FaultKind::kCrash:
        return fmt::format("robot {} is gone, and comes back with its disk", f.robot);
      case FaultKind::kForget:
        return fmt::format("robot {} is gone, and comes back without its disk", f.robot);
      case FaultKind::kPause:
        return fmt::format("robot {} stands still", f.robot);
      case FaultKind::kDiskFull:
        return fmt::format("the disk of robot {} is full", f.robot);
      case FaultKind::kSlow:
        return fmt::format("robot {} needs {:.3g} s for each step", f.robot, f.amount);
      case FaultKind::kPlanner:
        return fmt::format("functions of robot {} take {:.3g} s", f.robot, f.amount);
      case FaultKind::kClock:
        return fmt::format("the wall clock of robot {} is {:.3g} s ahead", f.robot, f.amount);
    }
    return "";
  };
  return fmt::format("from {:.3f} s on, for {:.3f} s: {}", Seconds(f.at), Seconds(f.length), what());
}

}  // namespace rondo::sim::cores
