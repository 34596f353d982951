#include <fmt/format.h>

#include <array>

#include "koord/syntax/foreign.h"
#include "koord/syntax/program_parser.h"
#include "lang/suggest.h"

namespace rondo::koord {

using diag::Kind;
using lang::TokenKind;

bool Parser::AtCompound() const { return At("if") || At("for") || At("atomic") || AtWhile(); }

// A variable may be called `while`.
bool Parser::AtWhile() const {
  if (!At("while")) return false;
  const lang::Token& next = Peek(1);
  return next.kind == TokenKind::kName || next.kind == TokenKind::kInt || next.kind == TokenKind::kFloat ||
         next.text == "(" || next.text == "!" ||
         (next.text == "-" && Peek(2).text != "-" && Peek(2).text != "=");
}

// while condition within most: body
void Parser::ParseWhile(std::vector<Stmt>& out) {
  Stmt stmt;
  stmt.kind = StmtKind::kWhile;
  stmt.span = Take().span;
  stmt.value = ParseExpr();
  if (!failed() && !Accept("within")) {
    Unexpected("`within`")
        .Under("after a condition")
        .Help("say how often it is repeated at most: `while ... within 8:`");
  } else {
    stmt.operands.push_back(ParseExpr());
  }
  stmt.span = stmt.span.To(PreviousSpan());
  if (failed()) return SkipLine();
  stmt.body = ParseSuite("the head of a loop");
  out.push_back(std::move(stmt));
}

// [:] then a block, or statements on the same line that a block may continue, or one compound statement
std::vector<Stmt> Parser::ParseSuite(std::string_view after) {
  std::vector<Stmt> body;
  const bool colon = Accept(":");
  if (AtKind(TokenKind::kNewline)) {
    Take();
    if (AtKind(TokenKind::kIndent)) return ParseBlock();
    Unexpected("a statement").Under("nothing is indented after " + std::string(after));
    ClearFailure();
    return body;
  }
  if (!colon && !AtKind(TokenKind::kNewline) && !AtCompound() && after != "`eff`") {
    Unexpected("`:`").Under("after " + std::string(after));
    SkipLine();
    return body;
  }
  if (AtCompound()) {
    ParseStatement(body);
    return body;
  }
  do {
    if (AtKind(TokenKind::kNewline)) break;
    if (!ParseSimple(body)) {
      SkipLine();
      return body;
    }
  } while (Accept(";"));
  if (failed() || (!AtKind(TokenKind::kNewline) && !AtKind(TokenKind::kEnd))) {
    EndLine("a statement");
    return body;
  }
  if (AtKind(TokenKind::kNewline)) Take();
  if (AtKind(TokenKind::kIndent)) {
    // The paper's Fig. 11: `eff: a = b` goes on in deeper lines.
    std::vector<Stmt> rest = ParseBlock();
    for (Stmt& stmt : rest) body.push_back(std::move(stmt));
  }
  return body;
}

std::vector<Stmt> Parser::ParseBlock() {
  std::vector<Stmt> body;
  Take();
  while (!AtKind(TokenKind::kDedent) && !AtKind(TokenKind::kEnd)) {
    ClearFailure();
    const size_t before = at_;
    if (AtKind(TokenKind::kNewline)) {
      Take();
      continue;
    }
    if (AtKind(TokenKind::kIndent)) {
      diagnostics_.Report(Kind::kSyntaxIndentation, Peek().span, "this line is indented without a reason")
          .Under("the line above opens no block");
      SkipBlock();
      continue;
    }
    ParseStatement(body);
    if (at_ == before) SkipLine();
  }
  if (AtKind(TokenKind::kDedent)) Take();
  return body;
}

void Parser::ParseStatement(std::vector<Stmt>& out) {
  static constexpr int kDeepestBlock = 60;
  if (nesting_ >= kDeepestBlock) {
    diagnostics_.Report(Kind::kSyntaxNesting, Peek().span, "statements are nested too deeply");
    SkipLine();
    return;
  }
  ++nesting_;
  if (At("if")) {
    ParseIf(out, false);
  } else if (At("for")) {
    ParseFor(out);
  } else if (AtWhile()) {
    ParseWhile(out);
  } else if (At("atomic")) {
    Stmt stmt;
    stmt.kind = StmtKind::kAtomic;
    stmt.span = Take().span;
    stmt.body = ParseSuite("`atomic`");
    out.push_back(std::move(stmt));
  } else {
    bool good = true;
    do {
      if (AtKind(TokenKind::kNewline)) break;
      good = ParseSimple(out);
    } while (good && Accept(";"));
    if (good)
      EndLine("a statement");
    else
      SkipLine();
  }
  --nesting_;
}

void Parser::ParseIf(std::vector<Stmt>& out, bool elif) {
  Stmt stmt;
  stmt.kind = StmtKind::kIf;
  stmt.elif = elif;
  stmt.span = Take().span;
  stmt.value = ParseExpr();
  stmt.span = stmt.span.To(PreviousSpan());
  if (failed()) {
    SkipLine();
  } else {
    stmt.body = ParseSuite("the condition");
  }
  if (At("elif")) {
    stmt.has_else = true;
    if (++nesting_ < 60) {
      ParseIf(stmt.orelse, true);
    } else {
      diagnostics_.Report(Kind::kSyntaxNesting, Peek().span, "too many branches");
      SkipLine();
    }
    --nesting_;
  } else if (At("else")) {
    Take();
    stmt.has_else = true;
    stmt.orelse = ParseSuite("`else`");
  }
  out.push_back(std::move(stmt));
}

// `for i in range(n)` and `for i in range(a, b)` are `for i = 0, n` and `for i = a, b`.
void Parser::AsRange(Stmt& stmt) {
  const lang::Expr call = pool_[stmt.value];
  if (call.kind != lang::ExprKind::kCall) return;
  const lang::Expr& callee = pool_[call.args[0]];
  if (callee.kind != lang::ExprKind::kName || callee.text != "range") return;
  if (call.args.size() < 2 || call.args.size() > 3) {
    diagnostics_.Report(Kind::kKoordArity, call.span, "`range` takes 1 or 2 arguments")
        .Under(fmt::format("{} given", call.args.size() - 1))
        .Help("`range(n)` are the numbers from 0 to n - 1, `range(a, b)` those from a to b - 1");
    stmt.value = Fail(call.span);
    return;
  }
  stmt.kind = StmtKind::kForRange;
  const bool one = call.args.size() == 2;
  stmt.value = one ? pool_.Add({lang::ExprKind::kInt, callee.span, "0", {}, {}}) : call.args[1];
  stmt.operands.push_back(call.args.back());
}

// for x, y in list: body  |  for i = a, b: body
void Parser::ParseFor(std::vector<Stmt>& out) {
  Stmt stmt;
  stmt.span = Take().span;
  do {
    stmt.name_spans.push_back(Peek().span);
    stmt.names.push_back(ExpectName("the name of a variable"));
  } while (!failed() && Accept(","));
  if (At("=") && stmt.names.size() == 1) {
    Take();
    stmt.kind = StmtKind::kForRange;
    stmt.value = ParseExpr();
    Expect(",", "the first value of a loop");
    stmt.operands.push_back(ParseExpr());
  } else {
    stmt.kind = StmtKind::kForIn;
    if (Expect("in", "the variable of a loop"))
      stmt.value = ParseExpr();
    else
      stmt.value = Fail(stmt.span);
    if (stmt.names.size() == 1) AsRange(stmt);
  }
  stmt.span = stmt.span.To(PreviousSpan());
  if (failed()) return SkipLine();
  stmt.body = ParseSuite("the head of a loop");
  out.push_back(std::move(stmt));
}

// A type and a name: `int k = 0`, `List<pos> way = []`, `float[3] a = ...`.
bool Parser::AtLocal() const {
  if (Peek(1).kind == TokenKind::kName) return !IsReserved(Peek(1).text);
  if (Peek(1).text != "<" && Peek(1).text != "[") return false;
  const std::string_view close = Peek(1).text == "<" ? ">" : "]";
  // To the bracket that closes, and a name behind it.
  int open = 0;
  for (size_t k = 1; Peek(k).kind != TokenKind::kNewline && Peek(k).kind != TokenKind::kEnd; ++k) {
    if (Peek(k).text == Peek(1).text) ++open;
    if (Peek(k).text != close || --open > 0) continue;
    if (Peek(k + 1).text == "[" && close == "]") continue;
    return Peek(k + 1).kind == TokenKind::kName && !IsReserved(Peek(k + 1).text) && Peek(k + 2).text == "=";
  }
  return false;
}

bool Parser::ParseSimple(std::vector<Stmt>& out) {
  Stmt stmt;
  stmt.span = Peek().span;
  const auto finish = [&](StmtKind kind) {
    stmt.kind = kind;
    stmt.span = stmt.span.To(PreviousSpan());
    out.push_back(std::move(stmt));
    return !failed();
  };
  for (const StmtKind kind : {StmtKind::kStop, StmtKind::kBreak, StmtKind::kContinue}) {
    if (Accept(WordsOf(kind).word)) return finish(kind);
  }
  if (At("pass") &&
      (Peek(1).kind == TokenKind::kNewline || Peek(1).text == ";" || Peek(1).kind == TokenKind::kEnd) &&
      Accept("pass"))
    return finish(StmtKind::kPass);
  if (At("exit") && Peek(1).kind == TokenKind::kNewline && Accept("exit")) return finish(StmtKind::kStop);
  if (Accept("return")) {
    if (!AtKind(TokenKind::kNewline) && !AtKind(TokenKind::kEnd) && !At(";")) stmt.value = ParseExpr();
    return finish(StmtKind::kReturn);
  }
  if (IsForeign()) return false;
  // The left side is a postfix expression; `=` after it is an assignment, not the papers' equality.
  if (!AtKind(TokenKind::kName) || (IsReserved(Peek().text))) {
    Unexpected("a statement");
    return false;
  }
  if (AtLocal()) {
    stmt.type = ParseType();
    stmt.name_spans.push_back(Peek().span);
    stmt.names.push_back(ExpectName("the name of a variable"));
    if (!failed() && !Accept("=")) {
      static const std::vector<std::string> kWords = {"return", "stop", "break", "continue", "pass"};
      auto& report = Unexpected("`=`").Under("a local variable begins with a value");
      const std::string near = lang::Suggest(stmt.type.name, kWords);
      if (!near.empty()) report.Help("did you mean `" + near + "`?");
    }
    stmt.value = failed() ? Fail(stmt.span) : ParseExpr();
    return finish(StmtKind::kLocal);
  }
  stmt.target = ParsePostfix();
  if (failed()) return false;
  if (Accept("=")) {
    stmt.value = ParseExpr();
    return finish(StmtKind::kAssign);
  }
  if (Accept("+=")) {
    stmt.value = ParseExpr();
    return finish(StmtKind::kAddAssign);
  }
  if (Accept("++")) return finish(StmtKind::kIncrement);
  for (const std::string_view sign : {"-", "*", "/"}) {
    if (!At(sign)) continue;
    const bool twice = sign == "-" && Peek(1).text == "-";
    if (!twice && Peek(1).text != "=") break;
    stmt.update = sign;
    Take();
    const diag::Span second = Take().span;
    const ExprId operand = twice ? pool_.Add({lang::ExprKind::kInt, second, "1", {}, {}}) : ParseExpr();
    const diag::Span span = pool_[stmt.target].span.To(pool_[operand].span);
    stmt.value = pool_.Add({lang::ExprKind::kBinary, span, stmt.update, {stmt.target, operand}, {}});
    return finish(StmtKind::kAssign);
  }
  if (At("<<")) {
    while (Accept("<<")) stmt.operands.push_back(ParseExpr());
    return finish(StmtKind::kStream);
  }
  if (pool_[stmt.target].kind == lang::ExprKind::kCall) {
    stmt.value = stmt.target;
    stmt.target = {};
    return finish(StmtKind::kCall);
  }
  NoAssignment();
  return false;
}

// A word that begins a statement elsewhere, and is no variable here: says what to write instead.
bool Parser::IsForeign() {
  const std::string_view instead = AlternativeFor(Peek().text, WordPlace::kStatement);
  const lang::Token& next = Peek(1);
  const bool statement =
      next.kind != TokenKind::kPunctuation || next.text == ":" || next.text == "(" || next.text == "!";
  if (instead.empty() || !statement) return false;
  Unexpected("a statement").Help(std::string(instead));
  return true;
}

// A value stands where a statement should be.
void Parser::NoAssignment() {
  struct Sign {
    std::string_view first, second, instead;
  };
  static constexpr std::array<Sign, 7> kSigns = {{{"==", "", "assign with `=`"},
                                                  {":", "=", "assign with `=`"},
                                                  {"<-", "", "assign with `=`"},
                                                  {"&&", "=", "write `x = x and ...`"},
                                                  {"||", "=", "write `x = x or ...`"},
                                                  {"%", "=", "write `x = x % ...`"},
                                                  {"!", "", "write `x = not x`"}}};
  std::string_view instead;
  for (const Sign& sign : kSigns) {
    if (At(sign.first) && (sign.second.empty() || Peek(1).text == sign.second)) instead = sign.instead;
  }
  auto& report = Unexpected("`=`").Under("a value alone does nothing");
  if (!instead.empty() && report.helps.empty()) report.Help(std::string(instead));
}

}  // namespace rondo::koord
