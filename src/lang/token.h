#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diag/source.h"

namespace rondo::lang {

enum class TokenKind : uint8_t {
  kEnd,
  kNewline,
  kIndent,
  kDedent,
  kName,
  kInt,
  kFloat,
  kString,
  kPunctuation
};

/// `text` is the canonical spelling: `<=` also for the sign U+2264. It points into the source or at a
/// constant.
struct Token {
  TokenKind kind;
  diag::Span span;
  std::string_view text;
};

/// A comment with its `#` or `//`; formatters put it back.
struct Comment {
  diag::Span span;
  uint32_t line;     ///< 1-based
  bool alone;        ///< nothing but blanks stands before it on its line
  std::string text;  ///< without the mark, trimmed
};

struct TokenStream {
  std::vector<Token> tokens;  ///< ends in kEnd
  std::vector<Comment> comments;
};

/// What people call this token in a message: "`)`", "the end of the line", "a deeper line".
std::string Describe(const Token& token);

}  // namespace rondo::lang
