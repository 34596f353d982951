#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diag/source.h"

/// What lexers hand to parsers.
namespace rondo::lang {

/// Says what a token is. kNewline, kIndent and kDedent appear only in languages that end lines and indent.
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

/// Is a word, number, sign or text. `text` is the canonical spelling: `<=` also for the sign U+2264. It
/// points into the source or at a constant.
struct Token {
  TokenKind kind;
  diag::Span span;
  std::string_view text;
};

/// Is a comment with its `#` or `//`; formatters put it back.
struct Comment {
  diag::Span span;
  uint32_t line;     ///< 1-based
  bool alone;        ///< whether nothing but blanks stands before it on its line
  std::string text;  ///< without the mark, trimmed
};

/// Holds the tokens and the comments of a file, each in order.
struct TokenStream {
  std::vector<Token> tokens;  ///< ends in kEnd
  std::vector<Comment> comments;
};

/// Returns what people call this token in a message: "`)`", "the end of the line", "a deeper line".
std::string Describe(const Token& token);

}  // namespace rondo::lang
