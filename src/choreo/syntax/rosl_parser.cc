#include <fmt/format.h>

#include "choreo/syntax/chor_parser.h"
#include "choreo/syntax/legacy_expr.h"
#include "lang/lexer.h"

namespace rondo::choreo {
namespace {

using diag::Kind;
using lang::TokenKind;

constexpr int kDeepestBlock = 100;

class ProgramParser : public LegacyExprParser {
 public:
  ProgramParser(const lang::TokenStream& stream, Module& module, diag::Diagnostics& diagnostics)
      : LegacyExprParser(stream, module, diagnostics, Dialect::kProgram), module_(module) {}

  void Parse(ProcessDef process) {
    while (!AtKind(TokenKind::kEnd) && !failed()) ParseStatement(process.body);
    if (!failed()) module_.items.emplace_back(std::move(process));
  }

 protected:
  bool IsReserved(std::string_view) const override { return false; }

 private:
  // Blocks are joined with what stands around them; `skip` and `print` do nothing that others could see.
  void ParseStatement(std::vector<Act>& out) {
    if (++nesting_ > kDeepestBlock) {
      diagnostics_.Report(Kind::kSyntaxNesting, Peek().span, "statements are nested too deeply");
      while (!AtKind(TokenKind::kEnd)) Take();
    }
    Act act;
    act.span = Peek().span;
    if (Accept("{")) {
      while (!At("}") && !AtKind(TokenKind::kEnd) && !failed()) ParseStatement(out);
      if (!failed()) Expect("}", "a statement");
    } else if (AtKind(TokenKind::kName) && Peek(1).text == ":") {
      Take();
      Take();
      ParseStatement(out);
    } else if (Accept("skip")) {
      Expect(";", "`skip`");
    } else if (At("print") && Peek(1).text == "(") {
      ParsePrint();
    } else {
      ParseAct(act);
      if (!failed()) out.push_back(std::move(act));
    }
    --nesting_;
  }

  void ParsePrint() {
    Take();
    Take();
    if (AtKind(TokenKind::kString)) {
      Take();
    } else {
      while (!At(")") && !failed()) {
        ParseLegacy();
        if (!Accept(",")) break;
      }
    }
    if (!failed() && Expect(")", "what is printed")) Expect(";", "`print`");
  }

  void ParseAct(Act& act) {
    if (At("if") || At("while")) return ParseGuarded(act);
    if (At("receive")) return ParseReceive(act);
    if (At("send") && Peek(1).text == "(") {
      act.kind = ActKind::kSend;
      Take();
      Take();
      act.peer = ParseName("the robot that receives");
      if (failed() || !Expect(",", "the receiver")) return;
      act.label = ParseName("a label");
      while (!failed() && Accept(",")) act.values.push_back(ParseLegacy());
      if (!failed()) Expect(")", "a message");
    } else if (At("exit") && Peek(1).text == "(") {
      act.kind = ActKind::kExit;
      Take();
      ParseLegacyArguments();
    } else if (AtKind(TokenKind::kName) && Peek(1).text == "=") {
      act.kind = ActKind::kAssign;
      act.variable = ParseName("a variable");
      Take();
      act.guard = ParseLegacy();
    } else {
      act.kind = ActKind::kMotion;
      act.motion = ParseMotion();
    }
    if (failed()) return;
    act.span = act.span.To(PreviousSpan());
    Expect(";", "a statement");
  }

  MotionCall ParseMotion() {
    MotionCall call{{}, ParseName("a statement"), {}};
    if (!failed() && At("(")) {
      for (const ExprId arg : ParseLegacyArguments()) call.args.push_back({{}, arg});
    }
    return call;
  }

  void ParseGuarded(Act& act) {
    act.kind = At("if") ? ActKind::kIf : ActKind::kWhile;
    Take();
    if (!Expect("(", act.kind == ActKind::kIf ? "`if`" : "`while`")) return;
    act.guard = ParseLegacy();
    if (!Expect(")", "a guard")) return;
    act.span = act.span.To(PreviousSpan());
    ParseStatement(act.body);
    if (act.kind == ActKind::kIf && !failed() && Expect("else", "the first alternative"))
      ParseStatement(act.otherwise);
  }

  // receive(peer, motion) { case label(names) => statement ... }
  void ParseReceive(Act& act) {
    act.kind = ActKind::kReceive;
    Take();
    if (!Expect("(", "`receive`")) return;
    act.peer = ParseName("the robot that sends");
    if (failed() || !Expect(",", "the sender")) return;
    act.motion = ParseMotion();
    if (failed() || !Expect(")", "what it does meanwhile")) return;
    act.span = act.span.To(PreviousSpan());
    if (!Expect("{", "`receive(...)`")) return;
    while (!At("}") && !AtKind(TokenKind::kEnd) && !failed()) {
      Case c;
      c.span = Peek().span;
      if (!Expect("case", "`{`")) return;
      c.peer = act.peer;
      c.label = ParseName("a label");
      if (failed() || !Expect("(", "a label")) return;
      while (!At(")") && !failed()) {
        c.names.push_back(ParseName("a name for what the message carries"));
        if (!Accept(",")) break;
      }
      if (failed() || !Expect(")", "the payload")) return;
      c.span = c.span.To(PreviousSpan());
      if (!Expect("=>", "a label")) return;
      ParseStatement(c.body);
      act.cases.push_back(std::move(c));
    }
    if (!failed()) Expect("}", "the cases");
  }

  Module& module_;
  int nesting_ = 0;
};

}  // namespace

void ParseProgram(const diag::SourceSet& sources, diag::FileId file, const std::string& robot, Module& module,
                  diag::Diagnostics& diagnostics) {
  lang::LexerOptions options;
  options.indentation = false;
  const lang::TokenStream stream = lang::Lex(sources, file, options, diagnostics);
  ProcessDef process;
  process.span = {file, 0, 0};
  process.robot = {robot, process.span};
  process.loose_names = true;
  ProgramParser(stream, module, diagnostics).Parse(std::move(process));
}

}  // namespace rondo::choreo
