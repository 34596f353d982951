#pragma once

#include <string_view>

/// What is around the parts of a program, as `fmt` takes it.
namespace rondo::codegen {

extern const std::string_view kHeader;  ///< the types of a program, and what it offers
extern const std::string_view kSource;  ///< its events, functions and formulas
extern const std::string_view kCore;    ///< the program for who does not know its types

}  // namespace rondo::codegen
