#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Suggestions for names that were perhaps mistyped.
namespace rondo::lang {

/// Returns the candidate most like `name`, if one is so near that a typo is likely; else nothing. Measured by
/// Levenshtein's distance, a change of case being free: at most 1 for names of up to three letters, else 2.
std::string Suggest(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace rondo::lang
