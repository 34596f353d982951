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

}  // namespace
}  // namespace rondo::diag
