#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <random>

#include "trace/reader.h"
#include "trace/ros.h"
#include "trace/writer.h"

namespace rondo::trace {
namespace {

const Schema kText{"text", "jsonschema", "{}"};

// Tests run side by side.
std::string Temporary() {
  const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
  return (std::filesystem::temp_directory_path() / ("rondo-" + test + std::to_string(::getpid()) + ".mcap"))
      .string();
}

std::string Written(int messages) {
  const std::string path = Temporary();
  {
    Writer writer = Writer::Open(path).value();
    const uint16_t a = writer.Channel("/a", kText, "json");
    const uint16_t b = writer.Channel("/b", kPoseStamped, "cdr");
    for (int i = 0; i < messages; ++i) {
      const auto time = static_cast<uint64_t>(i) * 1000;
      writer.Message(a, time, "{\"i\":" + std::to_string(i) + "}");
      writer.Message(b, time, PoseStamped(time, {{static_cast<double>(i), 2, 3}, {0, 0, 0, 1}}));
    }
    EXPECT_FALSE(std::filesystem::exists(path));  // not before it is whole
    EXPECT_TRUE(writer.Finish().ok());
  }
  std::string bytes = ReadTrace(path).value();
  std::filesystem::remove(path);
  return bytes;
}

TEST(Trace, ReadsBackWhatWasWritten) {
  const std::string bytes = Written(20'000);  // several chunks
  int count = 0;
  const auto done = ForEachMessage(bytes, [&](const Message& m) {
    const int i = count++ / 2;
    EXPECT_EQ(m.time, static_cast<uint64_t>(i) * 1000);
    if (m.topic == "/a") {
      EXPECT_EQ(m.bytes, "{\"i\":" + std::to_string(i) + "}");
    } else {
      Pose pose;
      EXPECT_TRUE(ReadPose(m.bytes, pose));
      EXPECT_EQ(pose.position[0], i);
      EXPECT_EQ(pose.rotation[3], 1);
    }
    return true;
  });
  EXPECT_TRUE(done.ok());
  EXPECT_EQ(count, 40'000);
  EXPECT_EQ(bytes, Written(20'000));
}

TEST(Trace, AWriterThatDoesNotFinishLeavesNothing) {
  const std::string path = Temporary();
  {
    Writer writer = Writer::Open(path).value();
    writer.Message(writer.Channel("/a", kText, "json"), 0, "{}");
  }
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_FALSE(std::filesystem::exists(path + ".partial"));
}

TEST(Trace, DamagedBytesAreRefusedOrReadButNeverCrash) {
  const std::string good = Written(50);
  std::mt19937 random(1);
  size_t refused = 0;
  for (int i = 0; i < 5000; ++i) {
    std::string bad = good;
    for (int k = 0; k < 1 + i % 4; ++k) bad[random() % bad.size()] = static_cast<char>(random());
    if (i % 3 == 0) bad.resize(random() % bad.size());
    const auto done = ForEachMessage(bad, [&](const Message& m) {
      Pose pose;
      ReadPose(m.bytes, pose);
      Grid grid;
      ReadGrid(m.bytes, grid);
      return true;
    });
    refused += done.ok() ? 0 : 1;
  }
  EXPECT_GT(refused, 1000U);
  for (size_t size = 0; size + 1 < good.size(); ++size)
    EXPECT_FALSE(
        ForEachMessage(std::string_view(good).substr(0, size), [](const Message&) { return true; }).ok());
}

TEST(Trace, GridsGoThroughTheirMessage) {
  Grid grid{0.5F, 3, 2, {-1, 4}, {-1, 0, 100, 0, 0, 100}};
  Grid back;
  ASSERT_TRUE(ReadGrid(OccupancyGrid(7, grid), back));
  EXPECT_EQ(back.cells, grid.cells);
  EXPECT_EQ(back.width, 3U);
  EXPECT_EQ(back.origin, grid.origin);
}

// A process that is killed leaves what it kept.
TEST(Trace, WhatWasKeptIsReadAfterACrash) {
  const std::string path = Temporary();
  Writer writer = Writer::Open(path).value();
  const uint16_t a = writer.Channel("/a", kText, "json");
  writer.Message(a, 1, "{}");
  writer.Keep();
  writer.Message(a, 2, "{}");
  const std::string left = ReadTrace(path + ".partial").value();
  size_t count = 0;
  const auto visit = [&](const Message& m) {
    ++count;
    return m.topic == "/a";
  };
  EXPECT_FALSE(ForEachMessage(left, visit).ok());
  for (size_t cut = 0; cut <= left.size(); cut += 7) {
    count = 0;
    const auto read = ForEachMessageLeft(left.substr(0, left.size() - cut), visit);
    EXPECT_EQ(read.ok(), left.size() - cut >= 8) << cut;
    EXPECT_EQ(count, cut == 0 ? 1U : count);
    EXPECT_LE(count, 1U);
  }
  EXPECT_TRUE(writer.Finish().ok());
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace rondo::trace
