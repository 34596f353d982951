#pragma once

#include <string>

#include "base/result.h"

namespace rondo::driver {

/// Writes a page that shows a trace, a log or a saved run (`rondo view`). `page`: where; empty: beside it.
/// @return the path of the page. @error in words.
base::Result<std::string> WritePage(const std::string& trace, const std::string& page);

/// Shows a file with whatever the desktop has for it. Returns false if there is nothing.
bool OpenInBrowser(const std::string& path);

/// Returns a file for a trace that nobody named, but wants to see: in a folder of its own, which stays. Empty, and told, if
/// there is no room for it.
std::string PlaceForTrace();

/// Writes the page of a trace, if there is one, shows it, and says so; what is wrong is told, and changes no status.
void ShowTrace(const std::string& trace, bool json);

}  // namespace rondo::driver
