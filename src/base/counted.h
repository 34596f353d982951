#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace rondo::base {

/// Returns a number and what is counted, in the plural unless it is one: `1 robot`, `2 robots`.
inline std::string Counted(uint64_t n, std::string_view what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

}  // namespace rondo::base
