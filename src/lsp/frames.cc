#include "lsp/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>

namespace rondo::lsp {

namespace {

// What a header says of the length; nothing if it says nothing that makes sense.
std::optional<size_t> LengthIn(std::string_view header) {
  constexpr std::string_view kName = "content-length:";
  std::optional<size_t> length;
  while (!header.empty()) {
    const size_t end = std::min(header.find("\r\n"), header.size());
    const std::string_view line = header.substr(0, end);
    header.remove_prefix(std::min(end + 2, header.size()));
    const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
    if (line.size() <= kName.size() ||
        !std::equal(kName.begin(), kName.end(), line.begin(), [&](char b, char a) { return same(a, b); }))
      continue;
    std::string_view digits = line.substr(kName.size());
    digits.remove_prefix(std::min(digits.find_first_not_of(' '), digits.size()));
    size_t value = 0;
    const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || rest != digits.data() + digits.size()) return std::nullopt;
    length = value;
  }
  return length;
}

}  // namespace

std::optional<std::string> FrameReader::Next() {
  constexpr size_t kMostHeader = 4096;
  if (broken_) return std::nullopt;
  const size_t end = bytes_.find("\r\n\r\n");
  if (end == std::string::npos) {
    broken_ = bytes_.size() > kMostHeader;
    return std::nullopt;
  }
  const auto length = LengthIn(std::string_view(bytes_).substr(0, end));
  if (!length || *length > kMost) {
    broken_ = true;
    return std::nullopt;
  }
  const size_t begin = end + 4;
  if (bytes_.size() - begin < *length) return std::nullopt;
  std::string message = bytes_.substr(begin, *length);
  bytes_.erase(0, begin + *length);
  return message;
}

std::string Framed(std::string_view message) {
  return fmt::format("Content-Length: {}\r\n\r\n{}", message.size(), message);
}

}  // namespace rondo::lsp
