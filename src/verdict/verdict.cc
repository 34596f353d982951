#include "verdict/verdict.h"

namespace rondo::verdict {
namespace {

int Rank(ExitStatus status) {
  switch (status) {
    case ExitStatus::kEstablished:
      return 0;
    case ExitStatus::kUndecided:
      return 1;
    case ExitStatus::kRejected:
      return 2;
    case ExitStatus::kUsage:
      return 3;
    case ExitStatus::kBug:
      return 4;
  }
  return 4;
}

}  // namespace

std::string_view Name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kProved:
      return "proved";
    case Verdict::kConditional:
      return "conditional";
    case Verdict::kUnknown:
      return "unknown";
    case Verdict::kNotInductive:
      return "not inductive";
    case Verdict::kRefuted:
      return "refuted";
  }
  return "";
}

ExitStatus StatusOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::kProved:
      return ExitStatus::kEstablished;
    case Verdict::kConditional:
    case Verdict::kUnknown:
      return ExitStatus::kUndecided;
    case Verdict::kNotInductive:
    case Verdict::kRefuted:
      return ExitStatus::kRejected;
  }
  return ExitStatus::kBug;
}

ExitStatus Worse(ExitStatus a, ExitStatus b) { return Rank(a) < Rank(b) ? b : a; }

}  // namespace rondo::verdict
