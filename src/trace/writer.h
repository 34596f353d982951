#pragma once

#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

/// Records of runs, as files that the usual tools of robotics can open.
namespace rondo::trace {

/// Says how the messages of a channel are written. Its texts must outlive the writer.
struct Schema {
  std::string_view name;       ///< such as `geometry_msgs/msg/PoseStamped`; empty: they say it themselves
  std::string_view encoding;   ///< of `text`: `ros2msg` or `jsonschema`
  std::string_view text;       ///< the definition itself
  std::string_view hash = {};  ///< of types of ROS: RIHS01
};

/// Is for what Rondo itself says of a run: any JSON object, on the topics `/rondo/...`.
/// Without a schema: readers of ROS know none but those of messages.
inline constexpr Schema kRecord{"", "", ""};

/// Writes a record of a run as MCAP (MCAP specification, version 0; profile `ros2`): chunks without compression, an index and
/// statistics behind them, so that the usual tools can read and seek, and checksums of all. The same calls give the same bytes.
///
/// The file is written beside its name, with `.partial` behind it, and gets its name in `Finish`; without
/// that, nothing of it stays.
class Writer {
 public:
  /// Begins a file. @error if it cannot be opened, is no regular file, or its folder is not there.
  static base::Result<Writer> Open(const std::string& path);
  Writer(Writer&& other) noexcept;
  Writer& operator=(Writer&&) = delete;
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer();

  /// Returns the number of a channel. `encoding`: of the messages, `cdr` or `json`.
  uint16_t Channel(const std::string& topic, const Schema& schema, const std::string& encoding);
  /// Adds a message. `time`: nanoseconds since the start of the run; must not decrease. What cannot be
  /// written is told by `Finish`.
  void Message(uint16_t channel, uint64_t time, std::string_view bytes);
  /// Puts what was said so far where a crash of this process does not reach it: into the `.partial` file, which stays then
  /// if the file cannot be completed.
  void Keep();
  /// Completes the file and gives it its name. @error if anything could not be written.
  base::Result<bool> Finish();
  uint64_t messages() const { return messages_; }

 private:
  explicit Writer(std::string path) : path_(std::move(path)) {}
  struct ChunkIndex {
    uint64_t start_time, end_time, offset, length, index_length, size;
    std::vector<std::pair<uint16_t, uint64_t>> index_offsets;
  };
  struct KnownChannel {
    uint16_t schema;
    std::string topic;
    std::string encoding;
    uint64_t count = 0;
    std::vector<std::pair<uint64_t, uint64_t>> index;  // of this chunk: time and offset
  };
  void Write(std::string_view bytes);
  void Flush();
  static void Record(std::string& out, uint8_t op, std::string_view content);
  std::string SchemaRecord(uint16_t id) const;
  std::string ChannelRecord(uint16_t id) const;

  std::string path_;
  std::FILE* file_ = nullptr;
  bool failed_ = false, kept_ = false;
  uint64_t offset_ = 0;
  uint32_t sum_ = 0;             // CRC-32 of what was written since the file, or its summary, began
  std::vector<Schema> schemas_;  // texts are static
  std::vector<KnownChannel> channels_;
  std::string chunk_;
  uint64_t chunk_start_ = 0;
  uint64_t chunk_end_ = 0;
  bool chunk_has_messages_ = false;
  std::vector<ChunkIndex> chunks_;
  uint64_t messages_ = 0;
  uint64_t first_time_ = 0;
  uint64_t last_time_ = 0;
};

}  // namespace rondo::trace
