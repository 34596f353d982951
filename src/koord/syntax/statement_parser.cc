#include "koord/syntax/program_parser.h"

namespace rondo::koord {

using diag::Kind;
using lang::TokenKind;

bool Parser::AtCompound() const { return At("if") || At("for") || At("atomic"); }

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
  }
  stmt.span = stmt.span.To(PreviousSpan());
  if (failed()) return SkipLine();
  stmt.body = ParseSuite("the head of a loop");
  out.push_back(std::move(stmt));
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
  if (At("exit") && Peek(1).kind == TokenKind::kNewline && Accept("exit")) return finish(StmtKind::kStop);
  if (Accept("return")) {
    if (!AtKind(TokenKind::kNewline) && !AtKind(TokenKind::kEnd) && !At(";")) stmt.value = ParseExpr();
    return finish(StmtKind::kReturn);
  }
  // The left side is a postfix expression; `=` after it is an assignment, not the papers' equality.
  if (!AtKind(TokenKind::kName) || (IsReserved(Peek().text))) {
    Unexpected("a statement");
    return false;
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
  if (At("<<")) {
    while (Accept("<<")) stmt.operands.push_back(ParseExpr());
    return finish(StmtKind::kStream);
  }
  if (pool_[stmt.target].kind == lang::ExprKind::kCall) {
    stmt.value = stmt.target;
    stmt.target = {};
    return finish(StmtKind::kCall);
  }
  Unexpected("`=`").Under("a value alone does nothing");
  return false;
}

}  // namespace rondo::koord
