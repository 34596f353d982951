#include "trace/writer.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "trace/bytes.h"

namespace rondo::trace {

namespace {

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
constexpr size_t kChunk = size_t{1} << 20;

enum Opcode : uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunkRecord = 0x06,
  kMessageIndex = 0x07,
  kChunkIndexRecord = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

std::string Partial(const std::string& path) { return path + ".partial"; }

}  // namespace

base::Result<Writer> Writer::Open(const std::string& path) {
  std::error_code failed;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (!folder.empty() && !std::filesystem::exists(folder, failed))
    return base::Error{"there is no folder `" + folder.string() + "`"};
  if (std::filesystem::exists(path, failed) && !std::filesystem::is_regular_file(path, failed))
    return base::Error{"it is not a regular file"};
  Writer writer(path);
  writer.file_ = std::fopen(Partial(path).c_str(), "wb");
  if (writer.file_ == nullptr) return base::Error{std::strerror(errno)};
  writer.Write(kMagic);
  std::string header;
  PutText(header, "ros2");
  PutText(header, "rondo");
  std::string record;
  Record(record, kHeader, header);
  writer.Write(record);
  return writer;
}

Writer::Writer(Writer&& other) noexcept
    : path_(std::move(other.path_)),
      file_(std::exchange(other.file_, nullptr)),
      failed_(other.failed_),
      kept_(other.kept_),
      offset_(other.offset_),
      sum_(other.sum_),
      schemas_(std::move(other.schemas_)),
      channels_(std::move(other.channels_)),
      chunk_(std::move(other.chunk_)),
      chunk_start_(other.chunk_start_),
      chunk_end_(other.chunk_end_),
      chunk_has_messages_(other.chunk_has_messages_),
      chunks_(std::move(other.chunks_)),
      messages_(other.messages_),
      first_time_(other.first_time_),
      last_time_(other.last_time_) {}

Writer::~Writer() {
  if (file_ == nullptr) return;
  std::fclose(file_);
  std::error_code ignored;
  if (!kept_) std::filesystem::remove(Partial(path_), ignored);
}

void Writer::Write(std::string_view bytes) {
  failed_ = failed_ || std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size();
  offset_ += bytes.size();
  sum_ = Checksum(bytes, sum_);
}

void Writer::Record(std::string& out, uint8_t op, std::string_view content) {
  Put<uint8_t>(out, op);
  Put<uint64_t>(out, content.size());
  out.append(content);
}

std::string Writer::SchemaRecord(uint16_t id) const {
  const Schema& schema = schemas_[id - 1U];
  std::string content;
  Put<uint16_t>(content, id);
  PutText(content, schema.name);
  PutText(content, schema.encoding);
  PutText(content, schema.text);
  std::string record;
  Record(record, kSchema, content);
  return record;
}

std::string Writer::ChannelRecord(uint16_t id) const {
  const KnownChannel& channel = channels_[id];
  std::string content;
  Put<uint16_t>(content, id);
  Put<uint16_t>(content, channel.schema);
  PutText(content, channel.topic);
  PutText(content, channel.encoding);
  std::string metadata;
  if (channel.schema != 0 && !schemas_[channel.schema - 1U].hash.empty()) {
    PutText(metadata, "offered_qos_profiles");
    PutText(metadata, "");
    PutText(metadata, "topic_type_hash");
    PutText(metadata, schemas_[channel.schema - 1U].hash);
  }
  PutText(content, metadata);
  std::string record;
  Record(record, kChannel, content);
  return record;
}

uint16_t Writer::Channel(const std::string& topic, const Schema& schema, const std::string& encoding) {
  uint16_t id = 0;
  for (size_t i = 0; i < schemas_.size(); ++i) {
    if (schemas_[i].name == schema.name) id = static_cast<uint16_t>(i + 1);
  }
  if (id == 0 && !schema.name.empty()) {
    schemas_.push_back(schema);
    id = static_cast<uint16_t>(schemas_.size());
    chunk_ += SchemaRecord(id);
  }
  channels_.push_back({id, topic, encoding, 0, {}});
  const auto channel = static_cast<uint16_t>(channels_.size() - 1);
  chunk_ += ChannelRecord(channel);
  return channel;
}

void Writer::Message(uint16_t channel, uint64_t time, std::string_view bytes) {
  KnownChannel& known = channels_[channel];
  known.index.emplace_back(time, chunk_.size());
  if (messages_ == 0) first_time_ = time;
  last_time_ = time;
  if (!chunk_has_messages_) chunk_start_ = time;
  chunk_has_messages_ = true;
  chunk_end_ = time;
  std::string content;
  content.reserve(bytes.size() + 22);
  Put<uint16_t>(content, channel);
  Put<uint32_t>(content, static_cast<uint32_t>(known.count++));
  Put<uint64_t>(content, time);
  Put<uint64_t>(content, time);
  content.append(bytes);
  Record(chunk_, kMessage, content);
  ++messages_;
  if (chunk_.size() >= kChunk) Flush();
}

void Writer::Keep() {
  Flush();
  failed_ = std::fflush(file_) != 0 || failed_;
  kept_ = true;
}

void Writer::Flush() {
  if (chunk_.empty()) return;
  ChunkIndex index{chunk_start_, chunk_end_, offset_, 0, 0, chunk_.size(), {}};
  std::string content;
  Put<uint64_t>(content, chunk_start_);
  Put<uint64_t>(content, chunk_end_);
  Put<uint64_t>(content, chunk_.size());
  Put<uint32_t>(content, Checksum(chunk_));
  PutText(content, "");  // no compression
  Put<uint64_t>(content, chunk_.size());
  content += chunk_;
  std::string record;
  Record(record, kChunkRecord, content);
  Write(record);
  index.length = record.size();
  const uint64_t indices = offset_;
  for (size_t c = 0; c < channels_.size(); ++c) {
    KnownChannel& channel = channels_[c];
    if (channel.index.empty()) continue;
    index.index_offsets.emplace_back(static_cast<uint16_t>(c), offset_);
    std::string entries;
    Put<uint16_t>(entries, static_cast<uint16_t>(c));
    Put<uint32_t>(entries, static_cast<uint32_t>(channel.index.size() * 16));
    for (const auto& [time, at] : channel.index) {
      Put<uint64_t>(entries, time);
      Put<uint64_t>(entries, at);
    }
    record.clear();
    Record(record, kMessageIndex, entries);
    Write(record);
    channel.index.clear();
  }
  index.index_length = offset_ - indices;
  chunks_.push_back(std::move(index));
  chunk_.clear();
  chunk_start_ = chunk_end_ = 0;
  chunk_has_messages_ = false;
}

base::Result<bool> Writer::Finish() {
  Flush();
  std::string record;
  std::string content;
  Put<uint32_t>(content, sum_);
  Record(record, kDataEnd, content);
  Write(record);
  const uint64_t summary = offset_;
  sum_ = 0;
  std::string offsets;
  const auto group = [&](uint8_t op, uint64_t start) {
    if (offset_ == start) return;
    std::string entry;
    Put<uint8_t>(entry, op);
    Put<uint64_t>(entry, start);
    Put<uint64_t>(entry, offset_ - start);
    Record(offsets, kSummaryOffset, entry);
  };
  uint64_t start = offset_;
  for (size_t i = 0; i < schemas_.size(); ++i) Write(SchemaRecord(static_cast<uint16_t>(i + 1)));
  group(kSchema, start);
  start = offset_;
  for (size_t i = 0; i < channels_.size(); ++i) Write(ChannelRecord(static_cast<uint16_t>(i)));
  group(kChannel, start);
  start = offset_;
  content.clear();
  Put<uint64_t>(content, messages_);
  Put<uint16_t>(content, static_cast<uint16_t>(schemas_.size()));
  Put<uint32_t>(content, static_cast<uint32_t>(channels_.size()));
  Put<uint32_t>(content, 0);  // attachments
  Put<uint32_t>(content, 0);  // metadata
  Put<uint32_t>(content, static_cast<uint32_t>(chunks_.size()));
  Put<uint64_t>(content, first_time_);
  Put<uint64_t>(content, last_time_);
  Put<uint32_t>(content, static_cast<uint32_t>(channels_.size() * 10));
  for (size_t c = 0; c < channels_.size(); ++c) {
    Put<uint16_t>(content, static_cast<uint16_t>(c));
    Put<uint64_t>(content, channels_[c].count);
  }
  record.clear();
  Record(record, kStatistics, content);
  Write(record);
  group(kStatistics, start);
  start = offset_;
  for (const ChunkIndex& chunk : chunks_) {
    content.clear();
    Put<uint64_t>(content, chunk.start_time);
    Put<uint64_t>(content, chunk.end_time);
    Put<uint64_t>(content, chunk.offset);
    Put<uint64_t>(content, chunk.length);
    Put<uint32_t>(content, static_cast<uint32_t>(chunk.index_offsets.size() * 10));
    for (const auto& [channel, at] : chunk.index_offsets) {
      Put<uint16_t>(content, channel);
      Put<uint64_t>(content, at);
    }
    Put<uint64_t>(content, chunk.index_length);
    PutText(content, "");
    Put<uint64_t>(content, chunk.size);
    Put<uint64_t>(content, chunk.size);
    record.clear();
    Record(record, kChunkIndexRecord, content);
    Write(record);
  }
  group(kChunkIndexRecord, start);
  const uint64_t offsets_start = offset_;
  Write(offsets);
  content.clear();
  Put<uint64_t>(content, summary);
  Put<uint64_t>(content, offsets_start);
  // The summary with what this record begins with.
  record.clear();
  Record(record, kFooter, content + std::string(4, '\0'));
  record.resize(record.size() - 4);
  Put<uint32_t>(record, Checksum(record, sum_));
  Write(record);
  Write(kMagic);
  failed_ = std::fclose(std::exchange(file_, nullptr)) != 0 || failed_;
  std::error_code problem;
  if (!failed_) std::filesystem::rename(Partial(path_), path_, problem);
  if (failed_ || problem) {
    std::error_code ignored;
    if (!kept_) std::filesystem::remove(Partial(path_), ignored);
    return base::Error{failed_ ? "the disk may be full" : problem.message()};
  }
  return true;
}

}  // namespace rondo::trace
