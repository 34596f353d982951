#include "choreo/process/labels.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace rondo::choreo {

// The original interpreter found `OK` as `ok` and as `msg_ok`.
bool SameLabel(const std::string& asked, const std::string& given, bool loose) {
  if (asked == given || !loose) return asked == given;
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  const std::string_view bare =
      std::string_view(given).starts_with("msg_") ? std::string_view(given).substr(4) : given;
  return std::ranges::equal(asked, bare, same);
}

}  // namespace rondo::choreo
