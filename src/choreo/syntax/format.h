#pragma once

#include <string>

#include "diag/diagnostic.h"
#include "lang/token.h"

/// Formats `.rondo` files.
namespace rondo::choreo {

/// Returns the canonical text of a `.rondo` file: the same tokens and comments on the same lines, with one
/// way to indent and to put blanks. Lines are where their author broke them; of several empty lines one is
/// kept. Formatting twice changes nothing more. Requires a stream without errors.
std::string Format(const diag::SourceSet& sources, diag::FileId file, const lang::TokenStream& stream);

/// Returns the tokens and comments of a `.rondo` file; reports what is no token.
lang::TokenStream Tokens(const diag::SourceSet& sources, diag::FileId file, diag::Diagnostics& diagnostics);

}  // namespace rondo::choreo
