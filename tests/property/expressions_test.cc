// Printing an expression and reading it again gives the same expression, for generated trees of every shape.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "koord/syntax/format.h"
#include "koord/syntax/parser.h"
#include "lang/expr_printer.h"

namespace rondo::koord {
namespace {

using lang::ExprKind;

// A tree of limited depth, built from a stream of choices.
ExprId Grow(lang::ExprPool& pool, int depth) {
  const auto pick = [](int n) { return *rc::gen::inRange(0, n); };
  const auto leaf = [&]() -> ExprId {
    switch (pick(5)) {
      case 0:
        return pool.Add({ExprKind::kInt, {}, std::to_string(pick(100)), {}, {}});
      case 1:
        return pool.Add({ExprKind::kFloat, {}, "1.5", {}, {}});
      case 2:
        return pool.Add({ExprKind::kBool, {}, pick(2) == 0 ? "true" : "false", {}, {}});
      case 3:
        return pool.Add({ExprKind::kPid, {}, {}, {}, {}});
      default:
        return pool.Add({ExprKind::kName, {}, std::string(1, static_cast<char>('a' + pick(5))), {}, {}});
    }
  };
  if (depth == 0) return leaf();
  static const char* const kOperators[] = {"implies", "or", "and", "==", "<", ">=", "in",
                                           "not in",  "+",  "-",   "*",  "/", "%"};
  switch (pick(8)) {
    case 0:
      return pool.Add({ExprKind::kUnary, {}, pick(2) == 0 ? "-" : "not", {Grow(pool, depth - 1)}, {}});
    case 1:
      return pool.Add({ExprKind::kField, {}, "f", {Grow(pool, depth - 1)}, {}});
    case 2:
      return pool.Add({ExprKind::kIndex, {}, {}, {Grow(pool, depth - 1), Grow(pool, depth - 1)}, {}});
    case 3:
      return pool.Add({ExprKind::kCall, {}, {}, {Grow(pool, 0), Grow(pool, depth - 1)}, {}});
    case 4:
      return pool.Add({ExprKind::kList, {}, {}, {Grow(pool, depth - 1), Grow(pool, depth - 1)}, {}});
    case 5: {
      lang::Expr e{ExprKind::kQuantifier, {}, "forall", {Grow(pool, depth - 1)}, {}};
      e.binders.push_back({{"i"}, {{}}, {}, pool.Add({ExprKind::kName, {}, "ID", {}, {}})});
      return pool.Add(std::move(e));
    }
    default:
      return pool.Add(
          {ExprKind::kBinary, {}, kOperators[pick(13)], {Grow(pool, depth - 1), Grow(pool, depth - 1)}, {}});
  }
}

// The tree with all its brackets.
std::string Shape(const lang::ExprPool& pool, ExprId id) {
  const lang::Expr& e = pool[id];
  std::string text = "(" + std::to_string(static_cast<int>(e.kind)) + e.text;
  for (const ExprId arg : e.args) text += Shape(pool, arg);
  return text + ")";
}

TEST(Expressions, SurvivePrintingAndReading) {
  EXPECT_TRUE(rc::check("parse(print(e)) == e", [] {
    lang::ExprPool pool;
    const ExprId e = Grow(pool, 4);
    diag::SourceSet sources;
    diag::Diagnostics diagnostics;
    Program program;
    Parse(sources, sources.Add("generated", "invariant: " + lang::PrintExpr(pool, e) + "\n"), program,
          diagnostics);
    RC_ASSERT(!diagnostics.has_errors());
    RC_ASSERT(program.items.size() == 1u);
    RC_ASSERT(Shape(program.exprs, std::get<InvariantDef>(program.items[0]).body) == Shape(pool, e));
  }));
}

}  // namespace
}  // namespace rondo::koord
