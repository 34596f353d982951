#include "base/file.h"

#include <gtest/gtest.h>
#include <unistd.h>

namespace rondo::base {
namespace {

std::filesystem::path Scratch() {
  return std::filesystem::temp_directory_path() / ("rondo_file_test_" + std::to_string(::getpid()));
}

TEST(File, WritesAndReadsBack) {
  const auto path = Scratch() / "deep" / "file.txt";
  const std::string text("a\0b\n", 4);
  // No folder is made for a file.
  EXPECT_NE(WriteFileAtomically(path, text).error().message.find("there is no folder"), std::string::npos);
  ASSERT_TRUE(MakeFolders(path.parent_path()).ok());
  ASSERT_TRUE(WriteFileAtomically(path, text).ok());
  const auto read = ReadFile(path);
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read.value(), text);
  // Nothing temporary is left beside it.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path.parent_path()), {}), 1);
  std::filesystem::remove_all(Scratch());
}

TEST(File, MissingFileAndFolderAreErrors) {
  EXPECT_EQ(ReadFile("/nonexistent/file").error().message, "no such file");
  EXPECT_EQ(ReadFile("/").error().message, "is a folder, not a file");
}

TEST(File, UnwritablePlaceIsAnError) { EXPECT_FALSE(WriteFileAtomically("/proc/nowhere/file", "x").ok()); }

}  // namespace
}  // namespace rondo::base
