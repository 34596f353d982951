#include "runs/base64.h"

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/binary_from_base64.hpp>
#include <boost/archive/iterators/transform_width.hpp>

namespace rondo::runs {

namespace it = boost::archive::iterators;

std::string ToBase64(const std::string& bytes) {
  using Encoded = it::base64_from_binary<it::transform_width<std::string::const_iterator, 6, 8>>;
  std::string text(Encoded(bytes.begin()), Encoded(bytes.end()));
  return text.append((3 - bytes.size() % 3) % 3, '=');
}

std::optional<std::string> FromBase64(std::string text) {
  using Decoded = it::transform_width<it::binary_from_base64<std::string::const_iterator>, 8, 6>;
  while (!text.empty() && text.back() == '=') text.pop_back();
  const size_t size = text.size() * 6 / 8;
  text.append((4 - text.size() % 4) % 4, 'A');  // the iterators read whole groups
  try {
    std::string bytes(Decoded(text.cbegin()), Decoded(text.cend()));
    bytes.resize(size);
    return bytes;
  } catch (const it::dataflow_exception&) {
    return std::nullopt;
  }
}

}  // namespace rondo::runs
