#include "lsp/names.h"

#include <algorithm>
#include <cctype>

#include "lang/lexer.h"

namespace rondo::lsp {

namespace {

bool InWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

}  // namespace

std::pair<size_t, size_t> WordAround(std::string_view text, size_t at) {
  size_t begin = at, end = at;
  while (begin > 0 && InWord(text[begin - 1])) --begin;
  while (end < text.size() && InWord(text[end])) ++end;
  return {begin, end};
}

bool IsName(std::string_view text) {
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text[0])) == 0 &&
         std::ranges::all_of(text, InWord);
}

std::vector<diag::Span> Occurrences(const diag::SourceSet& sources, diag::FileId file,
                                    std::string_view word) {
  // Signs of all languages: they only matter between words.
  lang::LexerOptions options;
  options.indentation = false;
  options.bar = options.prime = options.at = options.half_open = true;
  diag::Diagnostics ignored;
  std::vector<diag::Span> found;
  for (const lang::Token& token : lang::Lex(sources, file, options, ignored).tokens) {
    if (token.kind == lang::TokenKind::kName && token.text == word) found.push_back(token.span);
  }
  return found;
}

}  // namespace rondo::lsp
