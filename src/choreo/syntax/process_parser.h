#pragma once

#include <optional>

#include "choreo/syntax/ast.h"
#include "robot/syntax/parser.h"

/// Shares the parser of processes.
namespace rondo::choreo {

/// Reads processes, which say what one robot does. The base of the parser of `.rondo` files.
class ProcessParser : public robot::Parser {
 public:
  using robot::Parser::Parser;

 protected:
  /// Reads a process behind the word `process`, up to the closing brace; nothing after a report.
  std::optional<ProcessDef> ParseProcess(diag::Span start);
  /// Reads the call of a motion, such as `Move(1 m)`, of a robot.
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
