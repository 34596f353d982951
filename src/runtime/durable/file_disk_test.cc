#include "runtime/durable/file_disk.h"

#include <gtest/gtest.h>

#include "fixtures/temporary_folder.h"

namespace rondo::runtime::durable {
namespace {

namespace fs = std::filesystem;
using codec::Bytes;

class FileDiskTest : public testing::Test {
 protected:
  fixtures::TemporaryFolder folder_;
};

TEST_F(FileDiskTest, WhatWasKeptLastComesBack) {
  FileDisk disk(folder_.path() / "record");
  EXPECT_FALSE(disk.Read().has_value());
  EXPECT_TRUE(disk.Keep(Bytes{1, 2, 3}));
  EXPECT_TRUE(disk.Keep(Bytes{4}));
  EXPECT_EQ(FileDisk(folder_.path() / "record").Read(), (Bytes{4}));
  EXPECT_TRUE(disk.Keep({}));
  EXPECT_EQ(disk.Read(), Bytes{});
}

TEST_F(FileDiskTest, AFailureLeavesTheRecordBefore) {
  FileDisk disk(folder_.path() / "record");
  ASSERT_TRUE(disk.Keep(Bytes{1, 2, 3}));
  // Nothing can be written where a folder is in the way.
  fs::create_directories(folder_.path() / "record.new" / "x");
  EXPECT_FALSE(disk.Keep(Bytes{4, 5}));
  EXPECT_EQ(disk.Read(), (Bytes{1, 2, 3}));
  fs::remove_all(folder_.path() / "record.new");
  EXPECT_TRUE(disk.Keep(Bytes{4, 5}));
  EXPECT_EQ(disk.Read(), (Bytes{4, 5}));
}

TEST_F(FileDiskTest, AFullDiskIsAFailure) {
  if (!fs::exists("/dev/full")) GTEST_SKIP();
  fs::create_symlink("/dev/full", folder_.path() / "record.new");
  FileDisk disk(folder_.path() / "record");
  EXPECT_FALSE(disk.Keep(Bytes{1}));
  EXPECT_FALSE(disk.Read().has_value());
}

TEST_F(FileDiskTest, AFolderThatIsGoneIsAFailure) {
  EXPECT_FALSE(FileDisk(folder_.path() / "none" / "record").Keep(Bytes{1}));
}

}  // namespace
}  // namespace rondo::runtime::durable
