#include "workspace/file_kind.h"

#include <gtest/gtest.h>

namespace rondo::workspace {
namespace {

std::string Is(std::string_view path, std::string_view text, Wanted wanted) {
  return WhatElse(path, text, wanted).is;
}

TEST(FileKind, TextsOfTheLanguagesAreWhatTheyAre) {
  EXPECT_EQ(Is("a.koord", "# a program\nusing Motion:\n", Wanted::kKoord), "");
  EXPECT_EQ(Is("a.koord", "", Wanted::kKoord), "");
  EXPECT_EQ(Is("a.koord", "robot = 3\n", Wanted::kKoord), "");
  EXPECT_EQ(Is("a.koord", "\xEF\xBB\xBFrobots: \xC3\xA9\n", Wanted::kKoord), "");
  EXPECT_EQ(Is("a.rondo", "// carts\nrobot Cart {\n", Wanted::kMotion), "");
  EXPECT_EQ(Is("a.toml", "[run]\ndelta = 1\n", Wanted::kToml), "");
  EXPECT_EQ(Is("a.smt2", "; {\n(check-sat)\n", Wanted::kText), "");
  // Names that begin as pictures do.
  EXPECT_EQ(Is("a.koord", "P5: \n", Wanted::kKoord), "");
}

TEST(FileKind, OtherFilesAreNamed) {
  EXPECT_EQ(Is("a.koord", std::string_view("\x89MCAP0\r\n\0\0", 10), Wanted::kKoord), "an MCAP trace");
  EXPECT_EQ(Is("a.toml", std::string_view("P5\n3 3\n255\n\0\0\0", 14), Wanted::kToml), "a picture (PGM)");
  EXPECT_EQ(Is("a.koord", std::string_view("ab\0c", 4), Wanted::kKoord), "no text");
  EXPECT_EQ(Is("a.rondo", "<?xml version='1.0'?>\n<robot name='a'/>", Wanted::kMotion),
            "XML, such as a robot in URDF");
  EXPECT_EQ(Is("a.rondo", "<sdf version='1.9'>", Wanted::kMotion), "a world in SDF");
  EXPECT_EQ(Is("a.koord", " \n{\"format\": \"rondo-run/1\"}", Wanted::kKoord), "JSON");
  EXPECT_NE(WhatElse("a.koord", "{\"format\": \"rondo-run/1\"}", Wanted::kKoord).help, "");
  EXPECT_EQ(Is("a.koord", "\n# x\nrobot Cart {\n", Wanted::kKoord), "a file of robots and choreographies");
  EXPECT_EQ(Is("a.rondo", "using Motion:\n", Wanted::kKoord), "a file of robots and choreographies");
  EXPECT_EQ(Is("a.koord", "using Motion:\n", Wanted::kMotion), "a Koord program");
  EXPECT_EQ(Is("a.koord", "using Motion:\n", Wanted::kToml), "a Koord program");
}

}  // namespace
}  // namespace rondo::workspace
