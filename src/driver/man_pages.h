#pragma once

#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

/// Writes what the help says as manual pages.
namespace rondo::driver {

/// Returns the pages of the program and of all its verbs, for section 1 of the manual, each with the name of its file:
/// `rondo-prove.1`.
std::vector<std::pair<std::string, std::string>> ManPages(const CLI::App& app);

}  // namespace rondo::driver
