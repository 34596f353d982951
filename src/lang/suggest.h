#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Suggestions for names that were perhaps mistyped.
namespace rondo::lang {

/// Returns the candidate most like `name`, if one is so near that a typo is likely; else nothing. Measured by
/// letters that are wrong, missing, too many, or exchanged with their neighbour, a change of case being free: at most 1 for names of up to three letters, else `most`.
std::string Suggest(std::string_view name, const std::vector<std::string>& candidates, size_t most = 2);

}  // namespace rondo::lang
