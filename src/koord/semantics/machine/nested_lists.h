#pragma once

#include <span>

#include "koord/semantics/machine/code.h"
#include "koord/semantics/machine/heap.h"

/// Arrays of arrays lie flat in a state; as values they are lists of lists.
namespace rondo::koord::semantics {

/// The list that these words are, as many as the shape has.
Word Pack(Heap& heap, const Shape& shape, std::span<const Word> words);

/// The reverse: writes the words of the list to `to`. False if the list has another shape.
bool Unpack(const Heap& heap, const Shape& shape, Word list, Word* to);

}  // namespace rondo::koord::semantics
