#include <fmt/format.h>

#include "koord/syntax/program_parser.h"

namespace rondo::koord {

using diag::Span;
using lang::TokenKind;

// `param`, `assume`, `summary`, `invariant`, `platform` and `explore` are words only where such an item can
// start.
bool Parser::ParseSpecItem() {
  if (!AtKind(TokenKind::kName)) return false;
  const auto& next = Peek(1);
  const bool name_follows = next.kind == TokenKind::kName;
  const Span start = Peek().span;
  if ((At("param") || At("const")) && name_follows) {
    ParseParam(start);
  } else if (At("assume") && (next.kind != TokenKind::kPunctuation || next.text == ":" || next.text == "(" ||
                              next.text == "-")) {
    ParseAssume(start);
  } else if (At("platform") && name_follows) {
    ParsePlatform(start);
  } else if (At("summary") && name_follows) {
    ParseSummary(start);
  } else if ((At("invariant") || At("SafetyProp")) &&
             (name_follows || next.text == ":" || next.text == "(" || next.text == "{")) {
    ParseInvariant(start);
  } else if (At("response") && name_follows && Peek(2).text == ":") {
    ParseResponse(start);
  } else if (At("explore") && next.text == ":" && Peek(2).kind == TokenKind::kNewline &&
             Peek(3).kind == TokenKind::kIndent && Peek(4).text != "pre" && Peek(4).text != "eff") {
    ParseExplore(start);
  } else {
    return false;
  }
  return true;
}

// A specification may go on in deeper lines. Takes the line end if `word` (or anything, if empty) follows
// there.
bool Parser::AcceptContinuation(std::string_view word) {
  if (!AtKind(TokenKind::kNewline)) return false;
  const bool deeper = Peek(1).kind == TokenKind::kIndent && (word.empty() || Peek(2).text == word);
  const bool same =
      continuation_ > 0 && (word.empty() ? Peek(1).kind != TokenKind::kDedent : Peek(1).text == word);
  if (!deeper && !same) return false;
  Take();
  if (deeper) {
    Take();
    ++continuation_;
  }
  return true;
}

ExprId Parser::ParseSpecBody() {
  in_specification_ = true;
  AcceptContinuation("");
  const ExprId body = ParseExpr();
  in_specification_ = false;
  return body;
}

void Parser::EndSpecItem() {
  if (failed()) {
    SkipLine();
  } else if (At(";")) {
    Take();
    if (AtKind(TokenKind::kNewline)) Take();
  } else {
    EndLine("a specification");
  }
  for (; continuation_ > 0; --continuation_) {
    while (!AtKind(TokenKind::kDedent) && !AtKind(TokenKind::kEnd)) SkipLine();
    if (AtKind(TokenKind::kDedent)) Take();
  }
}

// param type name [= value] {; [param] type name [= value]}
// param type name [= value]  |  const type name = value
void Parser::ParseParam(Span start) {
  const bool constant = Take().text == "const";
  std::vector<Decl> decls;
  if (!ParseDecl(decls)) return SkipLine();
  for (const Decl& decl : decls) {
    if (!constant || decl.initial.valid()) continue;
    diagnostics_.Report(diag::Kind::kSyntaxUnexpected, decl.span, "a constant needs a value")
        .Help("write `= value` behind it; a `param` may have any");
  }
  for (Decl& decl : decls) AddItem(ParamDef{decl, decl.span}, start);
  EndSpecItem();
}

// assume initially[:] e  |  assume M[.name] [when e] always|finally e  |  assume [name:] e
void Parser::ParseAssume(Span start) {
  Take();
  AssumeDef def{AssumeKind::kFact, {}, {}, start, {}, {}};
  const auto promises = [&](size_t k) {
    return Peek(k).text == "when" || Peek(k).text == "always" || Peek(k).text == "finally" ||
           Peek(k).kind == TokenKind::kNewline;
  };
  if (At("initially")) {
    Take();
    Accept(":");
    def.kind = AssumeKind::kInitially;
    def.body = ParseSpecBody();
  } else if (AtKind(TokenKind::kName) && (promises(1) || (Peek(1).text == "." && promises(3)))) {
    def.kind = AssumeKind::kPort;
    def.span = Peek().span;
    def.module = ExpectName("the name of a module");
    if (Accept(".")) {
      def.span = def.span.To(Peek().span);
      def.name = ExpectName("the name of the assumption");
    }
    AcceptContinuation("when");
    if (Accept("when")) def.when = ParseSpecBody();
    AcceptContinuation("always");
    AcceptContinuation("finally");
    def.at_end = Accept("finally");
    if (!def.at_end && !Expect("always", "the condition of an assumption")) return EndSpecItem();
    def.body = ParseSpecBody();
  } else {
    if (AtKind(TokenKind::kName) && Peek(1).text == ":") {
      def.span = Peek().span;
      def.name = ExpectName("the name of the assumption");
      Take();
    } else {
      Accept(":");
    }
    def.body = ParseSpecBody();
  }
  AddItem(std::move(def), start);
  EndSpecItem();
}

// platform M = T from "file" every e
void Parser::ParsePlatform(Span start) {
  Take();
  PlatformDef def;
  def.span = Peek().span;
  def.module = ExpectName("the name of a module");
  Expect("=", "the name of a module");
  def.type = ExpectName("a robot type");
  Expect("from", "the robot type");
  def.file_span = Peek().span;
  if (!failed() && AtKind(TokenKind::kString)) {
    const std::string_view quoted = Peek().text;
    if (quoted.size() >= 2) def.file = std::string(quoted.substr(1, quoted.size() - 2));
    Take();
  } else if (!failed()) {
    Unexpected("a file name in quotation marks");
  }
  Expect("every", "the file");
  if (!failed()) def.period = ParseSpecBody();
  if (!failed()) AddItem(std::move(def), start);
  EndSpecItem();
}

// summary f(a, b) -> y: e
void Parser::ParseSummary(Span start) {
  Take();
  SummaryDef def;
  def.span = Peek().span;
  def.function = ExpectName("the name of a function");
  if (Accept(".")) def.function += "." + ExpectName("the name of a port");
  Expect("(", "the name of a function");
  while (!failed() && !At(")")) {
    def.parameter_spans.push_back(Peek().span);
    def.parameters.push_back(ExpectName("the name of a parameter"));
    if (!Accept(",")) break;
  }
  Expect(")", "the parameters");
  Expect("->", "the parameters");
  def.result = ExpectName("the name of the result");
  Expect(":", "the name of the result");
  def.body = ParseSpecBody();
  if (!failed()) AddItem(std::move(def), start);
  EndSpecItem();
}

// invariant [name]: e  |  SafetyProp { e }
void Parser::ParseInvariant(Span start) {
  Take();
  InvariantDef def;
  def.span = start;
  // An invariant may be called `at`.
  const auto at_rounds = [&] { return At("at") && Peek(1).text == "rounds"; };
  if (AtKind(TokenKind::kName) && !at_rounds() &&
      (Peek(1).text == ":" || (Peek(1).text == "at" && Peek(2).text == "rounds"))) {
    def.span = Peek().span;
    def.name = ExpectName("the name of the invariant");
  }
  def.at_rounds = at_rounds();
  if (def.at_rounds) {
    Take();
    Take();
  }
  if (Accept("{")) {
    def.body = ParseExpr();
    Expect("}", "the property");
  } else {
    Expect(":", "`invariant`");
    def.body = ParseSpecBody();
  }
  AddItem(std::move(def), start);
  EndSpecItem();
}

// response name: e within n rounds e
void Parser::ParseResponse(Span start) {
  Take();
  ResponseDef def;
  def.span = Peek().span;
  def.name = ExpectName("the name of the response");
  Expect(":", "the name of the response");
  if (!failed()) def.when = ParseSpecBody();
  AcceptContinuation("within");
  Expect("within", "the condition of a response");
  constexpr size_t kMostDigits = 3;
  constexpr uint32_t kMostRounds = 200;
  const lang::Token number = Peek();
  if (!failed() && AtKind(TokenKind::kInt) && number.text.size() <= kMostDigits) {
    Take();
    def.rounds = static_cast<uint32_t>(std::stoul(std::string(number.text)));
  }
  if (!failed() && (def.rounds < 1 || def.rounds > kMostRounds))
    Unexpected(fmt::format("a number of rounds from 1 to {}", kMostRounds));
  Expect("rounds", "the number");
  if (!failed()) def.then = ParseSpecBody();
  if (!failed()) AddItem(std::move(def), start);
  EndSpecItem();
}

// explore: {name = e | name in e | f(a, b) = e}
void Parser::ParseExplore(Span start) {
  ExploreDef def{start, {}};
  Take();
  Take();
  Take();
  Take();
  while (!AtKind(TokenKind::kDedent) && !AtKind(TokenKind::kEnd)) {
    if (!ParseExploreEntry(def)) SkipLine();
  }
  if (AtKind(TokenKind::kDedent)) Take();
  AddItem(std::move(def), start);
}

bool Parser::ParseExploreEntry(ExploreDef& def) {
  ExploreEntry entry{ExploreKind::kValue, {}, Peek().span, {}, {}, {}};
  entry.name = ExpectName("what is fixed");
  if (!failed() && Accept(".")) {
    entry.span = entry.span.To(Peek().span);
    entry.name += "." + ExpectName("the name of a port");
  }
  if (!failed() && Accept("(")) {
    entry.kind = ExploreKind::kFunction;
    while (!failed() && !At(")")) {
      entry.parameter_spans.push_back(Peek().span);
      entry.parameters.push_back(ExpectName("the name of a parameter"));
      if (!Accept(",")) break;
    }
    Expect(")", "the parameters");
  }
  if (!failed() && entry.kind == ExploreKind::kValue && Accept("in"))
    entry.kind = ExploreKind::kChoice;
  else if (!failed())
    Expect("=", "what is fixed");
  if (failed()) return false;
  entry.body = ParseSpecBody();
  if (failed()) return false;
  def.entries.push_back(std::move(entry));
  const bool good = EndLine("a value");
  for (; continuation_ > 0; --continuation_) {
    while (!AtKind(TokenKind::kDedent) && !AtKind(TokenKind::kEnd)) SkipLine();
    if (AtKind(TokenKind::kDedent)) Take();
  }
  return good || !AtKind(TokenKind::kEnd);
}

}  // namespace rondo::koord
