#pragma once

#include <optional>

#include "lang/expr_parser.h"
#include "robot/syntax/ast.h"

/// Shares the parser of robot types and worlds.
namespace rondo::robot {

/// Reads robot types and worlds. Languages that contain them derive their parsers from it.
///
/// Reports every syntax error, one for each cause. Never fails, whatever the tokens.
class Parser : public lang::ExprParser {
 public:
  using ExprParser::ExprParser;

 protected:
  /// Reads a name; `what` says in messages what it should name.
  Name ParseName(std::string_view what);
  /// Reads a robot type or a world behind the word `robot` or `world`, up to the closing brace.
  std::optional<RobotDef> ParseRobot(diag::Span start);
  std::optional<WorldDef> ParseWorld(diag::Span start);
  /// Reads arguments such as `(a, b = 2 m)`.
  std::vector<Argument> ParseArguments(std::string_view after);
  /// Reads a keyword that stands next, and the expression or names behind it.
  Clause ParseClause();
  /// Skips to behind the end of a block whose `{` was read, over blocks inside.
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

/// Reports whether the word begins a part of robots or worlds everywhere, so that it names nothing.
bool IsRobotWord(std::string_view word);
/// Returns all words of robot types and worlds.
std::vector<std::string> RobotWords();

}  // namespace rondo::robot
