#include "robot/syntax/parser.h"

#include <algorithm>
#include <array>

#include "lang/units.h"

namespace rondo::robot {
namespace {

using diag::Span;
using lang::TokenKind;

constexpr std::array<std::string_view, 8> kWords = {
    "robot", "param", "state", "motion", "interruptible", "noninterruptible", "in", "at"};
constexpr std::array<std::string_view, 6> kClauses = {"pre",  "assume",    "during",
                                                      "post", "footprint", "modifies"};

template <size_t N>
bool Contains(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

bool IsRobotWord(std::string_view word) { return Contains(kWords, word); }

std::vector<std::string> RobotWords() {
  std::vector<std::string> words(kWords.begin(), kWords.end());
  words.insert(words.end(), kClauses.begin(), kClauses.end());
  for (const char* word : {"input", "memory", "frame", "mount", "body", "hull", "port", "dynamics", "control",
                           "obstacle", "environment", "output", "every"})
    words.emplace_back(word);
  return words;
}

bool Parser::IsUnit(std::string_view word) const { return lang::FindUnit(word) != nullptr; }

Name Parser::ParseName(std::string_view what) {
  const Span span = Peek().span;
  return {ExpectName(what), span};
}

void Parser::SkipToClose() {
  int depth = 1;
  while (!AtKind(TokenKind::kEnd)) {
    if (At("{")) ++depth;
    if (At("}") && --depth == 0) break;
    Take();
  }
  Accept("}");
  ClearFailure();
}

// -- robots

std::optional<RobotDef> Parser::ParseRobot(Span start) {
  RobotDef robot;
  robot.name = ParseName("a robot type");
  if (!Expect("{", "the name of a robot type")) return std::nullopt;
  while (!At("}") && !AtKind(TokenKind::kEnd)) {
    ParseRobotItem(robot);
    if (failed()) {
      SkipToClose();
      return std::nullopt;
    }
    Accept(";");
  }
  Expect("}", "the last part of a robot");
  robot.span = start.To(PreviousSpan());
  return robot;
}

void Parser::ParseRobotItem(RobotDef& robot) {
  const Name keyword{std::string(Peek().text), Peek().span};
  if (Accept("param")) {
    ParamGroup group{keyword.span, {}};
    do {
      group.params.push_back(ParseParam());
    } while (!failed() && Accept(","));
    group.span = keyword.span.To(PreviousSpan());
    robot.items.emplace_back(std::move(group));
  } else if (Accept("state") || Accept("input") || Accept("memory")) {
    robot.items.emplace_back(ParseState(keyword));
  } else if (Accept("frame") || Accept("mount")) {
    ParseFrame(robot, keyword);
  } else if (Accept("body") || Accept("hull")) {
    robot.items.emplace_back(ShapeDef{keyword, ParseExpr()});
  } else if (Accept("port")) {
    PortDef port;
    port.name = ParseName("a port");
    if (!Expect("=", "the name of a port")) return;
    port.value = ParseExpr();
    robot.items.emplace_back(std::move(port));
  } else if (Accept("dynamics")) {
    ParseDynamics(robot, keyword.span);
  } else if (Accept("control")) {
    if (auto control = ParseControl(keyword.span)) robot.items.emplace_back(std::move(*control));
  } else if (Accept("motion")) {
    ParseMotion(robot, keyword.span);
  } else {
    Unexpected(
        "`param`, `state`, `input`, `memory`, `frame`, `mount`, `body`, `hull`, `port`, `dynamics`, `control` or `motion`");
  }
}

Param Parser::ParseParam() {
  Param param{ParseName("a parameter"), {}, {}, {}, {}};
  if (Accept(":")) param.dimension = ParseName("a dimension such as `length`, `angle` or `time`");
  if (!failed() && Accept("in")) ParseRange(param.least, param.most);
  if (!failed() && Accept("=")) param.value = ParseExpr();
  return param;
}

std::vector<Param> Parser::ParseParams() {
  std::vector<Param> params;
  if (!Expect("(", "the name of a motion")) return params;
  while (!At(")") && !failed()) {
    params.push_back(ParseParam());
    if (!Accept(",")) break;
  }
  Expect(")", "the parameters");
  return params;
}

void Parser::ParseRange(ExprId& least, ExprId& most) {
  Expect("[", "a range should begin here");
  if (failed()) return;
  least = ParseExpr();
  Expect(",", "the lower end of a range");
  if (failed()) return;
  most = ParseExpr();
  if (At(")")) {
    Take();  // [0, inf)
  } else {
    Expect("]", "the upper end of a range");
  }
}

StateGroup Parser::ParseState(Name keyword) {
  StateGroup group;
  do {
    group.names.push_back(ParseName("a variable"));
  } while (!failed() && Accept(","));
  if (!Expect(":", "the variables")) return group;
  group.dimension = ParseName("a dimension such as `length`, `angle` or `time`");
  if (Accept("in")) ParseRange(group.least, group.most);
  group.span = keyword.span.To(PreviousSpan());
  group.keyword = std::move(keyword);
  return group;
}

void Parser::ParseFrame(RobotDef& robot, Name keyword) {
  FrameDef frame;
  frame.keyword = std::move(keyword);
  frame.name = ParseName("a frame");
  if (!Expect("=", "the name of a frame")) return;
  frame.value = ParseExpr();
  robot.items.emplace_back(std::move(frame));
}

void Parser::ParseDynamics(RobotDef& robot, Span start) {
  DynamicsDef dynamics;
  if (!Expect("{", "`dynamics`")) return;
  while (!At("}") && !AtKind(TokenKind::kEnd)) {
    Derivative derivative;
    derivative.variable = ParseName("a state variable");
    if (!Expect("'", "a state variable; `x'` is its derivative") || !Expect("=", "a derivative")) return;
    derivative.value = ParseExpr();
    if (failed()) return;
    dynamics.derivatives.push_back(std::move(derivative));
    Accept(";");
  }
  Expect("}", "the last derivative");
  dynamics.span = start.To(PreviousSpan());
  robot.items.emplace_back(std::move(dynamics));
}

std::optional<ControlDef> Parser::ParseControl(Span start) {
  ControlDef control;
  if (Accept("every")) control.period = ParseExpr();
  if (failed() || !Expect("{", "`control` or its period")) return std::nullopt;
  while (!At("}") && !AtKind(TokenKind::kEnd)) {
    if (At("when")) {
      WhenDef event;
      const Span when = Peek().span;
      Take();
      event.condition = ParseExpr();
      event.span = when.To(PreviousSpan());
      if (failed() || !Expect("{", "the condition of an event")) return std::nullopt;
      while (!failed() && !At("}") && !AtKind(TokenKind::kEnd)) ParseLaw("a memory", event.updates);
      if (failed() || !Expect("}", "the last value that an event sets")) return std::nullopt;
      control.events.push_back(std::move(event));
      Accept(";");
    } else {
      ParseLaw("an input or a memory", control.laws);
    }
    if (failed()) return std::nullopt;
  }
  Expect("}", "the last law of a controller");
  control.span = start.To(PreviousSpan());
  return control;
}

void Parser::ParseLaw(std::string_view what, std::vector<Derivative>& laws) {
  Derivative law;
  law.variable = ParseName(what);
  if (failed() || !Expect("=", "what is set")) return;
  law.value = ParseExpr();
  if (failed()) return;
  laws.push_back(std::move(law));
  Accept(";");
}

Clause Parser::ParseClause() {
  Clause clause{{std::string(Peek().text), Peek().span}, {}, {}};
  Take();
  clause.value = ParseExpr();
  return clause;
}

void Parser::ParseMotion(RobotDef& robot, Span start) {
  MotionDef motion;
  motion.name = ParseName("a motion");
  motion.params = ParseParams();
  if (failed()) return;
  motion.interruptible = At("interruptible");
  if (!Accept("interruptible") && !Accept("noninterruptible")) {
    Unexpected("`interruptible` or `noninterruptible`");
    return;
  }
  ParseRange(motion.least, motion.most);
  motion.span = start.To(PreviousSpan());
  if (!Expect("{", "the duration of a motion")) return;
  while (!At("}") && !AtKind(TokenKind::kEnd)) {
    if (At("control")) {
      const Span control = Peek().span;
      Take();
      if (auto own = ParseControl(control)) motion.controls.push_back(std::move(*own));
      if (failed()) return;
      Accept(";");
      continue;
    }
    if (!AtKind(TokenKind::kName) || !Contains(kClauses, Peek().text)) {
      Unexpected("`modifies`, `pre`, `assume`, `during`, `post`, `footprint` or `control`");
      return;
    }
    if (At("modifies")) {
      Clause clause{{std::string(Peek().text), Peek().span}, {}, {}};
      Take();
      do {
        clause.names.push_back(ParseName("a state variable"));
      } while (!failed() && Accept(","));
      motion.clauses.push_back(std::move(clause));
    } else {
      motion.clauses.push_back(ParseClause());
    }
    if (failed()) return;
    Accept(";");
  }
  Expect("}", "the contract of a motion");
  robot.items.emplace_back(std::move(motion));
}

std::vector<Argument> Parser::ParseArguments(std::string_view after) {
  std::vector<Argument> args;
  if (!Expect("(", after)) return args;
  while (!At(")") && !failed()) {
    Argument argument;
    if (AtKind(TokenKind::kName) && Peek(1).text == "=") {
      argument.name = ParseName("a parameter");
      Take();
    }
    argument.value = ParseExpr();
    args.push_back(std::move(argument));
    if (!Accept(",")) break;
  }
  Expect(")", "the arguments");
  return args;
}

// -- worlds

std::optional<WorldDef> Parser::ParseWorld(Span start) {
  WorldDef world;
  world.name = ParseName("a world");
  if (!Expect("{", "the name of a world")) return std::nullopt;
  while (!At("}") && !AtKind(TokenKind::kEnd)) {
    const bool named = Peek(1).kind == TokenKind::kName;  // `obstacle: Cart` is a robot of that name
    if (At("obstacle") && named) {
      ParseObstacle(world);
    } else if (At("environment") && named) {
      ParseEnvironment(world);
    } else {
      ParseComponent(world);
    }
    if (failed()) {
      SkipToClose();
      return std::nullopt;
    }
    Accept(";");
  }
  Expect("}", "the robots of a world");
  world.span = start.To(PreviousSpan());
  return world;
}

void Parser::ParseComponent(WorldDef& world) {
  Component component;
  component.name = ParseName("a robot");
  Expect(":", "the name of a robot");
  if (!failed()) component.type = ParseName("a robot type");
  if (!failed() && At("(")) component.args = ParseArguments("a robot type");
  if (!failed() && Accept("at")) {
    component.place = ParseExpr();
  } else if (!failed() && Accept("on")) {
    component.parent = ParseName("the robot that it stands on");
    if (Expect(".", "a robot; a mount of it should stand behind it")) component.mount = ParseName("a mount");
  }
  world.components.push_back(std::move(component));
}

void Parser::ParseObstacle(WorldDef& world) {
  Take();
  ObstacleDef obstacle;
  obstacle.name = ParseName("an obstacle");
  if (Expect(":", "the name of an obstacle")) obstacle.shape = ParseExpr();
  world.obstacles.push_back(std::move(obstacle));
}

void Parser::ParseEnvironment(WorldDef& world) {
  Take();
  EnvironmentDef environment;
  environment.name = ParseName("a part of the environment");
  if (!Expect("{", "a part of the environment")) return;
  while (!At("}") && !AtKind(TokenKind::kEnd) && !failed()) {
    Name keyword{std::string(Peek().text), Peek().span};
    if (!Expect("output", "a part of the environment")) return;
    environment.outputs.push_back(ParseState(std::move(keyword)));
    Accept(";");
  }
  Expect("}", "the outputs");
  world.environments.push_back(std::move(environment));
}

}  // namespace rondo::robot
