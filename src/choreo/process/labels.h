#pragma once

#include <string>

/// Compares labels of messages.
namespace rondo::choreo {

/// Reports whether a process that gives a label means the one that is asked for. Where names are loose, as the original
/// interpreter had them, case does not matter, nor a `msg_` in front of the given one.
bool SameLabel(const std::string& asked, const std::string& given, bool loose);

}  // namespace rondo::choreo
