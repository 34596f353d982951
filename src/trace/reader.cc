#include "trace/reader.h"

#include <fmt/format.h>

#include <map>

#include "base/file.h"
#include "trace/bytes.h"

namespace rondo::trace {
namespace {

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);

constexpr size_t kRecordHead = 9;  // bytes: its kind, and its length

class Reader {
 public:
  Reader(std::string_view file, const std::function<bool(const Message&)>& visit, bool left)
      : file_(file), visit_(visit), left_(left) {}

  base::Result<bool> Run() {
    if (!file_.starts_with(kMagic)) return base::Error{"this is not an MCAP file"};
    if (left_) {
      Cursor cursor(file_.substr(kMagic.size()));
      if (!Records(cursor, 0)) return base::Error{problem_};
      return true;
    }
    if (file_.size() < 2 * kMagic.size() || !file_.ends_with(kMagic))
      return base::Error{"the file is cut off: it does not end as an MCAP file does"};
    Cursor cursor(file_.substr(kMagic.size(), file_.size() - 2 * kMagic.size()));
    if (!Records(cursor, 0)) return base::Error{problem_};
    if (!more_) return true;
    if (!ended_) return base::Error{"the file has no end record"};
    if (!Summary(cursor.rest())) return base::Error{problem_};
    return true;
  }

 private:
  bool Bad(std::string_view what, std::string_view rest) {
    const auto at = static_cast<size_t>(rest.data() - file_.data());
    problem_ = fmt::format("{} at byte {}", what, at);
    return false;
  }

  // 0 stands for no checksum.
  static bool Sound(uint32_t sum, std::string_view bytes) { return sum == 0 || Checksum(bytes) == sum; }

  // What lies behind the data: an index, and at the end a footer with a checksum of it.
  bool Summary(std::string_view summary) {
    constexpr size_t kFooter = kRecordHead + 8 + 8 + 4;
    if (summary.size() < kFooter || summary[summary.size() - kFooter] != 0x02)
      return Bad("the footer is damaged", summary);
    Cursor sum(summary.substr(summary.size() - 4));
    return Sound(*sum.Take<uint32_t>(), summary.substr(0, summary.size() - 4)) ||
           Bad("the checksum of the index is another: the file is damaged", summary);
  }

  bool Records(Cursor& cursor, int depth) {
    while (!cursor.empty() && more_ && !ended_) {
      const std::string_view before = cursor.rest();
      const auto op = cursor.Take<uint8_t>();
      const auto size = cursor.Take<uint64_t>();
      const auto content = size ? cursor.Take(*size) : std::nullopt;
      if ((!op || !content) && left_ && depth == 0) return true;
      if (!op || !content) return Bad("a record is cut off", before);
      if (!One(*op, *content, depth)) return problem_.empty() ? Bad("a record is damaged", before) : false;
    }
    return true;
  }

  bool One(uint8_t op, std::string_view content, int depth) {
    Cursor c(content);
    switch (op) {
      case 0x03: {  // schema
        const auto id = c.Take<uint16_t>();
        const auto name = c.TakeText();
        if (!id || !name) return false;
        schemas_[*id] = *name;
        return true;
      }
      case 0x04: {  // channel
        const auto id = c.Take<uint16_t>();
        const auto schema = c.Take<uint16_t>();
        const auto topic = c.TakeText();
        const auto encoding = c.TakeText();
        if (!id || !schema || !topic || !encoding) return false;
        channels_[*id] = {*topic, *encoding, *schema};
        return true;
      }
      case 0x05: {  // message
        const auto id = c.Take<uint16_t>();
        const auto sequence = c.Take<uint32_t>();
        const auto time = c.Take<uint64_t>();
        const auto published = c.Take<uint64_t>();
        if (!id || !sequence || !time || !published) return false;
        const auto channel = channels_.find(*id);
        if (channel == channels_.end()) return false;
        more_ = visit_({channel->second.topic, schemas_[channel->second.schema], channel->second.encoding,
                        *time, c.rest()});
        return true;
      }
      case 0x06: {  // chunk
        if (depth > 0) return false;
        const auto start = c.Take<uint64_t>();
        const auto end = c.Take<uint64_t>();
        const auto size = c.Take<uint64_t>();
        const auto crc = c.Take<uint32_t>();
        const auto compression = c.TakeText();
        const auto length = c.Take<uint64_t>();
        const auto records = length ? c.Take(*length) : std::nullopt;
        if (!start || !end || !size || !crc || !compression || !records) return false;
        if (!compression->empty()) return Bad("a compressed chunk, which Rondo does not read,", content);
        if (!Sound(*crc, *records))
          return Bad("the checksum of a chunk is another: the file is damaged", content);
        Cursor inner(*records);
        return Records(inner, depth + 1);
      }
      case 0x0F: {  // the data ends here; the rest is an index
        const auto sum = c.Take<uint32_t>();
        if (depth > 0 || !sum) return false;
        ended_ = true;
        const auto before = static_cast<size_t>(content.data() - file_.data()) - kRecordHead;
        return Sound(*sum, file_.substr(0, before)) ||
               Bad("the checksum of the data is another: the file is damaged", content);
      }
      default:
        return true;
    }
  }

  struct Channel {
    std::string_view topic;
    std::string_view encoding;
    uint16_t schema = 0;
  };
  std::string_view file_;
  const std::function<bool(const Message&)>& visit_;
  const bool left_;
  std::map<uint16_t, std::string_view> schemas_;
  std::map<uint16_t, Channel> channels_;
  bool more_ = true;
  bool ended_ = false;
  std::string problem_;
};

}  // namespace

base::Result<bool> ForEachMessage(std::string_view file, const std::function<bool(const Message&)>& visit) {
  return Reader(file, visit, false).Run();
}

base::Result<bool> ForEachMessageLeft(std::string_view file,
                                      const std::function<bool(const Message&)>& visit) {
  return Reader(file, visit, true).Run();
}

base::Result<std::string> ReadTrace(const std::string& path) {
  return base::ReadFile(path, uint64_t{4} << 30);
}

}  // namespace rondo::trace
