#pragma once

#include <optional>

#include "choreo/syntax/ast.h"
#include "robot/syntax/parser.h"

namespace rondo::choreo {

/// Reads processes: what one robot does. The base of the parser of `.rondo` files.
class ProcessParser : public robot::Parser {
 public:
  using robot::Parser::Parser;

 protected:
  /// Behind `process`, up to the closing brace.
  std::optional<ProcessDef> ParseProcess(diag::Span start);
  /// `Move(1 m)`, for a robot.
  MotionCall ParseCall(Name robot);

 private:
  std::vector<Act> ParseActs();
  std::vector<Act> ParseBlock(std::string_view after);
  bool ParseAct(Act& act);
  void ParseSend(Act& act);
  void ParseReceive(Act& act);
  void ParseCase(Act& act);
  void ParseIf(Act& act);

  int nesting_ = 0;
};

}  // namespace rondo::choreo
