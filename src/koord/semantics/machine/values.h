#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "koord/check/model.h"
#include "koord/semantics/machine/heap.h"
#include "koord/semantics/machine/layout.h"

/// Converts values between words, text for people, and JSON for files.
namespace rondo::koord::semantics {

/// Returns a value as text: `(1, 2, 0.5)`, `[a, b]`, `true`; floats in the shortest form that reads back as
/// the same number.
std::string Show(const lang::TypeTable& types, const Heap& heap, TypeId type, std::span<const Word> words);

/// Returns the text of a variable as it lies in a state, with its arrays item by item.
std::string Show(const lang::TypeTable& types, const Heap& heap, const Layout::Place& place,
                 std::span<const Word> words);

/// Returns a value as JSON: numbers, truth values, texts, names of members, objects by field, lists. What
/// only functions look into is a list of 64-bit words.
nlohmann::json ToJson(const lang::TypeTable& types, const Heap& heap, TypeId type,
                      std::span<const Word> words);

nlohmann::json ToJson(const lang::TypeTable& types, const Heap& heap, const Layout::Place& place,
                      std::span<const Word> words);

/// Reads such JSON as a value of the type, and stores its lists and texts in the heap. Returns nullopt if it
/// is no value of the type.
std::optional<std::vector<Word>> FromJson(const lang::TypeTable& types, Heap& heap, TypeId type,
                                          const nlohmann::json& json);

/// Orders values of one type by what they are, whatever handles their lists and texts have: negative if the first comes
/// first, 0 if they are equal.
int Compare(const lang::TypeTable& types, const Heap& heap, TypeId type, Word a, Word b);

/// Calls `mark` for each handle in a value, and in what it refers to.
void MarkHandles(const lang::TypeTable& types, Heap& heap, TypeId type, std::span<const Word> words);

}  // namespace rondo::koord::semantics
