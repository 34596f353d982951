#include "lang/expr_parser.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "lang/expr_json.h"
#include "lang/expr_printer.h"
#include "lang/lexer.h"

namespace rondo::lang {
namespace {

/// A language of expressions only, in which `if` is a word and `m` and `s` are units.
class Language final : public ExprParser {
 public:
  using ExprParser::ExprParser;
  bool AtEnd() const { return AtKind(TokenKind::kEnd); }

 protected:
  bool IsReserved(std::string_view word) const override { return word == "if"; }
  bool IsUnit(std::string_view word) const override { return word == "m" || word == "s"; }
};

/// An expression that was read.
struct Read {
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  ExprPool pool;
  ExprId expr;
  bool whole = false;

  explicit Read(const std::string& text) {
    LexerOptions options;
    options.indentation = false;
    const TokenStream stream = Lex(sources, sources.Add("text", text), options, diagnostics);
    Language language(stream, pool, diagnostics);
    expr = language.ParseExpr();
    whole = language.AtEnd();
  }
  const Expr& root() const { return pool[expr]; }
  bool good() const { return whole && !diagnostics.has_errors(); }
  std::string Tree() const { return Tree(expr); }

 private:
  // Every bracket is written, so that texts differ where trees do.
  std::string Tree(ExprId id) const {
    const Expr& e = pool[id];
    std::string text = "(" + std::to_string(static_cast<int>(e.kind)) + " " + e.text;
    for (const ExprId arg : e.args) text += " " + Tree(arg);
    for (const Binder& b : e.binders) {
      for (const std::string& name : b.names) text += " " + name;
      text += b.domain.valid() ? " in " + Tree(b.domain) : ": " + PrintType(pool, b.type);
    }
    return text + ")";
  }
};

std::string Printed(const std::string& text) {
  const Read read(text);
  EXPECT_TRUE(read.good()) << text;
  return PrintExpr(read.pool, read.expr);
}

void ExpectSame(const std::string& a, const std::string& b) {
  const Read first(a), second(b);
  EXPECT_TRUE(first.good() && second.good()) << a << ", " << b;
  EXPECT_EQ(first.Tree(), second.Tree()) << a << ", " << b;
}

TEST(ExprParsing, ProductsBindTighterThanSumsAndSumsTighterThanComparisons) {
  ExpectSame("a + b * c < d - e", "(a + (b * c)) < (d - e)");
}

TEST(ExprParsing, AndBindsTighterThanOrAndOrTighterThanImplies) {
  ExpectSame("a and b or c implies d", "((a and b) or c) implies d");
  ExpectSame("a or b and c", "a or (b and c)");
}

TEST(ExprParsing, NotIsLooserThanAComparison) { ExpectSame("not a == b", "not (a == b)"); }

TEST(ExprParsing, NotIsTighterThanAnd) { ExpectSame("not a and b", "(not a) and b"); }

TEST(ExprParsing, ImpliesBindsToTheRight) {
  ExpectSame("a implies b implies c", "a implies (b implies c)");
  EXPECT_NE(Read("a implies b implies c").Tree(), Read("(a implies b) implies c").Tree());
}

TEST(ExprParsing, DifferencesAndQuotientsBindToTheLeft) {
  ExpectSame("a - b - c", "(a - b) - c");
  ExpectSame("a / b * c", "(a / b) * c");
}

TEST(ExprParsing, AMinusBindsLooserThanAMember) { ExpectSame("-a.b[c]", "-(a.b[c])"); }

TEST(ExprParsing, AQuantifierReachesAsFarAsItCan) {
  ExpectSame("forall i in X: a and b implies c", "forall i in X: ((a and b) implies c)");
  ExpectSame("a and forall i in X: b or c", "a and (forall i in X: (b or c))");
}

TEST(ExprParsing, SignsOfOtherLanguagesMeanTheSame) {
  ExpectSame("a && b || !c => d", "a and b or not c implies d");
  ExpectSame("a = b", "a == b");
  ExpectSame("True", "true");
}

TEST(ExprParsing, ComparisonsDoNotChain) {
  EXPECT_EQ(Read("a < b < c").diagnostics.errors(), 1U);
  EXPECT_EQ(Read("a < b < c == d >= e").diagnostics.errors(), 1U);
  EXPECT_TRUE(Read("(a < b) == (c < d)").good());
}

TEST(ExprParsing, MembershipMayBeDenied) {
  const Read read("a not in b");
  ASSERT_TRUE(read.good());
  EXPECT_EQ(read.root().text, "not in");
  EXPECT_EQ(read.root().kind, ExprKind::kBinary);
}

TEST(ExprParsing, BracketsAroundOneAreNothingAndAroundTwoATuple) {
  EXPECT_EQ(Read("(a)").root().kind, ExprKind::kName);
  EXPECT_EQ(Read("(a, b)").root().kind, ExprKind::kTuple);
  EXPECT_FALSE(Read("()").good());
  EXPECT_EQ(Read("[]").root().kind, ExprKind::kList);
}

TEST(ExprParsing, AUnitBelongsToANumberOnly) {
  const Read read("2 m");
  ASSERT_TRUE(read.good());
  EXPECT_EQ(read.root().kind, ExprKind::kQuantity);
  EXPECT_EQ(read.root().text, "m");
  EXPECT_FALSE(Read("a m").whole);
  EXPECT_FALSE(Read("2 kg").whole);
}

TEST(ExprParsing, ReservedWordsAreNoNames) {
  EXPECT_FALSE(Read("if + 1").good());
  EXPECT_FALSE(Read("forall if in X: true").good());
}

TEST(ExprParsing, WhatIsMissingIsReportedOnce) {
  for (const std::string text :
       {"", "a +", "f(a", "a[", "forall", "forall i", "forall i in X", "(a, ", "not", "-"}) {
    const Read read(text);
    EXPECT_TRUE(read.diagnostics.has_errors()) << text;
    EXPECT_LE(read.diagnostics.errors(), 2U) << text;  // one of the lexer, about a bracket
  }
}

TEST(ExprParsing, ADeepTreeIsRefusedAndDoesNotCrash) {
  for (const std::string open : {"(", "-", "not ", "[", "f(", "a[", "forall i in X: ", "a implies "}) {
    std::string text;
    for (int i = 0; i < 5000; ++i) text += open;
    const Read read(text + "a");
    ASSERT_TRUE(read.diagnostics.has_errors()) << open;
    bool nesting = false;
    for (const auto& d : read.diagnostics.all()) nesting = nesting || d.kind == diag::Kind::kSyntaxNesting;
    EXPECT_TRUE(nesting) << open;
  }
}

TEST(ExprParsing, AChainOfTwoThousandOperatorsIsAllowedAndALongerOneIsNot) {
  const auto chain = [](int operators) {
    std::string text = "a";
    for (int i = 0; i < operators; ++i) text += " + a";
    return text;
  };
  EXPECT_TRUE(Read(chain(2000)).good());
  EXPECT_FALSE(Read(chain(2001)).good());
}

TEST(ExprParsing, SpansReachFromTheFirstToTheLastPart) {
  const Read read("  a.b + f(c) ");
  EXPECT_EQ(read.sources.Text(read.root().span), "a.b + f(c)");
  EXPECT_EQ(read.sources.Text(read.pool[read.root().args[1]].span), "f(c)");
}

TEST(ExprPrinting, WritesOnlyTheBracketsThatAreNeeded) {
  EXPECT_EQ(Printed("((a)+((b*c)))"), "a + b * c");
  EXPECT_EQ(Printed("(a + b) * c"), "(a + b) * c");
  EXPECT_EQ(Printed("a - (b - c)"), "a - (b - c)");
  EXPECT_EQ(Printed("(a implies b) implies c"), "(a implies b) implies c");
  EXPECT_EQ(Printed("not (a and b)"), "not (a and b)");
}

TEST(ExprPrinting, AQuantifierKeepsItsBracketsWhereMoreFollows) {
  EXPECT_EQ(Printed("(forall i in X: a) and b"), "(forall i in X: a) and b");
  EXPECT_EQ(Printed("a implies (exists i, j in X, k in Y: b)"), "a implies exists i, j in X, k in Y: b");
}

TEST(ExprPrinting, AMemberOfANumberKeepsItsBrackets) { EXPECT_EQ(Printed("(1).x"), "(1).x"); }

TEST(ExprPrinting, TypesAreWrittenWithArgumentsAndDimensions) {
  EXPECT_EQ(Printed("forall i: List<Map<int, pos>>[n + 1][]: a"),
            "forall i in List<Map<int, pos>>[n + 1][]: a");
}

// A random expression in full brackets.
std::string Random(std::mt19937& random, int depth) {
  const auto inner = [&] { return "(" + Random(random, depth - 1) + ")"; };
  static constexpr const char* kOperators[] = {"+",  "-",  "*",      "/",   "%",  "<",
                                               "==", "in", "not in", "and", "or", "implies"};
  switch (depth == 0 ? random() % 3 : random() % 10) {
    case 0:
      return "a";
    case 1:
      return "12";
    case 2:
      return "pid";
    case 3:
      return "-" + inner();
    case 4:
      return "not " + inner();
    case 5:
      return "forall i in " + inner() + ": " + inner();
    case 6:
      return inner() + "[" + inner() + "].x";
    case 7:
      return "f(" + inner() + ", " + inner() + ")";
    default:
      return inner() + " " + kOperators[random() % 12] + " " + inner();
  }
}

TEST(ExprPrinting, ReadingWhatIsPrintedGivesTheSameTree) {
  std::mt19937 random(11);
  for (int i = 0; i < 3000; ++i) {
    const std::string text = Random(random, 4);
    const Read first(text);
    ASSERT_TRUE(first.good()) << text;
    const std::string printed = PrintExpr(first.pool, first.expr);
    const Read second(printed);
    ASSERT_TRUE(second.good()) << printed;
    ASSERT_EQ(first.Tree(), second.Tree()) << text << "\n" << printed;
    ASSERT_EQ(PrintExpr(second.pool, second.expr), printed);
  }
}

TEST(ExprJson, TellsKindPlaceTextAndOperands) {
  const Read read("x\n  + 2");
  const nlohmann::json json = ExprToJson(read.sources, read.pool, read.expr);
  EXPECT_EQ(json["expr"], "binary");
  EXPECT_EQ(json["text"], "+");
  EXPECT_EQ(json["line"], 1);
  EXPECT_EQ(json["column"], 1);
  ASSERT_EQ(json["args"].size(), 2U);
  EXPECT_EQ(json["args"][1], (nlohmann::json{{"expr", "int"}, {"text", "2"}, {"line", 2}, {"column", 5}}));
}

TEST(ExprJson, ABinderSaysWhatItsVariablesRangeOver) {
  const Read read("exists i, j in S + T: i == j");
  const nlohmann::json json = ExprToJson(read.sources, read.pool, read.expr);
  EXPECT_EQ(json["expr"], "quantifier");
  EXPECT_EQ(json["text"], "exists");
  EXPECT_EQ(json["binders"][0]["names"], (nlohmann::json{"i", "j"}));
  EXPECT_EQ(json["binders"][0]["in"], "S + T");
}

TEST(ExprJson, ColumnsCountCharactersAndNotBytes) {
  const Read read("(a \xE2\x89\xA4 b)");
  const nlohmann::json json = ExprToJson(read.sources, read.pool, read.expr);
  EXPECT_EQ(json["text"], "<=");
  EXPECT_EQ(json["args"][1]["column"], 6);
}

}  // namespace
}  // namespace rondo::lang
