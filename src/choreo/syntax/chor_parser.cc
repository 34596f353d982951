#include "choreo/syntax/chor_parser.h"

#include <fmt/format.h>

#include "choreo/syntax/legacy_expr.h"
#include "lang/lexer.h"

namespace rondo::choreo {
namespace {

using diag::Kind;
using lang::TokenKind;

class EquationParser : public LegacyExprParser {
 public:
  EquationParser(const lang::TokenStream& stream, Module& module, diag::Diagnostics& diagnostics)
      : LegacyExprParser(stream, module, diagnostics, Dialect::kChoreography), module_(module) {}

  // name = def equations in [initially] first
  void Parse() {
    ChoreographyDef result;
    result.name = ParseName("a choreography");
    result.span = result.name.span;
    if (world() == nullptr) {
      diagnostics_
          .Report(Kind::kChoreoUndeclared, result.name.span, "there is no world for this choreography")
          .Note("a `.chor` file names robots, but says nothing of what they are")
          .Help("give a `.rondo` file with robots and a world before it");
      return;
    }
    result.world = {world()->name.text, result.name.span};
    if (!Expect("=", "the name of a choreography") || !Expect("def", "`=`")) return;
    while (!At("in") && !AtKind(TokenKind::kEnd)) {
      const size_t before = at_;
      Equation equation;
      equation.span = Peek().span;
      ParseEquation(equation);
      if (failed()) {
        Recover(before);
        continue;
      }
      result.equations.push_back(std::move(equation));
    }
    if (!Expect("in", "the equations") || !Expect("[", "`in`")) return;
    result.initially = ParseLegacy();
    if (!Expect("]", "the initial state")) return;
    result.first = ParseName("the state where it begins");
    if (!failed() && !AtKind(TokenKind::kEnd)) Unexpected("the end of the file");
    if (result.equations.empty()) {
      diagnostics_.Report(Kind::kSyntaxUnexpected, result.name.span, "a choreography without equations");
      return;
    }
    if (result.name.text.empty()) return;
    module_.items.emplace_back(std::move(result));
  }

 protected:
  bool IsReserved(std::string_view word) const override {
    return word == "def" || word == "in" || word == "end";
  }

 private:
  // To what looks like the next equation.
  void Recover(size_t before) {
    if (at_ == before) Take();
    while (!AtKind(TokenKind::kEnd) && !At("in")) {
      if (AtKind(TokenKind::kName) && (Peek(1).text == "=" || Peek(1).text == "+")) break;
      Take();
    }
    ClearFailure();
  }

  void ParseEquation(Equation& e) {
    e.from.push_back(ParseName("a state"));
    if (failed()) return;
    if (At("+") || At("||")) {
      const std::string sign(Peek().text);
      e.kind = sign == "+" ? EquationKind::kMerge : EquationKind::kJoin;
      while (!failed() && Accept(sign)) e.from.push_back(ParseName("a state"));
      if (!failed() && Expect("=", "the states")) e.to.push_back(ParseName("a state"));
    } else if (Expect("=", "a state")) {
      ParseRight(e);
    }
    e.span = e.span.To(PreviousSpan());
    e.step.span = e.span;
  }

  void ParseRight(Equation& e) {
    if (Accept("end")) {
      e.kind = EquationKind::kEnd;
    } else if (At("[")) {
      e.kind = EquationKind::kChoice;
      e.step.kind = StmtKind::kChoose;
      do {
        Branch branch;
        branch.span = Peek().span;
        if (!Expect("[", "`+`")) return;
        branch.guard = ParseLegacy();
        if (!Expect("]", "a guard")) return;
        e.to.push_back(ParseName("a state"));
        branch.span = branch.span.To(PreviousSpan());
        e.step.branches.push_back(std::move(branch));
      } while (!failed() && Accept("+"));
    } else if (Accept("(")) {
      ParseMotions(e);
    } else if (AtKind(TokenKind::kName) && Peek(1).text == "->") {
      ParseMessage(e);
    } else if (At("{") || At("@") || AtKind(TokenKind::kName)) {
      e.kind = EquationKind::kFork;
      e.step.kind = StmtKind::kParallel;
      do ParseThread(e);
      while (!failed() && Accept("||"));
    } else {
      Unexpected(
          "a message, a motion `(a: M())`, a choice `[guard] x + ...`, threads `{region} x || ...` or `end`");
    }
  }

  void ParseMotions(Equation& e) {
    e.kind = EquationKind::kMotion;
    e.step.kind = StmtKind::kMotion;
    do {
      MotionCall call{ParseName("a robot"), {}, {}};
      if (failed() || !Expect(":", "a robot")) return;
      call.motion = ParseName("a motion");
      if (failed()) return;
      for (const ExprId arg : ParseLegacyArguments()) call.args.push_back({{}, arg});
      e.step.motions.push_back(std::move(call));
    } while (!failed() && Accept(","));
    if (!failed() && Expect(")", "the motions") && Expect(";", "a joint motion"))
      e.to.push_back(ParseName("a state"));
  }

  void ParseMessage(Equation& e) {
    e.kind = EquationKind::kMessage;
    e.step.kind = StmtKind::kMessage;
    e.step.from = ParseName("a robot");
    Take();
    e.step.to = ParseName("the robot that receives");
    if (failed() || !Expect(":", "the receiver")) return;
    e.step.label = ParseName("a label");
    if (failed()) return;
    for (const ExprId arg : ParseLegacyArguments()) e.step.payload.push_back({{}, {}, arg});
    if (!failed() && Expect(";", "a message")) e.to.push_back(ParseName("a state"));
  }

  Clause Fact(std::string keyword, ExprId value) {
    return {{std::move(keyword), pool_[value].span}, {}, value};
  }

  // { region } x, { px py pz : region } x, @Contract(robots, ..., region) x, or x
  void ParseThread(Equation& e) {
    Branch branch;
    branch.span = Peek().span;
    if (Accept("{")) {
      const bool named = AtKind(TokenKind::kName) && Peek(1).kind == TokenKind::kName &&
                         Peek(2).kind == TokenKind::kName && Peek(3).text == ":";
      if (named) {
        std::string x(Take().text), y(Take().text), z(Take().text);
        Take();
        SetPoint(std::move(x), std::move(y), std::move(z));
      }
      if (!At("}")) branch.facts.push_back(Fact("region", ParseLegacy()));
      if (named) SetPoint("fpx", "fpy", "fpz");
      Expect("}", "a region");
    } else if (Accept("@")) {
      ParseContract(branch);
    }
    if (failed()) return;
    branch.span = branch.span.To(PreviousSpan());
    e.to.push_back(ParseName("a state"));
    e.step.branches.push_back(std::move(branch));
  }

  void ParseContract(Branch& branch) {
    Name name = ParseName("a contract");
    if (failed()) return;
    std::vector<ExprId> args = ParseLegacyArguments();
    if (failed()) return;
    size_t robots = 0;
    while (robots < args.size() && pool_[args[robots]].kind == lang::ExprKind::kName) {
      branch.robots.push_back({pool_[args[robots]].text, pool_[args[robots]].span});
      ++robots;
    }
    const bool guarantees = name.text == "GContract", assumes = name.text == "AContract";
    const size_t facts = guarantees || assumes ? 2 : 1;
    if (robots == 0 || args.size() != robots + facts) {
      diagnostics_.Report(
          Kind::kChoreoArity, name.span,
          fmt::format("`@{}` takes its robots{} and a region", name.text, facts == 2 ? ", a formula" : ""));
      return;
    }
    if (facts == 2) {
      branch.facts.push_back(Fact(guarantees ? "guarantee" : "assume", args[robots]));
    } else {
      branch.contract = std::move(name);
    }
    branch.facts.push_back(Fact("region", args.back()));
  }

  Module& module_;
};

}  // namespace

void ParseEquations(const diag::SourceSet& sources, diag::FileId file, Module& module,
                    diag::Diagnostics& diagnostics) {
  lang::LexerOptions options;
  options.indentation = false;
  options.at = true;
  const lang::TokenStream stream = lang::Lex(sources, file, options, diagnostics);
  module.comments.insert(module.comments.end(), stream.comments.begin(), stream.comments.end());
  EquationParser(stream, module, diagnostics).Parse();
}

}  // namespace rondo::choreo
