#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "diag/source.h"

/// Words of files, as far as they are told apart without knowing what they mean.
namespace rondo::lsp {

/// Returns the bytes of the word around a place of a text: from, and behind it.
std::pair<size_t, size_t> WordAround(std::string_view text, size_t at);

/// Reports whether a text is one word that could be a name.
bool IsName(std::string_view text);

/// Returns where a word stands in a file: not in comments and texts, nor as a part of other words.
std::vector<diag::Span> Occurrences(const diag::SourceSet& sources, diag::FileId file, std::string_view word);

}  // namespace rondo::lsp
