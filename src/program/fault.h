#pragma once

#include <cstdint>
#include <string_view>

/// What programs that were made by `rondo build` stand on. These headers need nothing but the standard library, take no memory
/// while a program runs and throw nothing.
namespace rondo::program {

/// Says why an event cannot be completed (docs/language.md, "Operations without a value").
enum class Fault : uint8_t {
  kNone,
  kIndex,     ///< an index out of range
  kDivision,  ///< a division by zero
  kRoot,      ///< the root of a negative number
  kRemove,    ///< `remove` of an item that is not in the list
  kReturn,    ///< a function that ends without returning a value
  kOverflow,  ///< an int beyond 64 bits, or a float that is not finite
  kExternal,  ///< an external function that has no value there
  kNoValue,   ///< an empty set of values to choose from
  kTooLong,   ///< a list or text beyond its capacity
  kTooMany,   ///< more choices of `any` than there are numbers
  kNotYet,    ///< no fault: an external function is not finished, which is a skip then
  kLoop,      ///< a `while` that is repeated more often than it says
  kRunaway,   ///< more than a hundred million iterations and calls
};

/// Returns the fault in words, for messages.
constexpr std::string_view Describe(Fault fault) {
  switch (fault) {
    case Fault::kNone:
      return "nothing";
    case Fault::kIndex:
      return "the index is out of range";
    case Fault::kDivision:
      return "the divisor is zero";
    case Fault::kRoot:
      return "the root of a negative number";
    case Fault::kRemove:
      return "the item is not in the list";
    case Fault::kReturn:
      return "the function ends without a value";
    case Fault::kOverflow:
      return "the number is too large";
    case Fault::kExternal:
      return "the function has no value here";
    case Fault::kNoValue:
      return "there is no value in this list";
    case Fault::kTooLong:
      return "the list or text is longer than its capacity";
    case Fault::kTooMany:
      return "there are too many ways to choose";
    case Fault::kNotYet:
      return "the function is not finished";
    case Fault::kLoop:
      return "the loop is repeated more often than it says";
    case Fault::kRunaway:
      return "this runs for more than a hundred million steps";
  }
  return "";
}

/// Is a place in the Koord source: a line and a column, both from 1, and how many bytes from there. `file` 0 is the program, 1 its
/// specification.
struct Place {
  uint32_t line = 0;
  uint32_t column = 0;
  uint32_t length = 0;
  uint32_t file = 0;

  friend constexpr bool operator==(const Place&, const Place&) = default;
};

}  // namespace rondo::program
