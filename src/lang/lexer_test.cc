#include "lang/lexer.h"

#include <gtest/gtest.h>

#include <random>

namespace rondo::lang {
namespace {

/// A text and its tokens, which point into it.
struct Lexed {
  diag::SourceSet sources;
  diag::Diagnostics diagnostics;
  TokenStream stream;

  explicit Lexed(const std::string& text, const LexerOptions& options = {}) {
    stream = Lex(sources, sources.Add("text", text), options, diagnostics);
  }
  std::vector<std::string> Texts() const {
    std::vector<std::string> texts;
    for (const Token& t : stream.tokens) {
      if (t.kind != TokenKind::kEnd) texts.emplace_back(t.text);
    }
    return texts;
  }
  std::vector<TokenKind> Kinds() const {
    std::vector<TokenKind> kinds;
    for (const Token& t : stream.tokens) kinds.push_back(t.kind);
    return kinds;
  }
  size_t Count(TokenKind kind) const {
    size_t count = 0;
    for (const Token& t : stream.tokens) count += t.kind == kind ? 1 : 0;
    return count;
  }
  bool Reports(diag::Kind kind) const {
    for (const diag::Diagnostic& d : diagnostics.all()) {
      if (d.kind == kind) return true;
    }
    return false;
  }
};

LexerOptions Braces() {
  LexerOptions options;
  options.indentation = false;
  return options;
}

using Texts = std::vector<std::string>;
using K = TokenKind;

TEST(Lexer, AnEmptyTextIsOnlyAnEnd) {
  EXPECT_EQ(Lexed("").Kinds(), std::vector<K>{K::kEnd});
  EXPECT_EQ(Lexed("\n  \n# remark\n").Kinds(), std::vector<K>{K::kEnd});
}

TEST(Lexer, ALastLineWithoutALineEndHasOne) {
  EXPECT_EQ(Lexed("a").Kinds(), (std::vector<K>{K::kName, K::kNewline, K::kEnd}));
  EXPECT_EQ(Lexed("a\n").Kinds(), Lexed("a").Kinds());
}

TEST(Lexer, ADeeperLineBeginsABlockAndAShallowerOneEndsIt) {
  EXPECT_EQ(Lexed("a\n  b\nc\n").Kinds(),
            (std::vector<K>{K::kName, K::kNewline, K::kIndent, K::kName, K::kNewline, K::kDedent, K::kName,
                            K::kNewline, K::kEnd}));
}

TEST(Lexer, EveryBlockThatIsOpenAtTheEndIsClosed) {
  const Lexed lexed("a\n b\n  c\n   d");
  EXPECT_EQ(lexed.Count(K::kIndent), 3U);
  EXPECT_EQ(lexed.Count(K::kDedent), 3U);
}

TEST(Lexer, BlankLinesAndCommentsDoNotEndABlock) {
  const Lexed lexed("a\n  b\n\n# far left\n  c\n");
  EXPECT_EQ(lexed.Count(K::kIndent), 1U);
  EXPECT_EQ(lexed.Count(K::kDedent), 1U);
}

TEST(Lexer, ALineBetweenTwoDepthsIsReported) {
  const Lexed lexed("a\n    b\n  c\n");
  EXPECT_TRUE(lexed.Reports(diag::Kind::kSyntaxIndentation));
  EXPECT_EQ(lexed.Count(K::kIndent), lexed.Count(K::kDedent));
}

TEST(Lexer, ATabCountsUpToTheNextMultipleOfEight) {
  const Lexed lexed("a\n   \tb\n        c\n");
  EXPECT_TRUE(lexed.Reports(diag::Kind::kSyntaxTab));
  EXPECT_FALSE(lexed.diagnostics.has_errors());
  EXPECT_EQ(lexed.Count(K::kIndent), 1U);
}

TEST(Lexer, LinesJoinInsideBrackets) {
  const Lexed lexed("f(a,\n      b)\n");
  EXPECT_EQ(lexed.Count(K::kNewline), 1U);
  EXPECT_EQ(lexed.Count(K::kIndent), 0U);
}

TEST(Lexer, ABackslashJoinsALineToTheNext) {
  const Lexed lexed("a +  \\  \n      b\n");
  EXPECT_EQ(lexed.Count(K::kNewline), 1U);
  EXPECT_EQ(lexed.Count(K::kIndent), 0U);
  EXPECT_TRUE(lexed.diagnostics.all().empty());
}

TEST(Lexer, ABracketThatStaysOpenIsReportedOnce) {
  const Lexed lexed("f((a\n");
  EXPECT_TRUE(lexed.Reports(diag::Kind::kSyntaxUnexpected));
  EXPECT_EQ(lexed.diagnostics.errors(), 1U);
}

TEST(Lexer, LanguagesWithBracesHaveNoLines) {
  const Lexed lexed("a\n  b\n\tc\n", Braces());
  EXPECT_EQ(lexed.Kinds(), (std::vector<K>{K::kName, K::kName, K::kName, K::kEnd}));
  EXPECT_TRUE(lexed.diagnostics.all().empty());
}

TEST(Lexer, TheLongestSignIsTaken) {
  EXPECT_EQ(Lexed("a<=>b<=c<d", Braces()).Texts(), (Texts{"a", "<=>", "b", "<=", "c", "<", "d"}));
  EXPECT_EQ(Lexed("a->b=>c==d=e", Braces()).Texts(), (Texts{"a", "->", "b", "=>", "c", "==", "d", "=", "e"}));
}

TEST(Lexer, SignsOfMathematicsHaveTheirUsualSpelling) {
  const Lexed lexed("a \xE2\x89\xA4 b \xE2\x88\xA7 \xC2\xAC c \xE2\x89\xA0 d", Braces());
  EXPECT_EQ(lexed.Texts(), (Texts{"a", "<=", "b", "and", "not", "c", "!=", "d"}));
  EXPECT_EQ(lexed.stream.tokens[1].kind, K::kPunctuation);
  EXPECT_EQ(lexed.stream.tokens[3].kind, K::kName);
}

TEST(Lexer, NumbersMayLackDigitsOnOneSide) {
  const Lexed lexed("12 1.5 .5 5. 1e-3 2.5E+6", Braces());
  EXPECT_EQ(lexed.Texts(), (Texts{"12", "1.5", ".5", "5.", "1e-3", "2.5E+6"}));
  EXPECT_EQ(lexed.stream.tokens[0].kind, K::kInt);
  for (size_t i = 1; i < 6; ++i) EXPECT_EQ(lexed.stream.tokens[i].kind, K::kFloat);
}

TEST(Lexer, TwoDotsAreARangeBetweenNumbers) {
  const Lexed lexed("0..5", Braces());
  EXPECT_EQ(lexed.Texts(), (Texts{"0", "..", "5"}));
  EXPECT_EQ(lexed.stream.tokens[0].kind, K::kInt);
}

TEST(Lexer, ANameCannotStartWithADigit) {
  const Lexed lexed("2nd", Braces());
  EXPECT_TRUE(lexed.Reports(diag::Kind::kSyntaxNumber));
  EXPECT_EQ(lexed.Kinds(), (std::vector<K>{K::kInt, K::kEnd}));
}

TEST(Lexer, NumbersMustBeNearADoubleWhereThisIsAsked) {
  LexerOptions options = Braces();
  options.doubles = true;
  EXPECT_TRUE(Lexed("1e999", options).Reports(diag::Kind::kSyntaxNumber));
  EXPECT_TRUE(Lexed("1e-999", options).Reports(diag::Kind::kSyntaxNumber));
  EXPECT_TRUE(Lexed("1e300 0.0 0e5", options).diagnostics.all().empty());
  EXPECT_TRUE(Lexed("1e999", Braces()).diagnostics.all().empty());
}

TEST(Lexer, AStringKeepsItsQuotes) {
  const Lexed lexed("\"a \\\" b\" 'c'", Braces());
  EXPECT_EQ(lexed.Texts(), (Texts{"\"a \\\" b\"", "'c'"}));
  EXPECT_TRUE(lexed.diagnostics.all().empty());
}

TEST(Lexer, AStringEndsWithItsLineAtTheLatest) {
  const Lexed lexed("\"abc\nd", Braces());
  EXPECT_TRUE(lexed.Reports(diag::Kind::kSyntaxUnterminatedString));
  EXPECT_EQ(lexed.Texts(), (Texts{"\"abc", "d"}));
}

TEST(Lexer, SomeSignsAreOnlySignsWhereALanguageHasThem) {
  for (const std::string text : {"a | b", "a @ b"})
    EXPECT_TRUE(Lexed(text, Braces()).Reports(diag::Kind::kSyntaxUnknownCharacter)) << text;
  LexerOptions options = Braces();
  options.bar = options.at = options.prime = true;
  EXPECT_EQ(Lexed("a | b @ x' = c", options).Texts(), (Texts{"a", "|", "b", "@", "x", "'", "=", "c"}));
}

TEST(Lexer, AHalfOpenIntervalClosesItsBracketWhereALanguageHasThem) {
  LexerOptions options;
  options.half_open = true;
  EXPECT_TRUE(Lexed("[0, inf)\n", options).diagnostics.all().empty());
  EXPECT_TRUE(Lexed("[0, inf)\n").diagnostics.has_errors());
}

TEST(Lexer, AnUnknownCharacterIsOneReportHoweverManyBytesItHas) {
  const Lexed lexed("a \xF0\x9F\xA4\x96 b", Braces());
  EXPECT_EQ(lexed.diagnostics.errors(), 1U);
  EXPECT_EQ(lexed.Texts(), (Texts{"a", "b"}));
}

TEST(Lexer, CommentsAreKeptWithoutTheirMark) {
  const Lexed lexed("a  // behind \n#alone\nb");
  ASSERT_EQ(lexed.stream.comments.size(), 2U);
  EXPECT_EQ(lexed.stream.comments[0].text, "behind");
  EXPECT_FALSE(lexed.stream.comments[0].alone);
  EXPECT_EQ(lexed.stream.comments[0].line, 1U);
  EXPECT_EQ(lexed.stream.comments[1].text, "alone");
  EXPECT_TRUE(lexed.stream.comments[1].alone);
  EXPECT_EQ(lexed.stream.comments[1].line, 2U);
}

TEST(Lexer, LineEndsOfWindowsAreLineEnds) {
  EXPECT_EQ(Lexed("a\r\n  b\r\nc\r\n").Kinds(), Lexed("a\n  b\nc\n").Kinds());
  EXPECT_TRUE(Lexed("a # x\r\nb\r\n").diagnostics.all().empty());
}

TEST(Lexer, SpansCoverWhatIsWritten) {
  const Lexed lexed("ab <= 3.5", Braces());
  const Token& number = lexed.stream.tokens[2];
  EXPECT_EQ(lexed.sources.Text(number.span), "3.5");
  EXPECT_EQ(number.span.begin, 6U);
  EXPECT_EQ(number.span.end, 9U);
}

TEST(Lexer, AnyBytesGiveBalancedTokensThatEnd) {
  const std::string alphabet = "a1. \t\n\r()[]{}<=\"'\\#/|&@\xE2\x89\xA4:_-";
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    std::string text(random() % 40, ' ');
    for (char& c : text) c = i % 4 == 0 ? static_cast<char>(random()) : alphabet[random() % alphabet.size()];
    const Lexed lexed(text);
    ASSERT_EQ(lexed.stream.tokens.back().kind, K::kEnd) << text;
    ASSERT_EQ(lexed.Count(K::kIndent), lexed.Count(K::kDedent)) << text;
    for (const Token& t : lexed.stream.tokens) {
      ASSERT_LE(t.span.begin, t.span.end);
      ASSERT_LE(t.span.end, text.size());
    }
  }
}

TEST(Lexer, TokensAreCalledAsPeopleWouldCallThem) {
  EXPECT_EQ(Describe({K::kEnd, {}, ""}), "the end of the file");
  EXPECT_EQ(Describe({K::kNewline, {}, ""}), "the end of the line");
  EXPECT_EQ(Describe({K::kIndent, {}, ""}), "a deeper line");
  EXPECT_EQ(Describe({K::kPunctuation, {}, ")"}), "`)`");
}

}  // namespace
}  // namespace rondo::lang
