#include "koord/semantics/machine/code.h"

namespace rondo::koord::semantics {

std::string_view Describe(Fault fault) {
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
    case Fault::kGrid:
      return "the step of a grid must be positive";
    case Fault::kNoValue:
      return "there is no value in this list";
    case Fault::kTooLong:
      return "the list has more than a million items";
    case Fault::kTooMany:
      return "there are more than 100,000 ways to choose";
    case Fault::kNoLock:
      return "another robot holds the lock";
    case Fault::kNotYet:
      return "the function is not finished";
    case Fault::kLoop:
      return "the loop is repeated more often than it says";
    case Fault::kRunaway:
      return "this runs for more than a hundred million steps";
  }
  return "";
}

}  // namespace rondo::koord::semantics
