#pragma once

#include <string>
#include <string_view>

#include "workspace/session.h"

namespace rondo::workspace {

/// Says what a file is instead of what is wanted, for people, and what takes it; both empty: it may be what is wanted.
struct OtherKind {
  std::string is;    ///< such as `a PNG picture`
  std::string help;  ///< such as "`rondo replay` and `rondo plot` take it"; may be empty
};

/// Tells by the content; by the end of the name only where languages look alike. Cost: linear in the size of the text.
OtherKind WhatElse(std::string_view path, std::string_view text, Wanted wanted);

}  // namespace rondo::workspace
