#pragma once

#include "diag/diagnostic.h"
#include "koord/syntax/ast.h"

/// Reads Koord programs and specifications.
namespace rondo::koord {

/// Adds the items of `file` to `program`. Reports every syntax error of the file, one for each cause; what
/// could not be read is left out. Never fails, whatever the bytes.
void Parse(const diag::SourceSet& sources, diag::FileId file, Program& program,
           diag::Diagnostics& diagnostics);

/// Reports whether the word is reserved, so that it cannot name anything.
bool IsReservedWord(std::string_view word);

}  // namespace rondo::koord
