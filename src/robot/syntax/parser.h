#pragma once

#include <optional>

#include "lang/expr_parser.h"
#include "robot/syntax/ast.h"

namespace rondo::robot {

/// Reads robot types and worlds. Languages that contain them derive their parsers from it.
///
/// Reports every syntax error, one for each cause. Never fails, whatever the tokens.
class Parser : public lang::ExprParser {
 public:
  using ExprParser::ExprParser;

 protected:
  Name ParseName(std::string_view what);
  /// Behind `robot` and `world`, up to the closing brace.
  std::optional<RobotDef> ParseRobot(diag::Span start);
  std::optional<WorldDef> ParseWorld(diag::Span start);
  /// `(a, b = 2 m)`
  std::vector<Argument> ParseArguments(std::string_view after);
  /// A keyword that stands next, and the expression behind it.
  Clause ParseClause();
  /// Behind the end of a block whose `{` was read, over blocks inside.
  void SkipToClose();
  bool IsUnit(std::string_view word) const override;

 private:
  void ParseRobotItem(RobotDef& robot);
  Param ParseParam();
  std::vector<Param> ParseParams();
  void ParseRange(ExprId& least, ExprId& most);
  StateGroup ParseState(Name keyword);
  void ParseFrame(RobotDef& robot, Name keyword);
  void ParseDynamics(RobotDef& robot, diag::Span start);
  std::optional<ControlDef> ParseControl(diag::Span start);
  void ParseLaw(std::string_view what, std::vector<Derivative>& laws);
  void ParseMotion(RobotDef& robot, diag::Span start);
  void ParseComponent(WorldDef& world);
  void ParseObstacle(WorldDef& world);
  void ParseEnvironment(WorldDef& world);
};

/// Words that begin the parts of robots and worlds everywhere, so that they name nothing.
bool IsRobotWord(std::string_view word);

}  // namespace rondo::robot
