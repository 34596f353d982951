#include <fmt/format.h>

#include "lang/lexer.h"
#include "robot/dynamics/motion_problem.h"
#include "robot/syntax/parser.h"

namespace rondo::robot {

namespace {

class QuantityParser : public Parser {
 public:
  using Parser::Parser;

  ExprId Run() {
    const ExprId expr = ParseExpr();
    if (!failed() && !AtKind(lang::TokenKind::kEnd)) Unexpected("the end");
    return expr;
  }

 protected:
  bool IsReserved(std::string_view word) const override { return IsRobotWord(word); }
};

}  // namespace

std::optional<Value> QuantityOf(const std::string& text, const MotionProblem& problem, Arena& arena,
                                diag::SourceSet& sources, diag::Diagnostics& diagnostics) {
  lang::LexerOptions options;
  options.indentation = false;
  const lang::TokenStream tokens = lang::Lex(sources, sources.Add(text, text), options, diagnostics);
  lang::ExprPool pool;
  const ExprId expr = QuantityParser(tokens, pool, diagnostics).Run();
  if (diagnostics.has_errors()) return std::nullopt;
  Evaluator evaluator(arena, pool, diagnostics);
  const Value value = evaluator.Evaluate(expr, problem.scope);
  if (diagnostics.has_errors() || value.kind == ValueKind::kError) return std::nullopt;
  if (value.kind != ValueKind::kQuantity) {
    evaluator.WrongType(pool[expr].span, value, "a quantity");
    return std::nullopt;
  }
  return value;
}

}  // namespace rondo::robot
