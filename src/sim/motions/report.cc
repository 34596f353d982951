#include "sim/motions/report.h"

namespace rondo::sim::motions {

std::string_view Name(Wrong wrong) {
  switch (wrong) {
    case Wrong::kCollision:
      return "collision";
    case Wrong::kFootprint:
      return "footprint";
    case Wrong::kPrecondition:
      return "precondition";
    case Wrong::kAssumption:
      return "assumption";
    case Wrong::kContract:
      return "contract";
    case Wrong::kRegion:
      return "region";
    case Wrong::kFork:
      return "fork";
    case Wrong::kGuarantee:
      return "guarantee";
    case Wrong::kMessage:
      return "message";
    case Wrong::kOrder:
      return "order";
    case Wrong::kChoice:
      return "choice";
    case Wrong::kWaiting:
      return "waiting";
    case Wrong::kStuck:
      return "stuck";
    case Wrong::kGaveUp:
      return "gave-up";
    case Wrong::kNoTime:
      return "no-time";
  }
  return "";
}

std::string_view Name(Curtain curtain) {
  switch (curtain) {
    case Curtain::kEnd:
      return "end";
    case Curtain::kTime:
      return "time";
    case Curtain::kFailed:
      return "failed";
    case Curtain::kLost:
      return "lost";
    case Curtain::kInterrupted:
      return "interrupted";
  }
  return "";
}

}  // namespace rondo::sim::motions
