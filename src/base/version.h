#pragma once

#include <string_view>

/// Which version of Rondo this is, for `rondo --version` and for what is written down.
namespace rondo::base {

/// Returns the version of the project, such as `0.2.0`: that of `project()` in CMakeLists.txt, its only
/// place.
std::string_view Version();

/// Returns the commit that was built, with `+` if files were changed since; empty if the sources are no
/// repository.
std::string_view Commit();

}  // namespace rondo::base
