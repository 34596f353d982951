#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "fixtures/temporary_folder.h"
#include "trace/bytes.h"
#include "trace/reader.h"
#include "trace/ros.h"
#include "trace/writer.h"

namespace rondo::trace {
namespace {

namespace fs = std::filesystem;

const Schema kJson{"json", "jsonschema", "{}"};
constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);

/// A folder of its own for each test.
class TraceFiles : public testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_.Path(name); }

  fixtures::TemporaryFolder folder_;
};

std::string Record(uint8_t op, std::string_view content) {
  std::string record;
  Put<uint8_t>(record, op);
  Put<uint64_t>(record, content.size());
  return record.append(content);
}

std::string ChannelRecord(uint16_t id, std::string_view topic) {
  std::string content;
  Put<uint16_t>(content, id);
  Put<uint16_t>(content, 0);
  PutText(content, topic);
  PutText(content, "json");
  Put<uint32_t>(content, 0);
  return Record(0x04, content);
}

std::string MessageRecord(uint16_t channel, uint64_t time, std::string_view bytes) {
  std::string content;
  Put<uint16_t>(content, channel);
  Put<uint32_t>(content, 0);
  Put<uint64_t>(content, time);
  Put<uint64_t>(content, time);
  return Record(0x05, content.append(bytes));
}

std::string Chunk(std::string_view records, std::string_view compression = "") {
  std::string content;
  Put<uint64_t>(content, 0);
  Put<uint64_t>(content, 0);
  Put<uint64_t>(content, records.size());
  Put<uint32_t>(content, 0);
  PutText(content, compression);
  Put<uint64_t>(content, records.size());
  return Record(0x06, content.append(records));
}

std::string Whole(const std::string& records) {
  return std::string(kMagic) + records + Record(0x0F, std::string(4, '\0')) +
         Record(0x02, std::string(20, '\0')) + std::string(kMagic);
}

// The contents of all messages of a file, or nothing if it is refused.
std::optional<std::vector<std::string>> Contents(const std::string& file) {
  std::vector<std::string> contents;
  const auto done = ForEachMessage(file, [&](const Message& m) {
    contents.emplace_back(m.bytes);
    return true;
  });
  return done.ok() ? std::optional(contents) : std::nullopt;
}

using Texts = std::vector<std::string>;

TEST(TraceBytes, ACursorStaysWhereItIsOnceBytesDoNotSuffice) {
  Cursor cursor(std::string_view("abc"));
  EXPECT_EQ(cursor.Take<uint8_t>(), 'a');
  EXPECT_FALSE(cursor.Take<uint32_t>());
  EXPECT_EQ(cursor.rest(), "bc");
  EXPECT_FALSE(cursor.Take(uint64_t{3}));
  EXPECT_FALSE(cursor.Take(std::numeric_limits<uint64_t>::max()));
  EXPECT_EQ(cursor.Take(uint64_t{2}), "bc");
  EXPECT_TRUE(cursor.empty());
}

TEST(TraceBytes, NumbersAreLittleEndian) {
  std::string bytes;
  Put<uint32_t>(bytes, 0x01020304);
  EXPECT_EQ(bytes, "\x04\x03\x02\x01");
}

TEST(TraceBytes, ATextThatIsLongerThanTheRestIsNone) {
  std::string bytes;
  PutText(bytes, "hello");
  EXPECT_EQ(Cursor(bytes).TakeText(), "hello");
  bytes.pop_back();
  EXPECT_FALSE(Cursor(bytes).TakeText());
}

TEST(TraceReading, MessagesMayStandInChunksOrOutsideOfThem) {
  const std::string file =
      Whole(ChannelRecord(7, "/a") + MessageRecord(7, 1, "one") + Chunk(MessageRecord(7, 2, "two")));
  EXPECT_EQ(Contents(file), (Texts{"one", "two"}));
}

TEST(TraceReading, UnknownRecordsAreSkipped) {
  EXPECT_EQ(Contents(Whole(Record(0x7F, "?") + ChannelRecord(0, "/a") + MessageRecord(0, 0, "x"))),
            Texts{"x"});
}

TEST(TraceReading, AMessageOfNoChannelIsDamage) {
  EXPECT_FALSE(Contents(Whole(ChannelRecord(0, "/a") + MessageRecord(1, 0, "x"))));
}

TEST(TraceReading, AChunkInAChunkIsDamage) {
  EXPECT_FALSE(Contents(Whole(ChannelRecord(0, "/a") + Chunk(Chunk(MessageRecord(0, 0, "x"))))));
}

TEST(TraceReading, ACompressedChunkIsRefused) {
  EXPECT_FALSE(Contents(Whole(ChannelRecord(0, "/a") + Chunk(MessageRecord(0, 0, "x"), "zstd"))));
}

TEST(TraceReading, ARecordThatClaimsToBeLongerThanTheFileIsRefused) {
  std::string record;
  Put<uint8_t>(record, 0x7F);
  Put<uint64_t>(record, std::numeric_limits<uint64_t>::max());
  EXPECT_FALSE(Contents(Whole(record)));
}

TEST(TraceReading, WithoutARecordOfTheEndAFileIsNotComplete) {
  EXPECT_FALSE(Contents(std::string(kMagic) + ChannelRecord(0, "/a") + std::string(kMagic)));
  EXPECT_EQ(Contents(Whole("")), Texts{});
}

TEST(TraceReading, WhatIsNoTraceIsRefused) {
  EXPECT_FALSE(Contents(""));
  EXPECT_FALSE(Contents(std::string(kMagic)));
  EXPECT_FALSE(Contents("{\"format\": \"rondo-run/1\"}"));
  EXPECT_FALSE(Contents(std::string(kMagic.substr(0, 7)) + std::string(kMagic)));
}

TEST(TraceReading, AVisitorEndsTheReading) {
  const std::string file =
      Whole(ChannelRecord(0, "/a") + MessageRecord(0, 1, "one") + MessageRecord(0, 2, "two"));
  int visits = 0;
  EXPECT_TRUE(ForEachMessage(file, [&](const Message&) { return ++visits < 1; }).ok());
  EXPECT_EQ(visits, 1);
}

TEST_F(TraceFiles, AMissingTraceIsAnError) { EXPECT_FALSE(ReadTrace(Path("none.mcap")).ok()); }

TEST_F(TraceFiles, AFolderCannotBeWrittenAsATrace) {
  EXPECT_FALSE(Writer::Open(folder_.path().string()).ok());
}

TEST_F(TraceFiles, NoFolderIsMade) {
  const auto refused = Writer::Open(Path("a/c.mcap"));
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("there is no folder"), std::string::npos);
}

TEST_F(TraceFiles, AWriterThatIsMovedFinishesOnce) {
  Writer first = Writer::Open(Path("a.mcap")).value();
  Writer second = std::move(first);
  second.Message(second.Channel("/a", kJson, "json"), 3, "x");
  EXPECT_EQ(second.messages(), 1U);
  EXPECT_TRUE(second.Finish().ok());
  EXPECT_EQ(Contents(ReadTrace(Path("a.mcap")).value()), Texts{"x"});
}

TEST_F(TraceFiles, AnUnfinishedTraceDoesNotReplaceAnOlderOne) {
  std::ofstream(Path("a.mcap")) << "old";
  {
    Writer writer = Writer::Open(Path("a.mcap")).value();
    writer.Message(writer.Channel("/a", kJson, "json"), 0, "new");
  }
  EXPECT_EQ(ReadTrace(Path("a.mcap")).value(), "old");
  EXPECT_FALSE(fs::exists(Path("a.mcap.partial")));
}

TEST_F(TraceFiles, MessagesHaveTheTopicSchemaAndEncodingOfTheirChannel) {
  Writer writer = Writer::Open(Path("a.mcap")).value();
  const uint16_t a = writer.Channel("/a", kJson, "json");
  const uint16_t b = writer.Channel("/b", kPath, "cdr");
  writer.Message(b, 5, "");
  writer.Message(a, 5, "{}");
  ASSERT_TRUE(writer.Finish().ok());
  const std::string bytes = ReadTrace(Path("a.mcap")).value();
  std::vector<std::string> all;
  ASSERT_TRUE(ForEachMessage(bytes, [&](const Message& m) {
                all.push_back(std::string(m.topic) + " " + std::string(m.schema) + " " +
                              std::string(m.encoding));
                return true;
              }).ok());
  EXPECT_EQ(all, (Texts{"/b " + std::string(kPath.name) + " cdr", "/a json json"}));
}

TEST_F(TraceFiles, EveryFlippedBitIsNoticed) {
  Writer writer = Writer::Open(Path("a.mcap")).value();
  const uint16_t a = writer.Channel("/rondo/event", kRecord, "json");
  const uint16_t b = writer.Channel("/b", kPath, "cdr");
  writer.Message(a, 5, R"({"event":"collision"})");
  writer.Message(b, 6, trace::Path(6, {{1, 2, 3}}));
  writer.Keep();
  writer.Message(a, 7, "{}");
  ASSERT_TRUE(writer.Finish().ok());
  const std::string good = ReadTrace(Path("a.mcap")).value();
  ASSERT_EQ(Contents(good)->size(), 3U);
  for (size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ (1 << (i % 8)));
    EXPECT_FALSE(Contents(bad)) << i;
  }
}

TEST(RosMessages, EachTruncationOfAPoseIsRefused) {
  const std::string good = PoseStamped(1'500'000'000, {{1, -2, 3.5}, {0, 0, 1, 0}});
  Pose pose;
  ASSERT_TRUE(ReadPose(good, pose));
  EXPECT_EQ(pose.position, (std::array<double, 3>{1, -2, 3.5}));
  EXPECT_EQ(pose.rotation, (std::array<double, 4>{0, 0, 1, 0}));
  for (size_t size = 0; size < good.size(); ++size)
    EXPECT_FALSE(ReadPose(good.substr(0, size), pose)) << size;
}

TEST(RosMessages, EachTruncationOfAGridIsRefusedAndLeavesTheGridAsItWas) {
  const std::string good = OccupancyGrid(3, {0.25F, 2, 2, {5, -5}, {0, 100, -1, 0}});
  Grid grid;
  grid.width = 77;
  for (size_t size = 0; size < good.size(); ++size) {
    EXPECT_FALSE(ReadGrid(good.substr(0, size), grid)) << size;
    EXPECT_EQ(grid.width, 77U);
    EXPECT_TRUE(grid.cells.empty());
  }
  EXPECT_TRUE(ReadGrid(good, grid));
  EXPECT_EQ(grid.resolution, 0.25F);
  EXPECT_EQ(grid.height, 2U);
}

TEST(RosMessages, RandomBytesNeverCrash) {
  std::mt19937 random(3);
  for (int i = 0; i < 5000; ++i) {
    std::string bytes(random() % 200, '\0');
    for (char& c : bytes) c = i % 2 == 0 ? static_cast<char>(random()) : static_cast<char>(random() % 3);
    Pose pose;
    Grid grid;
    ReadPose(bytes, pose);
    const bool read = ReadGrid(bytes, grid);
    EXPECT_EQ(grid.cells.size(), read ? size_t{grid.width} * grid.height : 0);
  }
}

}  // namespace
}  // namespace rondo::trace
