#pragma once

#include <algorithm>
#include <functional>
#include <span>
#include <vector>

#include "koord/semantics/machine/code.h"
#include "koord/semantics/machine/layout.h"

/// Keeps what the instructions of the machine work with, and helps that they share.
namespace rondo::koord::semantics {

class Host;

/// Remembers what was at an address before the run that goes on wrote it for the first time.
struct Write {
  uint32_t at;
  Word before;
};

/// Names a variable, or a cell of an array, that every robot may write: its address in the state and its
/// number of words. Last writers are told apart by unit.
struct Unit {
  uint32_t at;
  uint32_t width;
  friend bool operator==(Unit, Unit) = default;
};

/// Is a value that a run wrote to a stream, of a log type (`Team::ShowLogged`).
inline constexpr size_t kPlainText = SIZE_MAX;  ///< stands for a log type: what was written is text already
struct Said {
  size_t type;
  std::vector<Word> value;
};

/// Holds what a machine keeps from one run to the next, and what a run leaves behind.
struct MachineState {
  const Code& code;
  const Layout& layout;
  Heap& heap;
  Host* host = nullptr;
  std::function<std::string(size_t, std::span<const Word>)> show = {};
  std::function<uint64_t(uint64_t)> chooser = {};
  std::vector<Word> params = {};
  Word* memory = nullptr;
  const Word* old = nullptr;
  std::vector<uint32_t> calls = {};  ///< where to return to
  std::vector<Word> buffer = {};     ///< of a list that is being made
  std::vector<Write> writes = {};
  std::vector<Unit> units = {};
  std::vector<Said> said = {};
  std::vector<uint32_t> logged = {};  ///< by address: the run that wrote it last
  uint32_t run = 0;
  std::vector<bool> marks = {};
  bool used_default = false;
  bool keep_said = false;
  bool locked = false;
  bool lock_taken = false;
  bool stopped = false;
  bool check_summaries = false;
  bool in_summary = false;
  int violated_summary = -1;
};

/// Holds what the instructions of one run work with. It is a local variable of the loop, so that compilers
/// keep it in registers: every function that takes it is inlined there.
struct Registers {
  MachineState& m;
  Word* top;           ///< the first free word of the stack
  Word* frame;         ///< local variables and parameters of functions
  const Word* memory;  ///< the state that is read: that of now, or that at the end of the program transition
  uint32_t own;        ///< the address at which the robot's block begins
  size_t robot;
  bool total;  ///< operations without a value have the value zero
  uint64_t steps = 0;
  const Instruction* next;
};

/// Marks the functions of instructions. Each returns kNone, or why the run cannot go on.
#define RONDO_INSTRUCTION [[gnu::always_inline]] inline Fault

/// Ends an instruction that has no value; in a formula it has the value zero, which the caller pushes.
#define RONDO_TOTAL(what)                \
  do {                                   \
    if (!r.total) return Fault::k##what; \
    r.m.used_default = true;             \
  } while (false)

/// Bounds the length of lists, in items, and of texts, in bytes.
inline constexpr size_t kLongestList = 1'000'000;
/// Bounds the iterations of loops and calls of functions in one run, both together.
inline constexpr uint64_t kMostSteps = 100'000'000;

/// Returns a double as a word. Zero gets one sign, so that equal numbers are equal words.
inline Word FloatWord(double x) { return FromFloat(x + 0.0); }

/// Pushes `words` words.
inline void Push(Registers& r, const Word* from, uint32_t words) {
  for (uint32_t k = 0; k < words; ++k) *r.top++ = from[k];
}

/// Pushes `words` zeros, the value of what has none.
inline void PushZeros(Registers& r, uint32_t words) {
  for (uint32_t k = 0; k < words; ++k) *r.top++ = 0;
}

}  // namespace rondo::koord::semantics
