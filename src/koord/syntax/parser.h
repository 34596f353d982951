#pragma once

#include "diag/diagnostic.h"
#include "koord/syntax/ast.h"

namespace rondo::koord {

/// Adds the items of `file` to `program`. Reports every syntax error of the file, one for each cause; what
/// could not be read is left out. Never fails, whatever the bytes.
void Parse(const diag::SourceSet& sources, diag::FileId file, Program& program,
           diag::Diagnostics& diagnostics);

/// Words that cannot name anything.
bool IsReservedWord(std::string_view word);

}  // namespace rondo::koord
