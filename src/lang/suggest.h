#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rondo::lang {

/// The candidate most like `name`, if one is so near that a typo is likely; else empty.
std::string Suggest(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace rondo::lang
