#pragma once

#include "koord/semantics/machine/layout.h"
#include "runtime/codec/bytes.h"

/// Encodes values of programs for other robots, without handles: equal values are equal bytes.
namespace rondo::koord::node {

using semantics::Heap;
using semantics::Word;

/// Appends a value of the type.
void EncodeValue(const lang::TypeTable& types, const Heap& heap, TypeId type, std::span<const Word> words,
                 runtime::codec::Writer& writer);

/// Reads a value of the type and appends its words; lists and texts go to the heap. The reader fails on
/// anything that no value of the type is: members that the enumeration does not have, floats that are not
/// finite, lists of more than a million items, more than 32 levels.
void DecodeValue(const lang::TypeTable& types, Heap& heap, TypeId type, runtime::codec::Reader& reader,
                 std::vector<Word>& words, int level = 0);

/// Appends what a value became that was another one before: of lists, only the items that are not as they were, so
/// that a long list to which something is appended is a short change.
void EncodeChange(const lang::TypeTable& types, const Heap& heap, TypeId type, std::span<const Word> before,
                  std::span<const Word> after, runtime::codec::Writer& writer);

/// Reads that, as `DecodeValue` does. The reader fails on what is no change of that value, too.
void DecodeChange(const lang::TypeTable& types, Heap& heap, TypeId type, std::span<const Word> before,
                  runtime::codec::Reader& reader, std::vector<Word>& words);

}  // namespace rondo::koord::node
