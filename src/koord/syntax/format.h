#pragma once

#include <string>

#include "diag/source.h"
#include "koord/syntax/ast.h"

namespace rondo::koord {

/// The canonical text of a program: four blanks, one spelling for each thing, comments kept where they stand.
/// Parsing it gives the same program, and formatting it again the same text. Requires a program that parsed
/// without errors.
std::string Format(const diag::SourceSet& sources, const Program& program);

/// The program without comments and positions: equal for programs that mean the same text.
std::string Skeleton(const Program& program);

}  // namespace rondo::koord
