#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "diag/source.h"
#include "koord/semantics/machine/heap.h"

/// The flat form of a program: instructions of a stack machine over words. A value of a type occupies as many
/// words as `Layout::Width` says, the first one deepest.
namespace rondo::koord::semantics {

enum class Op : uint8_t {
  kEnd,          // of an entry
  kConstant,     // a: number of the constant
  kPop,          // a words
  kParam,        // push b words of the parameters at a
  kGlobal,       // push b words of the shared memory at a
  kOwn,          // push b words of the robot's block at a
  kCell,         // pop a robot; push b words of its block at a
  kCellArray,    // pop a robot; push the list of c items of b words of its block at a
  kRow,          // push the list of b words at a of every robot's block
  kGlobalArray,  // push the list of c items of b words at a
  kOwnArray,
  kGlobalAt,  // pop an index; push item of b words of the array of c items at a
  kOwnAt,
  kFlatIndex,  // pop index and the index so far: that times a, plus this; less than a
  kPack,       // pop the b words of shape a; push the list of lists that they are
  kUnpack,     // pop a list of shape a; push its b words
  kFrame,      // push b words of the frame at a
  kSetFrame,   // pop b words into the frame at a
  kSetGlobal,  // pop b words into shared memory at a: a write of one variable, or of cells of d words each
  kSetOwn,     // pop b words into the robot's block at a
  kSetParam,
  kSetGlobalAt,  // pop index and value: item of b words of the array of c items at a; d words are one cell
  kSetOwnAt,
  kSetGlobalArray,  // pop a list of c items of b words
  kSetOwnArray,
  kSlice,    // of the top c words, keep b words from a
  kReplace,  // pop a record of c words and a value of b words; push the record with the value at a
  kRobot,    // push the number of the robot
  kAddInt,
  kSubInt,
  kMulInt,
  kDivInt,
  kModInt,
  kNegInt,
  kAbsInt,
  kAddFloat,
  kSubFloat,
  kMulFloat,
  kDivFloat,
  kNegFloat,
  kAbsFloat,
  kToFloat,  // an int at a words below the top
  kSplat,    // a float becomes a point with three equal coordinates
  kAddPos,
  kSubPos,
  kMulPos,
  kDivPos,
  kNegPos,
  kMidPos,
  kDistPos,
  kInRect,
  kLessInt,
  kLessEqualInt,
  kLessFloat,
  kLessEqualFloat,
  kEqual,  // pop two values of a words
  kNot,
  kIsRobot,
  kMinInt,
  kMaxInt,
  kMinFloat,
  kMaxFloat,
  kListMake,    // a items of b words
  kListLength,  // a: words of an item
  kListAt,      // pop index and list; push item of a words
  kListSet,     // pop index, list and value
  kListAppend,  // pop value and list
  kListRemove,
  kListContains,  // pop list and value
  kConcatenate,   // pop two texts
  kShow,          // pop a value of log type a; push its text
  kGridInt,
  kGridFloat,
  kAnyItem,     // pop a list of items of a words; push one of them
  kAnyInt,      // pop low, high; push one of them, or a number between
  kGridPos,     // pop low, high, step; push the list of points
  kJump,        // to a
  kJumpUnless,  // pop; to a if false
  kJumpIf,      // pop; to a if true
  kForNext,     // frame[a] += 1; to c if frame[a] < frame[b]
  kCall,        // function a
  kReturn,
  kExternal,      // function a; b words of arguments, c of result
  kSummaryBegin,  // to a if summaries are not checked, or one is being checked
  kSummaryTest,   // pop; summary a is violated if false
  kSummaryEnd,
  kLock,
  kStop,
  kFault,  // a: Fault
  kOld,    // read the memory of the end of the program transition from here
  kNow,    // ... up to here
  kLog,    // pop a value of log type a
  kMark,   // branch a is taken
};

/// Why an event cannot be completed.
enum class Fault : uint8_t {
  kNone,
  kIndex,     ///< an index out of range
  kDivision,  ///< by zero
  kRemove,    ///< an item that is not in the list
  kReturn,    ///< a function that ends without a value
  kOverflow,  ///< an int beyond 64 bits, or a float that is not finite
  kExternal,  ///< an external function that has no value there
  kGrid,      ///< a step that is not positive
  kNoValue,   ///< a set of values that is empty
  kTooLong,   ///< a list or grid of more than a million items
  kTooMany,   ///< more choices of `any` than are followed
  kNoLock,    ///< no fault: another robot holds the lock of the event, which is a skip then
  kRunaway,   ///< more than a hundred million instructions
};
std::string_view Describe(Fault fault);

struct Instruction {
  Op op = Op::kEnd;
  uint32_t a = 0;
  uint32_t b = 0;
  uint32_t c = 0;
  uint32_t d = 0;
};

/// An array whose items may be arrays: the lengths, the outer one first, and the words of an innermost item.
struct Shape {
  std::vector<uint32_t> dimensions;
  uint32_t width = 1;
};

/// The code of all events, functions and formulas of one team.
struct Code {
  std::vector<Instruction> instructions;
  std::vector<diag::Span> spans;  ///< by instruction
  std::vector<Word> constants;
  std::vector<Shape> shapes;
  std::vector<uint32_t> function_entry;  ///< by function; 0 for external ones
  uint32_t frame_words = 0;
  bool rounded_literals = false;  ///< some number in the program is no double
};

}  // namespace rondo::koord::semantics
