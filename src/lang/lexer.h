#pragma once

#include "diag/diagnostic.h"
#include "lang/token.h"

namespace rondo::lang {

struct LexerOptions {
  bool indentation = true;  ///< emit kNewline, kIndent and kDedent; off for languages with braces
  bool bar = false;         ///< is `|` a sign of its own?
  bool prime = false;       ///< is `'` a sign of its own, as in `x' = v`?
  bool at = false;          ///< is `@` a sign?
  bool doubles = false;     ///< must every number with a fraction be near a double?
  bool half_open = false;   ///< may `)` close `[`, as in `[0, inf)`?
};

/// The tokens of a file. Never fails: bad input is reported and skipped, and the indentation tokens are
/// balanced.
///
/// Lines join inside ( ) [ ] and { } and after a `\`. Lines that are blank or only a comment do not count. A
/// tab in the indentation counts up to the next multiple of 8, with a warning.
TokenStream Lex(const diag::SourceSet& sources, diag::FileId file, const LexerOptions& options,
                diag::Diagnostics& diagnostics);

}  // namespace rondo::lang
