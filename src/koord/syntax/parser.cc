#include "koord/syntax/parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "koord/syntax/foreign.h"
#include "koord/syntax/program_parser.h"
#include "lang/lexer.h"
#include "lang/suggest.h"

namespace rondo::koord {

using diag::Kind;
using diag::Span;
using lang::TokenKind;

namespace {

// Besides those that statements begin with.
constexpr std::string_view kWords[] = {"using",  "def",     "actuators", "sensors", "allread", "allwrite",
                                       "local",  "init",    "pre",       "eff",     "elif",    "else",
                                       "in",     "and",     "or",        "not",     "pid",     "forall",
                                       "exists", "implies", "true",      "false",   "True",    "False"};
// Words only where a line begins with them, or a quantifier.
constexpr std::string_view kPlaceWords[] = {"invariant", "assume",   "initially", "always",   "response",
                                            "summary",   "platform", "explore",   "fallback", "param",
                                            "module",    "urgent",   "count"};

}  // namespace

bool IsReservedWord(std::string_view word) {
  const auto begins = [&](const StmtWords& statement) { return statement.word == word; };
  return std::ranges::find(kWords, word) != std::end(kWords) ||
         (!word.empty() && std::ranges::any_of(kStmtWords, begins));
}

std::vector<std::string> Parser::Words() const {
  std::vector<std::string> words(std::begin(kWords), std::end(kWords));
  words.insert(words.end(), std::begin(kPlaceWords), std::end(kPlaceWords));
  for (const StmtWords& statement : kStmtWords) {
    if (!statement.word.empty()) words.emplace_back(statement.word);
  }
  return words;
}

void Parse(const diag::SourceSet& sources, diag::FileId file, Program& program,
           diag::Diagnostics& diagnostics) {
  const lang::TokenStream stream = lang::Lex(sources, file, {.doubles = true}, diagnostics);
  program.comments.insert(program.comments.end(), stream.comments.begin(), stream.comments.end());
  Parser(stream, program, diagnostics).ParseProgram();
}

void Parser::ParseProgram() {
  while (!AtKind(TokenKind::kEnd)) {
    ClearFailure();
    const size_t before = at_;
    if (AtKind(TokenKind::kNewline) || AtKind(TokenKind::kDedent)) {
      Take();
      continue;
    }
    if (AtKind(TokenKind::kIndent)) {
      diagnostics_.Report(Kind::kSyntaxIndentation, Peek().span, "this line is indented without a reason")
          .Under("nothing above it opens a block");
      SkipBlock();
      continue;
    }
    if (Accept(";")) continue;
    ParseItem();
    if (at_ == before) SkipLine();
  }
}

void Parser::AddItem(Item item, Span start) {
  program_.items.push_back(std::move(item));
  program_.item_spans.push_back(start.To(PreviousSpan()));
}

void Parser::SkipBlock() {
  if (!AtKind(TokenKind::kIndent)) return;
  int depth = 0;
  do {
    if (AtKind(TokenKind::kIndent)) ++depth;
    if (AtKind(TokenKind::kDedent)) --depth;
    if (AtKind(TokenKind::kEnd)) return;
    Take();
  } while (depth > 0);
}

void Parser::SkipLine() {
  while (!AtKind(TokenKind::kNewline) && !AtKind(TokenKind::kEnd) && !AtKind(TokenKind::kDedent) &&
         !AtKind(TokenKind::kIndent)) {
    Take();
  }
  if (AtKind(TokenKind::kNewline)) Take();
  SkipBlock();
  ClearFailure();
}

bool Parser::EndLine(std::string_view after) {
  if (!failed() && (AtKind(TokenKind::kNewline) || AtKind(TokenKind::kEnd))) {
    if (AtKind(TokenKind::kNewline)) Take();
    if (AtKind(TokenKind::kIndent)) {
      diagnostics_.Report(Kind::kSyntaxIndentation, Peek().span, "this line is indented without a reason")
          .Under("the line above opens no block");
      SkipBlock();
    }
    return true;
  }
  Unexpected("the end of the line").Under("after " + std::string(after));
  SkipLine();
  return false;
}

void Parser::ParseItem() {
  const Span start = Peek().span;
  if (At("def")) return ParseDef();
  if (At("using")) return ParseModule();
  if (At("allread")) return ParseSection(SectionKind::kAllread);
  if (At("allwrite")) return ParseSection(SectionKind::kAllwrite);
  if (At("local")) return ParseSection(SectionKind::kLocal);
  if (At("init")) return ParseInit();
  if (At("agent") && Peek(1).kind == TokenKind::kName) {
    Take();
    const Span span = Peek().span;
    std::string name = ExpectName("the name of the program");
    Accept(":");
    if (EndLine("the name of the program")) AddItem(AgentHeader{std::move(name), span}, start);
    return;
  }
  // An event may be called `fallback`.
  if (At("fallback") && Peek(1).kind == TokenKind::kName) return ParseFallback();
  if (ParseSpecItem()) return;
  if (const std::string_view instead = AlternativeFor(Peek().text, WordPlace::kItem);
      !instead.empty() && Peek(1).text != ":" && Peek(1).text != "(") {
    Unexpected("a section, an event or a specification").Help(std::string(instead));
    return SkipLine();
  }
  if (AtKind(TokenKind::kName) && !IsReserved(Peek().text)) return ParseEvent();
  Unexpected("a section, an event or a specification");
  SkipLine();
}

// def [fun] f(params) [-> type]: body  |  def [adt|type] Name: fields  |  def Name {a, b}
void Parser::ParseDef() {
  const Span start = Take().span;
  bool adt = false;
  if ((At("fun") || At("adt") || At("type")) && Peek(1).kind == TokenKind::kName) adt = Take().text != "fun";
  const Span span = Peek().span;
  std::string name = ExpectName("the name of a function or type");
  if (At("(") && !adt) return ParseFunction(std::move(name), span);
  if (At("{")) return ParseEnum(std::move(name), span);
  AdtDef def{std::move(name), span, {}};
  if (!Expect(":", "the name of a type")) return SkipLine();
  ParseDeclGroup(def.fields);
  AddItem(std::move(def), start);
}

void Parser::ParseFunction(std::string name, Span span) {
  const Span start = span;
  FunctionDef def{std::move(name), span, {}, {}, {}, true};
  Take();
  while (!At(")") && !failed()) {
    Decl parameter;
    parameter.type = ParseType();
    parameter.span = Peek().span;
    parameter.name = ExpectName("the name of a parameter");
    ParseDimensions(parameter.dimensions);
    def.parameters.push_back(std::move(parameter));
    Accept(",");
  }
  Expect(")", "the parameters");
  if (Accept("->")) def.result = ParseType();
  if (!failed() && (AtKind(TokenKind::kNewline) || AtKind(TokenKind::kEnd)) &&
      Peek(1).kind != TokenKind::kIndent) {
    // Only a signature: an external function.
    def.has_body = false;
    EndLine("the signature");
  } else {
    def.body = ParseSuite("the signature of a function");
  }
  AddItem(std::move(def), start);
}

void Parser::ParseEnum(std::string name, Span span) {
  EnumDef def{std::move(name), span, {}, {}};
  Take();
  do {
    def.member_spans.push_back(Peek().span);
    def.members.push_back(ExpectName("a member"));
  } while (!failed() && Accept(","));
  Expect("}", "the members");
  if (EndLine("the members")) AddItem(std::move(def), span);
}

void Parser::ParseModule() {
  const Span start = Take().span;
  if (At("module") && Peek(1).kind == TokenKind::kName) Take();
  const Span span = Peek().span;
  ModuleDef module{ExpectName("the name of a module"), span, {}};
  Accept(":");
  bool block = false;
  if (!failed() && AtKind(TokenKind::kNewline)) {
    Take();
    block = AtKind(TokenKind::kIndent);
    if (block) Take();
  }
  while (!failed() && ParsePortGroup(module)) {
    if (!block && !At("sensors") && !At("actuators") && !At("sensor") && !At("actuator")) break;
  }
  if (failed()) SkipLine();
  if (block) {
    while (!AtKind(TokenKind::kDedent) && !AtKind(TokenKind::kEnd)) SkipLine();
    if (AtKind(TokenKind::kDedent)) Take();
  }
  AddItem(std::move(module), start);
}

bool Parser::ParsePortGroup(ModuleDef& module) {
  const Span span = Peek().span;
  PortGroup group{At("sensors") || At("sensor"), span, {}};
  if (!group.sensors && !At("actuators") && !At("actuator")) {
    if (!AtKind(TokenKind::kDedent) && !AtKind(TokenKind::kEnd)) Unexpected("`sensors` or `actuators`");
    return false;
  }
  Take();
  Accept(":");
  ParseDeclGroup(group.ports);
  module.groups.push_back(std::move(group));
  return true;
}

void Parser::ParseSection(SectionKind kind) {
  const Span start = Take().span;
  Accept(":");
  Section section{kind, start, {}};
  ParseDeclGroup(section.decls);
  AddItem(std::move(section), start);
}

void Parser::ParseInit() {
  const Span start = Take().span;
  InitDef init{start, ParseSuite("`init`")};
  AddItem(std::move(init), start);
}

void Parser::ParseEvent() {
  const Span start = Peek().span;
  EventDef event;
  event.span = start;
  event.name = std::string(Take().text);
  if (Accept("(") && !Expect(")", "the name of an event")) return SkipLine();
  if (!Accept(":")) {
    // Recover inside when this can only have been an event.
    Unexpected("`:`").Under("after the name of an event");
    return SkipLine();
  }
  if (AtKind(TokenKind::kNewline)) Take();
  const bool block = AtKind(TokenKind::kIndent);
  if (block) Take();
  const bool good = ParseEventBody(event);
  if (block) {
    if (good && !AtKind(TokenKind::kDedent) && !AtKind(TokenKind::kEnd)) {
      Unexpected("the end of the event");
    }
    while (!AtKind(TokenKind::kDedent) && !AtKind(TokenKind::kEnd)) SkipLine();
    if (AtKind(TokenKind::kDedent)) Take();
  }
  AddItem(std::move(event), start);
}

// fallback M: suite
void Parser::ParseFallback() {
  const Span start = Take().span;
  FallbackDef def;
  def.span = def.code.span = Peek().span;
  def.module = ExpectName("the name of a module");
  def.code.name = "fallback " + def.module;
  def.code.body = ParseSuite("the head of a fallback");
  AddItem(std::move(def), start);
}

// [pre [urgent] [:] expr] eff suite
bool Parser::ParseEventBody(EventDef& event) {
  bool good = true;
  if (Accept("pre")) {
    event.urgent = Accept("urgent");
    Accept(":");
    event.pre = ParseExpr();
    good = EndLine("a precondition");
  }
  if (!Accept("eff")) {
    auto& report = Unexpected(event.pre.valid() ? "`eff`" : "`pre` or `eff`").Under("in an event");
    // It looks like an event, and was perhaps meant to be something else.
    const std::string near =
        report.helps.empty() ? lang::Suggest(event.name, {"allread", "allwrite", "local", "init", "explore"})
                             : "";
    if (!near.empty())
      report.Help(fmt::format("`{}` is an event here; did you mean `{}`?", event.name, near));
    SkipLine();
    return false;
  }
  event.body = ParseSuite("`eff`");
  return good;
}

}  // namespace rondo::koord
