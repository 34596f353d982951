#include "diag/render.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace rondo::diag {
namespace {

class Render : public testing::Test {
 protected:
  SourceSet sources_;
  FileId file_ = sources_.Add("a.koord", "local:\n    int n = true\n");
  Diagnostics diagnostics_;

  Span At(std::string_view text) const {
    const auto begin = static_cast<uint32_t>(sources_.text(file_).find(text));
    return {file_, begin, begin + static_cast<uint32_t>(text.size())};
  }
};

TEST_F(Render, ShowsTheLineTheCaretsAndTheLabels) {
  diagnostics_.Report(Kind::kKoordTypeMismatch, At("true"), "`n` is an `int`")
      .Under("this is a `bool`")
      .At(At("int n"), "declared here")
      .Note("a note\nwith two lines")
      .Help("write a number");
  EXPECT_EQ(RenderText(sources_, diagnostics_.all()[0], Colour::kOff),
            "error: `n` is an `int` [koord-type-mismatch]\n"
            "  --> a.koord:2:13\n"
            "   |\n"
            " 2 |     int n = true\n"
            "   |             ^^^^ this is a `bool`\n"
            "   |     ----- declared here\n"
            "   = a note\n"
            "   | with two lines\n"
            "help: write a number\n");
}

TEST_F(Render, JsonHasTheSameFacts) {
  diagnostics_.Report(Kind::kKoordTypeMismatch, At("true"), "`n` is an `int`").Fix(At("true"), "1");
  const nlohmann::json json = RenderJson(sources_, diagnostics_.all()[0]);
  EXPECT_EQ(json["kind"], "koord-type-mismatch");
  EXPECT_EQ(json["line"], 2);
  EXPECT_EQ(json["column"], 13);
  EXPECT_EQ(json["end_column"], 17);
  EXPECT_EQ(json["fixes"][0]["replacement"], "1");
}

TEST_F(Render, OneReportPerCause) {
  diagnostics_.Report(Kind::kKoordTypeMismatch, At("true"), "same");
  diagnostics_.Report(Kind::kKoordTypeMismatch, At("true"), "same").Note("dropped");
  EXPECT_EQ(diagnostics_.all().size(), 1u);
  EXPECT_EQ(diagnostics_.errors(), 1u);
  EXPECT_TRUE(diagnostics_.all()[0].notes.empty());
}

TEST_F(Render, ColumnsCountCodePoints) {
  const FileId file = sources_.Add("b.koord", "\xCE\xB4 = x\n");
  EXPECT_EQ(sources_.Locate(file, 5).column, 5u);
}

TEST(Rendering, WhatTerminalsObeyIsShownAndNotSent) {
  EXPECT_EQ(Escaped("a\x1b[31m\x07\n\x7f"), "a\\x1b[31m\\x07\n\\x7f");
  EXPECT_EQ(Escaped("\xC3\xA9 \xE2\x89\xA4 \xF0\x9F\xA4\x96"), "\xC3\xA9 \xE2\x89\xA4 \xF0\x9F\xA4\x96");
  EXPECT_EQ(Escaped("\xFF\xC3 \xC0\x80"), "\\xff\\xc3 \\xc0\\x80");
  EXPECT_EQ(Escaped("\xC2\x9B"), "\\xc2\\x9b");           // CSI, as one character
  EXPECT_EQ(Escaped("\xE2\x80\xAE"), "\\xe2\\x80\\xae");  // right to left from here
  SourceSet sources;
  const FileId file = sources.Add("a\x1b.koord", "x \x1b[2J y\n");
  Diagnostics diagnostics;
  diagnostics.Report(Kind::kSyntaxUnexpected, {file, 7, 8}, "`\x1b` is nothing");
  const std::string text = RenderText(sources, diagnostics.all()[0], Colour::kOff);
  EXPECT_EQ(text.find('\x1b'), std::string::npos) << text;
  // The caret stays below what it points at.
  EXPECT_NE(text.find("x \xEF\xBF\xBD[2J y\n   |        ^"), std::string::npos) << text;
}

TEST(Rendering, OfALongLineAPartIsShown) {
  SourceSet sources;
  const FileId file = sources.Add("a.koord", std::string(5000, 'a') + "$" + std::string(5000, 'b'));
  Diagnostics diagnostics;
  diagnostics.Report(Kind::kSyntaxUnexpected, {file, 5000, 5001}, "no");
  const std::string text = RenderText(sources, diagnostics.all()[0], Colour::kOff);
  EXPECT_LT(text.size(), 600U);
  const size_t line = text.find("aaa$bbb"), caret = text.find('^');
  ASSERT_NE(line, std::string::npos);
  ASSERT_NE(caret, std::string::npos);
  const auto column = [&](size_t at) {
    return CountCodePoints(text.substr(text.rfind('\n', at) + 1, at - text.rfind('\n', at) - 1));
  };
  EXPECT_EQ(column(line + 3), column(caret));
}

TEST(Diagnostics, OfEachFileTheFirstErrorsAreKeptAndTheOthersCounted) {
  SourceSet sources;
  const FileId a = sources.Add("a", std::string(100, 'x')), b = sources.Add("b", "x");
  Diagnostics diagnostics;
  for (uint32_t i = 0; i < 50; ++i) diagnostics.Report(Kind::kSyntaxUnexpected, {a, i, i + 1}, "no");
  diagnostics.Report(Kind::kSyntaxUnexpected, {b, 0, 1}, "no");
  diagnostics.Report(Kind::kSyntaxTab, {a, 0, 1}, "a tab");
  EXPECT_EQ(diagnostics.errors(), 51U);
  EXPECT_EQ(diagnostics.more(), 30U);
  EXPECT_EQ(diagnostics.all().size(), 22U);
  EXPECT_EQ(diagnostics.Sorted().back().kind, Kind::kFileMore);
}

}  // namespace
}  // namespace rondo::diag
