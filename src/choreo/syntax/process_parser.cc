#include "choreo/syntax/process_parser.h"

#include "diag/diagnostic.h"

namespace rondo::choreo {
namespace {

using diag::Span;
using lang::TokenKind;

constexpr int kDeepestBlock = 100;

}  // namespace

std::optional<ProcessDef> ProcessParser::ParseProcess(Span start) {
  ProcessDef process;
  process.robot = ParseName("a robot");
  if (Accept("in")) process.choreography = ParseName("a choreography");
  process.span = start.To(PreviousSpan());
  if (failed()) return std::nullopt;
  process.body = ParseBlock("the robot and the choreography of a process");
  if (failed()) return std::nullopt;
  return process;
}

MotionCall ProcessParser::ParseCall(Name robot) {
  MotionCall call{std::move(robot), {}, {}};
  call.motion = ParseName("a motion");
  if (!failed()) call.args = ParseArguments("the name of a motion");
  return call;
}

std::vector<Act> ProcessParser::ParseBlock(std::string_view after) {
  std::vector<Act> acts;
  if (!Expect("{", after)) return acts;
  if (++nesting_ > kDeepestBlock) {
    diagnostics_.Report(diag::Kind::kSyntaxNesting, Peek().span, "blocks are nested too deeply");
    SkipToClose();
  } else {
    acts = ParseActs();
    if (!failed()) Expect("}", "the last step of a process");
  }
  --nesting_;
  return acts;
}

// Up to `}`, which is left.
std::vector<Act> ProcessParser::ParseActs() {
  std::vector<Act> acts;
  while (!At("}") && !AtKind(TokenKind::kEnd) && !failed()) {
    if (Accept(";")) continue;
    Act act;
    act.span = Peek().span;
    if (ParseAct(act)) acts.push_back(std::move(act));
  }
  return acts;
}

bool ProcessParser::ParseAct(Act& act) {
  const auto block = [&](ActKind kind, std::string_view after) {
    act.kind = kind;
    act.span = act.span.To(PreviousSpan());
    act.body = ParseBlock(after);
    return !failed();
  };
  if (Accept("loop")) return block(ActKind::kLoop, "`loop`");
  if (Accept("while")) {
    act.guard = ParseExpr();
    return block(ActKind::kWhile, "the guard of a loop");
  }
  if (Accept("rec")) {
    act.label = ParseName("a recursion");
    return block(ActKind::kRec, "the name of a recursion");
  }
  if (At("if")) {
    ParseIf(act);
    return !failed();
  }
  if (At("send")) {
    ParseSend(act);
  } else if (At("receive")) {
    ParseReceive(act);
  } else if (Accept("continue")) {
    act.kind = ActKind::kContinue;
    act.label = ParseName("a recursion");
  } else if (Accept("exit")) {
    act.kind = ActKind::kExit;
  } else if (AtKind(TokenKind::kName) && Peek(1).text == "=") {
    act.kind = ActKind::kAssign;
    act.variable = ParseName("a variable");
    Take();
    act.guard = ParseExpr();
  } else if (AtKind(TokenKind::kName) && Peek(1).text == "(") {
    act.kind = ActKind::kMotion;
    act.motion = ParseCall({});
  } else {
    Unexpected("`send`, `receive`, a motion `Move()`, `if`, `while`, `loop`, `rec`, `x = value` or `exit`");
  }
  if (act.kind != ActKind::kReceive) act.span = act.span.To(PreviousSpan());
  return !failed();
}

void ProcessParser::ParseSend(Act& act) {
  act.kind = ActKind::kSend;
  Take();
  act.peer = ParseName("the robot that receives");
  if (failed() || !Expect(".", "the receiver; `send arm.grab()`")) return;
  act.label = ParseName("a label");
  if (failed() || !Accept("(")) return;
  while (!At(")") && !failed()) {
    act.values.push_back(ParseExpr());
    if (!Accept(",")) break;
  }
  Expect(")", "the payload");
}

void ProcessParser::ParseReceive(Act& act) {
  act.kind = ActKind::kReceive;
  Take();
  if (Accept("from")) act.peer = ParseName("the robot that sends");
  if (!failed() && Accept("while")) act.motion = ParseCall({});
  act.span = act.span.To(PreviousSpan());
  if (failed() || !Expect("{", "`receive`; its cases stand in braces")) return;
  while (!At("}") && !AtKind(TokenKind::kEnd) && !failed()) {
    ParseCase(act);
    if (!Accept(",")) Accept(";");
  }
  if (!failed()) Expect("}", "the last case");
}

// `done(x) => { ... }`, `arm.done => send cart.go()`
void ProcessParser::ParseCase(Act& act) {
  Case c;
  c.span = Peek().span;
  c.peer = act.peer;
  c.label = ParseName("a label");
  if (Accept(".")) {
    c.peer = std::move(c.label);
    c.label = ParseName("a label");
  }
  if (!failed() && Accept("(")) {
    while (!At(")") && !failed()) {
      c.names.push_back(ParseName("a name for what the message carries"));
      if (!Accept(",")) break;
    }
    Expect(")", "the payload");
  }
  c.span = c.span.To(PreviousSpan());
  if (failed() || !Expect("=>", "a label; `done => { ... }`")) return;
  if (At("{")) {
    c.body = ParseBlock("`=>`");
  } else {
    Act only;
    only.span = Peek().span;
    if (ParseAct(only)) c.body.push_back(std::move(only));
  }
  act.cases.push_back(std::move(c));
}

void ProcessParser::ParseIf(Act& act) {
  act.kind = ActKind::kIf;
  Take();
  act.guard = ParseExpr();
  act.span = act.span.To(PreviousSpan());
  act.body = ParseBlock("the guard of `if`");
  if (failed() || !Accept("else")) return;
  if (!At("if")) {
    act.otherwise = ParseBlock("`else`");
    return;
  }
  if (++nesting_ > kDeepestBlock) {
    Unexpected("fewer alternatives");
    return;
  }
  Act other;
  other.span = Peek().span;
  ParseIf(other);
  act.otherwise.push_back(std::move(other));
  --nesting_;
}

}  // namespace rondo::choreo
