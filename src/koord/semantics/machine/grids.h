#pragma once

#include <limits>

#include "koord/semantics/machine/numbers.h"

/// Carries out the instructions that make sets of values (grids) and choose one value of a set (`any`).
namespace rondo::koord::semantics {

RONDO_INSTRUCTION RunAnyItem(Registers& r, const Instruction& i) {
  const auto items = r.m.heap[*--r.top];
  if (items.empty()) return Fault::kNoValue;
  const size_t item = r.m.chooser ? r.m.chooser(items.size() / i.a) : 0;
  for (uint32_t w = 0; w < i.a; ++w) *r.top++ = items[item * i.a + w];
  return Fault::kNone;
}

RONDO_INSTRUCTION RunAnyInt(Registers& r, const Instruction&) {
  const int64_t high = ToInt(*--r.top);
  const int64_t low = ToInt(r.top[-1]);
  if (low > high) return Fault::kNoValue;
  const uint64_t above = static_cast<uint64_t>(high) - static_cast<uint64_t>(low);
  if (above == std::numeric_limits<uint64_t>::max()) return Fault::kTooMany;
  if (r.m.chooser) r.top[-1] = static_cast<Word>(static_cast<uint64_t>(low) + r.m.chooser(above + 1));
  return Fault::kNone;
}

RONDO_INSTRUCTION RunGridInt(Registers& r, const Instruction&) {
  r.top -= 2;
  const int64_t low = ToInt(r.top[-1]);
  const int64_t high = ToInt(r.top[0]);
  const int64_t step = ToInt(r.top[1]);
  if (step <= 0) return Fault::kGrid;
  r.m.buffer.clear();
  for (int64_t x = low; x <= high;) {
    r.m.buffer.push_back(FromInt(x));
    if (r.m.buffer.size() > kLongestList) return Fault::kTooLong;
    if (__builtin_add_overflow(x, step, &x)) break;
  }
  r.top[-1] = r.m.heap.Intern(r.m.buffer);
  return Fault::kNone;
}

/// Pops the least values, the largest values (of one or three axes) and the step; pushes the list of points
/// between, the last axis fastest. A point that rounding puts just behind the end belongs to the grid.
inline Fault MakeGrid(Registers& r, ptrdiff_t axes) {
  const double step = ToFloat(*--r.top);
  r.top -= 2 * axes;
  if (!(step > 0)) return Fault::kGrid;
  size_t count[3] = {1, 1, 1};
  double low[3] = {0, 0, 0};
  for (int k = 0; k < axes; ++k) {
    low[k] = ToFloat(r.top[k]);
    // A point that rounding puts just behind the end belongs to the grid.
    const double steps = std::floor((ToFloat(r.top[k + axes]) - low[k]) / step + 1e-9);
    if (!(steps < static_cast<double>(kLongestList))) return Fault::kTooLong;
    count[k] = steps < 0 ? 0 : static_cast<size_t>(steps) + 1;
  }
  if (count[0] * count[1] > kLongestList || count[0] * count[1] * count[2] > kLongestList)
    return Fault::kTooLong;
  r.m.buffer.clear();
  for (size_t x = 0; x < count[0]; ++x) {
    for (size_t y = 0; y < count[1]; ++y) {
      for (size_t z = 0; z < count[2]; ++z) {
        const size_t point[3] = {x, y, z};
        for (int k = 0; k < axes; ++k)
          r.m.buffer.push_back(FloatWord(low[k] + static_cast<double>(point[k]) * step));
      }
    }
  }
  *r.top++ = r.m.heap.Intern(r.m.buffer);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunGridFloat(Registers& r, const Instruction&) { return MakeGrid(r, 1); }

RONDO_INSTRUCTION RunGridPos(Registers& r, const Instruction&) { return MakeGrid(r, 3); }

}  // namespace rondo::koord::semantics
