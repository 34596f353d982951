#pragma once

#include <span>

#include "koord/semantics/machine/code.h"
#include "koord/semantics/machine/heap.h"

/// Converts between the two forms of arrays of arrays: flat in a state, lists of lists as values.
namespace rondo::koord::semantics {

/// Returns the handle of the list (of lists) with these words as innermost items; there must be as many as
/// the shape has.
Word Pack(Heap& heap, const Shape& shape, std::span<const Word> words);

/// Writes the innermost words of the list to `to`, which has room for all of the shape. Returns false if the
/// list has another shape; `to` may be partly written then.
bool Unpack(const Heap& heap, const Shape& shape, Word list, Word* to);

}  // namespace rondo::koord::semantics
