#pragma once

#include <string>
#include <string_view>

#include "base/result.h"

/// Makes pages that show runs.
namespace rondo::runs {

/// Returns the page of the viewer, without a run in it; empty: Rondo was built without it.
std::string_view ViewerPage();

/// Returns a page that shows a trace (MCAP), in a browser, without a network or any other file: the bytes stand in it packed
/// (gzip, base64). `name`: of the file, for people.
/// @error if Rondo was built without the viewer, or the trace cannot be packed.
base::Result<std::string> PageOf(std::string_view name, std::string_view trace);

}  // namespace rondo::runs
