#pragma once

#include <cstdint>
#include <string_view>

/// What people write who know other languages, and how Koord says it.
namespace rondo::koord {

/// Names where a word stands.
enum class WordPlace : uint8_t { kItem, kStatement };

/// Returns what to write instead of a word that begins an item or a statement elsewhere, in a sentence; nothing if it is
/// no such word.
std::string_view AlternativeFor(std::string_view word, WordPlace place);

}  // namespace rondo::koord
