#pragma once

#include <functional>
#include <string>

#include "base/result.h"

/// Makes traces again, to compare them.
namespace rondo::runs {

/// Returns the bytes of what `write` writes to the file that it is given. @error if it cannot be written.
base::Result<std::string> CopyOf(const std::function<base::Result<bool>(const std::string& path)>& write);

/// Says in words where two traces differ first.
std::string FirstDifference(std::string_view a, std::string_view b);

}  // namespace rondo::runs
