#include "choreo/obligations/obligations.h"

namespace rondo::choreo {

bool IsRequired(ObligationKind kind) {
  return kind != ObligationKind::kStart && kind != ObligationKind::kReached;
}

std::string_view KindName(ObligationKind kind) {
  switch (kind) {
    case ObligationKind::kHull:
      return "hull";
    case ObligationKind::kInitial:
      return "initial";
    case ObligationKind::kPrecondition:
      return "precondition";
    case ObligationKind::kAssumption:
      return "assumption";
    case ObligationKind::kGuarantee:
      return "guarantee";
    case ObligationKind::kBody:
      return "body";
    case ObligationKind::kCollision:
      return "collision";
    case ObligationKind::kObstacle:
      return "obstacle";
    case ObligationKind::kRegion:
      return "region";
    case ObligationKind::kFork:
      return "fork";
    case ObligationKind::kThread:
      return "thread";
    case ObligationKind::kTotalChoice:
      return "total-choice";
    case ObligationKind::kMessage:
      return "message";
    case ObligationKind::kContract:
      return "contract";
    case ObligationKind::kKeeping:
      return "keeping";
    case ObligationKind::kInterrupted:
      return "interrupted";
    case ObligationKind::kStart:
      return "start";
    case ObligationKind::kProcess:
      return "process";
    case ObligationKind::kReached:
      return "reached";
  }
  return "";
}

}  // namespace rondo::choreo
