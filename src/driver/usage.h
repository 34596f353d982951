#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

/// Meets what was mistyped on the command line.
namespace rondo::driver {

/// Returns the verb of this name; nullptr if there is none.
const CLI::App* FindVerb(const CLI::App& app, const std::string& name);

/// Says that there is no verb of this name, and which one was perhaps meant.
std::string NoSuchVerb(const CLI::App& app, const std::string& name);

/// Says which of the arguments are options that the verb does not have, and which ones were perhaps meant; empty if none is.
std::string NoSuchOption(const CLI::App& app, const std::vector<std::string>& arguments);

}  // namespace rondo::driver
