#pragma once

#include <optional>
#include <string>

namespace rondo::runs {

/// Return bytes as text (RFC 4648, with `=`), and back: nothing if the text is none.
std::string ToBase64(const std::string& bytes);
std::optional<std::string> FromBase64(std::string text);

}  // namespace rondo::runs
