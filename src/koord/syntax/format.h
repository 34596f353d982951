#pragma once

#include <string>

#include "diag/source.h"
#include "koord/syntax/ast.h"

/// Prints Koord programs.
namespace rondo::koord {

/// Returns the canonical text of a program: four blanks, one spelling for each thing, comments kept where
/// they stand. Parsing it gives the same program, and formatting it again the same text. Requires a program
/// that parsed without errors.
std::string Format(const diag::SourceSet& sources, const Program& program);

/// Returns the program without comments and positions, so that two programs can be compared: equal for
/// programs that mean the same text.
std::string Skeleton(const Program& program);

}  // namespace rondo::koord
