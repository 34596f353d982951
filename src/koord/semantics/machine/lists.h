#pragma once

#include "koord/semantics/machine/registers.h"

/// Carries out the instructions on lists and texts. These are kept once in the heap and never change: an
/// instruction that changes one makes another, at a cost linear in its length.
namespace rondo::koord::semantics {

RONDO_INSTRUCTION RunListMake(Registers& r, const Instruction& i) {
  const size_t words = static_cast<size_t>(i.a) * i.b;
  r.top -= words;
  const Word list = r.m.heap.Intern({r.top, words});
  *r.top++ = list;
  return Fault::kNone;
}

RONDO_INSTRUCTION RunListFill(Registers& r, const Instruction& i) {
  r.top -= i.b;
  std::vector<Word> items;
  items.reserve(static_cast<size_t>(i.a) * i.b);
  for (uint32_t k = 0; k < i.a; ++k) items.insert(items.end(), r.top, r.top + i.b);
  *r.top++ = r.m.heap.Intern(items);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunListLength(Registers& r, const Instruction& i) {
  r.top[-1] = r.m.heap[r.top[-1]].size() / i.a;
  return Fault::kNone;
}

RONDO_INSTRUCTION RunListAt(Registers& r, const Instruction& i) {
  r.top -= 2;
  const auto items = r.m.heap[r.top[0]];
  const int64_t k = ToInt(r.top[1]);
  const bool inside = k >= 0 && static_cast<uint64_t>(k) < items.size() / i.a;
  if (!inside) RONDO_TOTAL(Index);
  for (uint32_t w = 0; w < i.a; ++w) *r.top++ = inside ? items[static_cast<size_t>(k) * i.a + w] : 0;
  return Fault::kNone;
}

// Below: the value, the list, the index.
RONDO_INSTRUCTION RunListSet(Registers& r, const Instruction& i) {
  r.top -= 2 + i.a;
  const auto items = r.m.heap[r.top[i.a]];
  const int64_t k = ToInt(r.top[i.a + 1]);
  if (k < 0 || static_cast<uint64_t>(k) >= items.size() / i.a) {
    RONDO_TOTAL(Index);
    r.top[0] = r.top[i.a];
    ++r.top;
    return Fault::kNone;
  }
  r.m.buffer.assign(items.begin(), items.end());
  std::copy(r.top, r.top + i.a, r.m.buffer.begin() + k * i.a);
  *r.top++ = r.m.heap.Intern(r.m.buffer);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunListAppend(Registers& r, const Instruction& i) {
  r.top -= i.a;
  const auto items = r.m.heap[r.top[-1]];
  if (items.size() / i.a >= kLongestList) return Fault::kTooLong;
  r.m.buffer.assign(items.begin(), items.end());
  r.m.buffer.insert(r.m.buffer.end(), r.top, r.top + i.a);
  r.top[-1] = r.m.heap.Intern(r.m.buffer);
  return Fault::kNone;
}

/// Returns the index of the first word of the item, `words` words long, that equals the one at `item`; the
/// length of `items` if there is none.
inline size_t FindItem(std::span<const Word> items, const Word* item, uint32_t words) {
  size_t at = 0;
  while (at < items.size() && !std::equal(item, item + words, items.begin() + static_cast<ptrdiff_t>(at)))
    at += words;
  return at;
}

RONDO_INSTRUCTION RunListContains(Registers& r, const Instruction& i) {
  r.top -= i.a;
  const auto items = r.m.heap[r.top[-1]];
  r.top[-1] = FindItem(items, r.top, i.a) < items.size();
  return Fault::kNone;
}

RONDO_INSTRUCTION RunListRemove(Registers& r, const Instruction& i) {
  r.top -= i.a;
  const auto items = r.m.heap[r.top[-1]];
  const size_t at = FindItem(items, r.top, i.a);
  if (at >= items.size()) {
    RONDO_TOTAL(Remove);
    return Fault::kNone;
  }
  r.m.buffer.assign(items.begin(), items.end());
  const auto first = r.m.buffer.begin() + static_cast<ptrdiff_t>(at);
  r.m.buffer.erase(first, first + i.a);
  r.top[-1] = r.m.heap.Intern(r.m.buffer);
  return Fault::kNone;
}

// Below: the list, the index, the item.
RONDO_INSTRUCTION RunListInsert(Registers& r, const Instruction& i) {
  r.top -= 1 + i.a;
  const auto items = r.m.heap[r.top[-1]];
  const int64_t k = ToInt(r.top[0]);
  if (k < 0 || static_cast<uint64_t>(k) > items.size() / i.a) {
    RONDO_TOTAL(Index);
    return Fault::kNone;
  }
  if (items.size() / i.a >= kLongestList) return Fault::kTooLong;
  r.m.buffer.assign(items.begin(), items.end());
  r.m.buffer.insert(r.m.buffer.begin() + k * i.a, r.top + 1, r.top + 1 + i.a);
  r.top[-1] = r.m.heap.Intern(r.m.buffer);
  return Fault::kNone;
}

// Below: the list, the index.
RONDO_INSTRUCTION RunListDrop(Registers& r, const Instruction& i) {
  --r.top;
  const auto items = r.m.heap[r.top[-1]];
  const int64_t k = ToInt(r.top[0]);
  if (k < 0 || static_cast<uint64_t>(k) >= items.size() / i.a) {
    RONDO_TOTAL(Index);
    return Fault::kNone;
  }
  r.m.buffer.assign(items.begin(), items.end());
  r.m.buffer.erase(r.m.buffer.begin() + k * i.a, r.m.buffer.begin() + (k + 1) * i.a);
  r.top[-1] = r.m.heap.Intern(r.m.buffer);
  return Fault::kNone;
}

// Below: the list, the first index, and the one behind the last; without that (b: 1), up to the end.
RONDO_INSTRUCTION RunListSlice(Registers& r, const Instruction& i) {
  r.top -= i.b == 0 ? 2 : 1;
  const auto items = r.m.heap[r.top[-1]];
  const int64_t from = ToInt(r.top[0]);
  const int64_t to = i.b == 0 ? ToInt(r.top[1]) : static_cast<int64_t>(items.size() / i.a);
  if (from < 0 || to < from || static_cast<uint64_t>(to) > items.size() / i.a) {
    RONDO_TOTAL(Index);
    return Fault::kNone;
  }
  r.m.buffer.assign(items.begin() + from * i.a, items.begin() + to * i.a);
  r.top[-1] = r.m.heap.Intern(r.m.buffer);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunConcatenate(Registers& r, const Instruction&) {
  --r.top;
  const std::string text = r.m.heap.Text(r.top[-1]) + r.m.heap.Text(r.top[0]);
  if (text.size() > kLongestList) return Fault::kTooLong;
  r.top[-1] = r.m.heap.InternText(text);
  return Fault::kNone;
}

RONDO_INSTRUCTION RunShow(Registers& r, const Instruction& i) {
  const size_t width = i.b;
  r.top -= width;
  const std::string text = r.m.show ? r.m.show(i.a, {r.top, width}) : std::string();
  *r.top++ = r.m.heap.InternText(text);
  return Fault::kNone;
}

}  // namespace rondo::koord::semantics
