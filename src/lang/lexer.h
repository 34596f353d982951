#pragma once

#include "diag/diagnostic.h"
#include "lang/token.h"

/// Texts as tokens, for all of Rondo's languages but SMT-LIB.
namespace rondo::lang {

/// Says in what the languages differ.
struct LexerOptions {
  /// Asks for kNewline, kIndent and kDedent; off for languages with braces.
  bool indentation = true;
  bool bar = false;        ///< whether `|` is a sign of its own
  bool prime = false;      ///< whether `'` is a sign of its own, as in `x' = v`
  bool at = false;         ///< whether `@` is a sign
  bool doubles = false;    ///< whether every number with a fraction must be near a double
  bool half_open = false;  ///< whether `)` may close `[`, as in `[0, inf)`
};

/// Returns the tokens of a file. Never fails: bad input is reported and skipped, and the indentation tokens
/// are balanced.
///
/// Lines join inside ( ) [ ] and { } and after a `\`. Lines that are blank or only a comment do not count. A
/// tab in the indentation counts up to the next multiple of 8, with a warning.
TokenStream Lex(const diag::SourceSet& sources, diag::FileId file, const LexerOptions& options,
                diag::Diagnostics& diagnostics);

}  // namespace rondo::lang
