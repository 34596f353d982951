#pragma once

#include <string>
#include <string_view>

namespace rondo::lsp {

/// Converts the address of a file (`file:///a%20b`) to its path, and back. Addresses of something else stay what they are, as names.
std::string PathOf(std::string_view uri);
std::string UriOf(std::string_view path);

}  // namespace rondo::lsp
