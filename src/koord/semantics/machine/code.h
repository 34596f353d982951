#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "diag/source.h"
#include "koord/semantics/machine/heap.h"

/// Defines the compiled form of a program: instructions of a stack machine over words. A value of a type
/// occupies as many words as `Layout::Width` says, the first one deepest.
namespace rondo::koord::semantics {

/// Names the instructions; `ops.def` says what each one does with its operands.
enum class Op : uint8_t {
  kEnd,  ///< ends the code of an entry, and so the run
#define RONDO_OP(name) k##name,
#include "koord/semantics/machine/ops.def"
#undef RONDO_OP
};

/// Says why a run cannot be completed.
enum class Fault : uint8_t {
  kNone,
  kIndex,     ///< an index out of range
  kDivision,  ///< a division by zero
  kRoot,      ///< the root of a negative number
  kRemove,    ///< `remove` of an item that is not in the list
  kReturn,    ///< a function that ends without returning a value
  kOverflow,  ///< an int beyond 64 bits, or a float that is not finite
  kExternal,  ///< an external function that has no value there
  kGrid,      ///< a grid whose step is not positive
  kNoValue,   ///< an empty set of values to choose from
  kTooLong,   ///< a list or grid of more than a million items
  kTooMany,   ///< more choices of `any` than are followed
  kNoLock,    ///< no fault: another robot holds the lock of the event, which is a skip then
  kNotYet,    ///< no fault: an external function is not finished, which is a skip then
  kLoop,      ///< a `while` that is repeated more often than it says
  kRunaway,   ///< more than a hundred million iterations and calls (`kMostSteps`)
};
/// Returns the fault in words, for messages.
std::string_view Describe(Fault fault);

/// Holds one instruction; what its operands mean depends on `op`.
struct Instruction {
  Op op = Op::kEnd;
  uint32_t a = 0;
  uint32_t b = 0;
  uint32_t c = 0;
  uint32_t d = 0;
};

/// Describes an array whose items may be arrays: the lengths, the outer one first, and the number of words of
/// an innermost item.
struct Shape {
  std::vector<uint32_t> dimensions;
  uint32_t width = 1;
};

/// Holds the code of all events, functions and formulas of one team.
struct Code {
  std::vector<Instruction> instructions;
  std::vector<diag::Span> spans;  ///< by instruction: where in the program it comes from
  std::vector<Word> constants;
  std::vector<Shape> shapes;
  std::vector<uint32_t> function_entry;  ///< by function: its first instruction; 0 for external ones
  uint32_t frame_words = 0;
  bool rounded_literals = false;  ///< some number in the program is no double, and was rounded to one
};

}  // namespace rondo::koord::semantics
