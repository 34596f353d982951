#include "ros/cdr.h"

#include <algorithm>

namespace rondo::ros {

CdrReader::CdrReader(std::string_view bytes) {
  ok_ = bytes.size() >= 4 && bytes[0] == 0 && (bytes[1] == 0 || bytes[1] == 1);
  if (!ok_) return;
  swap_ = bytes[1] == 0;
  bytes_ = bytes.substr(4);
}

void CdrReader::Take(char* out, size_t size) {
  const size_t at = (at_ + size - 1) / size * size;
  if (!ok_ || at > bytes_.size() || bytes_.size() - at < size) {
    ok_ = false;
    return;
  }
  std::memcpy(out, bytes_.data() + at, size);
  if (swap_) std::reverse(out, out + size);
  at_ = at + size;
}

void CdrReader::Value(std::string& text, size_t most) {
  text.clear();
  const size_t count = Count(1);
  // Some write an empty text without the zero.
  if (!ok_ || count == 0) return;
  ok_ = bytes_[at_ + count - 1] == '\0' && count - 1 <= most;
  if (ok_) text = bytes_.substr(at_, count - 1);
  at_ += count;
}

size_t CdrReader::Count(size_t size) {
  uint32_t count = 0;
  Value(count);
  if (ok_ && count <= (bytes_.size() - at_) / size) return count;
  ok_ = false;
  return 0;
}

}  // namespace rondo::ros
