#pragma once

#include "choreo/syntax/ast.h"
#include "diag/diagnostic.h"
#include "lang/lexer.h"

/// Reads `.rondo` files.
namespace rondo::choreo {

/// Adds the items of a `.rondo` file to `module`. Reports every syntax error, one for each cause; what could
/// not be read is left out. Never fails, whatever the bytes.
void Parse(const diag::SourceSet& sources, diag::FileId file, Module& module, diag::Diagnostics& diagnostics);

/// Returns how `.rondo` files are cut into tokens.
lang::LexerOptions RondoLexer();

/// Reports whether the word, a unit perhaps, is reserved, so that it cannot name anything.
bool IsReservedWord(std::string_view word);

}  // namespace rondo::choreo
