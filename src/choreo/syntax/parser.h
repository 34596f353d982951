#pragma once

#include "choreo/syntax/ast.h"
#include "diag/diagnostic.h"
#include "lang/lexer.h"

namespace rondo::choreo {

/// Adds the items of a `.rondo` file to `module`. Reports every syntax error, one for each cause; what could
/// not be read is left out. Never fails, whatever the bytes.
void Parse(const diag::SourceSet& sources, diag::FileId file, Module& module, diag::Diagnostics& diagnostics);

/// How `.rondo` files are cut into tokens.
lang::LexerOptions RondoLexer();

/// Words that cannot name anything, units among them.
bool IsReservedWord(std::string_view word);

}  // namespace rondo::choreo
