#include "choreo/syntax/parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "lang/expr_parser.h"
#include "lang/lexer.h"
#include "lang/units.h"

namespace rondo::choreo {
namespace {

using diag::Kind;
using diag::Span;
using lang::TokenKind;

constexpr std::array<std::string_view, 31> kWords = {
    "robot", "world", "choreography", "param",    "state",    "motion", "interruptible", "noninterruptible",
    "in",    "at",    "initially",    "option",   "parallel", "thread", "choose",        "when",
    "loop",  "while", "rec",          "continue", "region",   "assume", "guarantee",     "and",
    "or",    "not",   "implies",      "true",     "false",    "forall", "exists"};
constexpr std::array<std::string_view, 6> kClauses = {"pre",  "assume",    "during",
                                                      "post", "footprint", "modifies"};
constexpr std::array<std::string_view, 3> kFacts = {"region", "assume", "guarantee"};
constexpr int kDeepestBlock = 100;

template <size_t N>
bool Contains(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

class Parser : public lang::ExprParser {
 public:
  Parser(const lang::TokenStream& stream, Module& module, diag::Diagnostics& diagnostics)
      : ExprParser(stream, module.exprs, diagnostics), module_(module) {}

  void ParseModule() {
    while (!AtKind(TokenKind::kEnd)) {
      ClearFailure();
      const size_t before = at_;
      ParseItem();
      if (failed()) Recover();
      if (at_ == before) Take();
    }
  }

 protected:
  bool IsReserved(std::string_view word) const override { return IsReservedWord(word); }
  bool IsUnit(std::string_view word) const override { return lang::FindUnit(word) != nullptr; }

 private:
  Name ParseName(std::string_view what) {
    const Span span = Peek().span;
    return {ExpectName(what), span};
  }

  // To the next item, over what belongs to this one.
  void Recover() {
    while (!AtKind(TokenKind::kEnd) && !At("robot") && !At("world") && !At("choreography")) Take();
    ClearFailure();
  }

  // Behind the end of a block whose `{` was read, over blocks inside.
  void SkipToClose() {
    int depth = 1;
    while (!AtKind(TokenKind::kEnd)) {
      if (At("{")) ++depth;
      if (At("}") && --depth == 0) break;
      Take();
    }
    Accept("}");
    ClearFailure();
  }

  void ParseItem() {
    const Span start = Peek().span;
    if (Accept("robot")) return ParseRobot(start);
    if (Accept("world")) return ParseWorld(start);
    if (Accept("choreography")) return ParseChoreography(start);
    Unexpected("`robot`, `world` or `choreography`");
  }

  // -- robots

  void ParseRobot(Span start) {
    RobotDef robot;
    robot.name = ParseName("a robot type");
    if (!Expect("{", "the name of a robot type")) return;
    while (!At("}") && !AtKind(TokenKind::kEnd)) {
      const Span item = Peek().span;
      if (Accept("param")) {
        ParamGroup group{item, {}};
        do {
          group.params.push_back(ParseParam());
        } while (!failed() && Accept(","));
        group.span = item.To(PreviousSpan());
        robot.items.emplace_back(std::move(group));
      } else if (Accept("state")) {
        ParseState(robot, item);
      } else if (Accept("motion")) {
        ParseMotion(robot, item);
      } else {
        Unexpected("`param`, `state` or `motion`");
      }
      if (failed()) return SkipToClose();
      Accept(";");
    }
    Expect("}", "the last part of a robot");
    robot.span = start.To(PreviousSpan());
    module_.items.emplace_back(std::move(robot));
  }

  Param ParseParam() {
    Param param{ParseName("a parameter"), {}};
    if (Accept("=")) param.value = ParseExpr();
    return param;
  }

  std::vector<Param> ParseParams() {
    std::vector<Param> params;
    if (!Expect("(", "the name of a motion")) return params;
    while (!At(")") && !failed()) {
      params.push_back(ParseParam());
      if (!Accept(",")) break;
    }
    Expect(")", "the parameters");
    return params;
  }

  void ParseRange(ExprId& least, ExprId& most) {
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

  void ParseState(RobotDef& robot, Span start) {
    StateGroup group;
    do {
      group.names.push_back(ParseName("a state variable"));
    } while (!failed() && Accept(","));
    if (!Expect(":", "the state variables")) return;
    group.dimension = ParseName("a dimension such as `length`, `angle` or `time`");
    if (Accept("in")) ParseRange(group.least, group.most);
    group.span = start.To(PreviousSpan());
    if (!failed()) robot.items.emplace_back(std::move(group));
  }

  void ParseMotion(RobotDef& robot, Span start) {
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
      Clause clause{{std::string(Peek().text), Peek().span}, {}, {}};
      if (!AtKind(TokenKind::kName) || !Contains(kClauses, Peek().text)) {
        Unexpected("`modifies`, `pre`, `assume`, `during`, `post` or `footprint`");
        return;
      }
      Take();
      if (clause.keyword.text == "modifies") {
        do {
          clause.names.push_back(ParseName("a state variable"));
        } while (!failed() && Accept(","));
      } else {
        clause.value = ParseExpr();
      }
      if (failed()) return;
      motion.clauses.push_back(std::move(clause));
      Accept(";");
    }
    Expect("}", "the contract of a motion");
    robot.items.emplace_back(std::move(motion));
  }

  // -- worlds

  void ParseWorld(Span start) {
    WorldDef world;
    world.name = ParseName("a world");
    if (!Expect("{", "the name of a world")) return;
    while (!At("}") && !AtKind(TokenKind::kEnd)) {
      Component component;
      component.name = ParseName("a robot");
      Expect(":", "the name of a robot");
      if (!failed()) component.type = ParseName("a robot type");
      if (!failed() && Accept("at")) component.place = ParseExpr();
      if (failed()) return SkipToClose();
      world.components.push_back(std::move(component));
      Accept(";");
    }
    Expect("}", "the robots of a world");
    world.span = start.To(PreviousSpan());
    module_.items.emplace_back(std::move(world));
  }

  // -- choreographies

  void ParseChoreography(Span start) {
    ChoreographyDef choreography;
    choreography.name = ParseName("a choreography");
    if (!Expect("in", "the name of a choreography")) return;
    choreography.world = ParseName("a world");
    choreography.span = start.To(PreviousSpan());
    if (!Expect("{", "the world of a choreography")) return;
    while (!failed()) {
      if (Accept("option")) {
        choreography.options.push_back(ParseName("an option"));
      } else if (Accept("initially")) {
        choreography.initially = ParseExpr();
      } else {
        break;
      }
      Accept(";");
    }
    choreography.body = ParseStatements();
    Expect("}", "the last step of a choreography");
    module_.items.emplace_back(std::move(choreography));
  }

  // Up to `}`, which is left.
  std::vector<Stmt> ParseStatements() {
    std::vector<Stmt> body;
    if (++nesting_ > kDeepestBlock) {
      if (!failed()) diagnostics_.Report(Kind::kSyntaxNesting, Peek().span, "blocks are nested too deeply");
      Unexpected("fewer blocks");
    }
    while (!At("}") && !AtKind(TokenKind::kEnd) && !failed()) {
      if (Accept(";")) continue;
      Stmt stmt;
      stmt.span = Peek().span;
      ParseStatement(stmt);
      if (failed()) {
        // One report for this statement; the rest of the block is read on.
        SkipStatement();
        continue;
      }
      body.push_back(std::move(stmt));
    }
    --nesting_;
    return body;
  }

  void SkipStatement() {
    int depth = 0;
    while (!AtKind(TokenKind::kEnd)) {
      if (depth == 0 && (At("}") || At(";"))) break;
      if (At("{")) ++depth;
      if (At("}")) --depth;
      Take();
    }
    ClearFailure();
  }

  std::vector<Stmt> ParseBlock(std::string_view after) {
    std::vector<Stmt> body;
    if (!Expect("{", after)) return body;
    body = ParseStatements();
    Expect("}", "the last step of a block");
    return body;
  }

  void ParseStatement(Stmt& stmt) {
    if (Accept("parallel")) return ParseBranches(stmt, StmtKind::kParallel);
    if (Accept("choose")) {
      if (!Expect("at", "`choose`")) return;
      stmt.chooser = ParseName("the robot that chooses");
      return ParseBranches(stmt, StmtKind::kChoose);
    }
    if (Accept("loop")) {
      stmt.kind = StmtKind::kLoop;
      stmt.body = ParseBlock("`loop`");
      return;
    }
    if (Accept("while")) {
      stmt.kind = StmtKind::kWhile;
      stmt.guard = ParseExpr();
      stmt.span = stmt.span.To(PreviousSpan());
      stmt.body = ParseBlock("the guard of a loop");
      return;
    }
    if (Accept("rec")) {
      stmt.kind = StmtKind::kRec;
      stmt.label = ParseName("a recursion");
      stmt.span = stmt.span.To(PreviousSpan());
      stmt.body = ParseBlock("the name of a recursion");
      return;
    }
    if (Accept("continue")) {
      stmt.kind = StmtKind::kContinue;
      stmt.label = ParseName("a recursion");
      stmt.span = stmt.span.To(PreviousSpan());
      return;
    }
    if (Accept("{")) {
      stmt.kind = StmtKind::kMotion;
      do {
        stmt.motions.push_back(ParseMotionCall(ParseName("a robot")));
      } while (!failed() && Accept(","));
      Expect("}", "the motions of a step");
      stmt.span = stmt.span.To(PreviousSpan());
      return;
    }
    const Name first = ParseName("a step: a message `a -> b: label()`, a motion `a: Move()`, or a block");
    if (failed()) return;
    if (At("->")) return ParseMessage(stmt, first);
    stmt.kind = StmtKind::kMotion;
    stmt.motions.push_back(ParseMotionCall(first));
    stmt.span = stmt.span.To(PreviousSpan());
  }

  MotionCall ParseMotionCall(Name robot) {
    MotionCall call{std::move(robot), {}, {}};
    if (!Expect(":", "a robot")) return call;
    call.motion = ParseName("a motion");
    if (!Expect("(", "the name of a motion")) return call;
    while (!At(")") && !failed()) {
      Argument argument;
      if (AtKind(TokenKind::kName) && Peek(1).text == "=") {
        argument.name = ParseName("a parameter");
        Take();
      }
      argument.value = ParseExpr();
      call.args.push_back(std::move(argument));
      if (!Accept(",")) break;
    }
    Expect(")", "the arguments of a motion");
    return call;
  }

  void ParseMessage(Stmt& stmt, Name from) {
    stmt.kind = StmtKind::kMessage;
    stmt.from = std::move(from);
    Take();
    stmt.to = ParseName("the robot that receives");
    if (failed() || !Expect(":", "the receiver")) return;
    stmt.label = ParseName("a label");
    if (failed()) return;
    if (Accept("(")) {
      while (!At(")") && !failed()) {
        Payload payload;
        if (AtKind(TokenKind::kName) && Peek(1).text == ":") {
          payload.name = ParseName("a payload");
          Take();
          payload.type = ParseName("a type");
          if (Accept("|")) payload.value = ParseExpr();
        } else {
          payload.value = ParseExpr();
        }
        stmt.payload.push_back(std::move(payload));
        if (!Accept(",")) break;
      }
      Expect(")", "the payload");
    }
    if (!failed() && Accept("when")) stmt.guard = ParseExpr();
    stmt.span = stmt.span.To(PreviousSpan());
  }

  void ParseBranches(Stmt& stmt, StmtKind kind) {
    stmt.kind = kind;
    const bool parallel = kind == StmtKind::kParallel;
    stmt.span = stmt.span.To(PreviousSpan());
    if (!Expect("{", parallel ? "`parallel`" : "the robot that chooses")) return;
    while (!At("}") && !AtKind(TokenKind::kEnd) && !failed()) {
      Branch branch;
      branch.span = Peek().span;
      if (!Expect(parallel ? "thread" : "when", parallel ? "`parallel {`" : "`choose at ... {`")) return;
      if (!parallel) branch.guard = ParseExpr();
      while (parallel && AtKind(TokenKind::kName) && Contains(kFacts, Peek().text) && !failed()) {
        Clause fact{{std::string(Peek().text), Peek().span}, {}, {}};
        Take();
        fact.value = ParseExpr();
        branch.facts.push_back(std::move(fact));
      }
      branch.span = branch.span.To(PreviousSpan());
      if (failed()) return;
      branch.body = ParseBlock(parallel ? "the head of a thread" : "the guard of an alternative");
      stmt.branches.push_back(std::move(branch));
    }
    Expect("}", parallel ? "the threads" : "the alternatives");
  }

  Module& module_;
  int nesting_ = 0;
};

}  // namespace

bool IsReservedWord(std::string_view word) {
  return Contains(kWords, word) || lang::FindUnit(word) != nullptr;
}

void Parse(const diag::SourceSet& sources, diag::FileId file, Module& module,
           diag::Diagnostics& diagnostics) {
  lang::LexerOptions options;
  options.indentation = false;
  options.bar = true;
  options.half_open = true;
  const lang::TokenStream stream = lang::Lex(sources, file, options, diagnostics);
  module.comments.insert(module.comments.end(), stream.comments.begin(), stream.comments.end());
  Parser(stream, module, diagnostics).ParseModule();
}

}  // namespace rondo::choreo
