#include "koord/node/values.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace rondo::koord::node {

using lang::TypeKind;
using runtime::codec::Reader;
using runtime::codec::View;
using runtime::codec::Writer;
using semantics::Layout;

namespace {

constexpr size_t kMostItems = 1'000'000;
constexpr int kMostLevels = 32;

// Small numbers of either sign are short.
uint64_t ZigZag(int64_t value) {
  return (static_cast<uint64_t>(value) << 1) ^ static_cast<uint64_t>(value >> 63);
}
int64_t UnZigZag(uint64_t value) { return static_cast<int64_t>((value >> 1) ^ (~(value & 1) + 1)); }

// Makes the words from `start` on a list.
void Gather(Heap& heap, const Reader& r, size_t start, std::vector<Word>& words) {
  const Word list = r.ok() ? heap.Intern(std::span(words).subspan(start)) : 0;
  words.resize(start);
  words.push_back(list);
}

// What a change of a list leaves as it was: so many items at the beginning, and so many of the others at the end.
struct Kept {
  size_t front = 0, back = 0;
  friend bool operator==(const Kept&, const Kept&) = default;
};
Kept KeptOf(std::span<const Word> before, std::span<const Word> after, uint32_t width) {
  const size_t most = std::min(before.size(), after.size()) / width;
  const auto same = [&](size_t at, size_t in) {
    return std::ranges::equal(before.subspan(at, width), after.subspan(in, width));
  };
  Kept kept;
  while (kept.front < most && same(kept.front * width, kept.front * width)) ++kept.front;
  while (kept.front + kept.back < most &&
         same(before.size() - (kept.back + 1) * width, after.size() - (kept.back + 1) * width))
    ++kept.back;
  return kept;
}

// The type of the items of a list whose changes are encoded; nothing for all other values.
std::optional<TypeId> ItemOfList(const lang::TypeTable& types, TypeId id) {
  const lang::Type& type = types[id];
  if (type.kind != TypeKind::kList && type.kind != TypeKind::kArray) return std::nullopt;
  if (Layout::Width(types, type.parts[0]) == 0) return std::nullopt;
  return type.parts[0];
}

}  // namespace

void EncodeValue(const lang::TypeTable& types, const Heap& heap, TypeId id, std::span<const Word> words,
                 Writer& w) {
  const lang::Type& type = types[id];
  switch (type.kind) {
    case TypeKind::kBool:
    case TypeKind::kEnum:
      w.Number(words[0]);
      return;
    case TypeKind::kError:
    case TypeKind::kVariable:
    case TypeKind::kInt:
      w.Number(ZigZag(semantics::ToInt(words[0])));
      return;
    case TypeKind::kFloat:
      w.Fixed(words[0]);
      return;
    case TypeKind::kString: {
      const auto text = heap[words[0]];  // its length, and then the bytes
      w.Block(text.empty() ? View() : View(reinterpret_cast<const uint8_t*>(text.data() + 1), text[0]));
      return;
    }
    case TypeKind::kStream:
      return;
    case TypeKind::kRecord:
    case TypeKind::kTuple: {
      size_t at = 0;
      for (const TypeId part : type.parts) {
        const uint32_t width = Layout::Width(types, part);
        EncodeValue(types, heap, part, words.subspan(at, width), w);
        at += width;
      }
      return;
    }
    case TypeKind::kArray:
    case TypeKind::kList: {
      const auto items = heap[words[0]];
      const uint32_t width = Layout::Width(types, type.parts[0]);
      w.Number(width == 0 ? 0 : items.size() / width);
      for (size_t at = 0; width > 0 && at + width <= items.size(); at += width)
        EncodeValue(types, heap, type.parts[0], items.subspan(at, width), w);
      return;
    }
    case TypeKind::kOpaque: {
      const auto items = heap[words[0]];
      w.Number(items.size());
      for (const Word word : items) w.Fixed(word);
      return;
    }
  }
}

void DecodeValue(const lang::TypeTable& types, Heap& heap, TypeId id, Reader& r, std::vector<Word>& words,
                 int level) {
  const lang::Type& type = types[id];
  if (level > kMostLevels) r.Fail();
  if (!r.ok()) return;
  switch (type.kind) {
    case TypeKind::kBool:
      words.push_back(r.Number(1));
      return;
    case TypeKind::kEnum:
      words.push_back(r.Number(type.fields.empty() ? 0 : type.fields.size() - 1));
      return;
    case TypeKind::kError:
    case TypeKind::kVariable:
    case TypeKind::kInt:
      words.push_back(semantics::FromInt(UnZigZag(r.Number())));
      return;
    case TypeKind::kFloat:
      words.push_back(r.Fixed());
      if (!std::isfinite(semantics::ToFloat(words.back()))) r.Fail();
      return;
    case TypeKind::kString: {
      const View text = r.Block(kMostItems);
      words.push_back(heap.InternText({reinterpret_cast<const char*>(text.data()), text.size()}));
      return;
    }
    case TypeKind::kStream:
      return;
    case TypeKind::kRecord:
    case TypeKind::kTuple:
      for (const TypeId part : type.parts) DecodeValue(types, heap, part, r, words, level + 1);
      return;
    case TypeKind::kArray:
    case TypeKind::kList: {
      const size_t count = r.Number(kMostItems), start = words.size();
      for (size_t i = 0; i < count && r.ok(); ++i)
        DecodeValue(types, heap, type.parts[0], r, words, level + 1);
      Gather(heap, r, start, words);
      return;
    }
    case TypeKind::kOpaque: {
      const size_t count = r.Number(kMostItems), start = words.size();
      for (size_t i = 0; i < count && r.ok(); ++i) words.push_back(r.Fixed());
      Gather(heap, r, start, words);
      return;
    }
  }
}

void EncodeChange(const lang::TypeTable& types, const Heap& heap, TypeId id, std::span<const Word> before,
                  std::span<const Word> after, Writer& w) {
  const std::optional<TypeId> item = ItemOfList(types, id);
  if (!item) return EncodeValue(types, heap, id, after, w);
  const uint32_t width = Layout::Width(types, *item);
  const auto list = heap[after[0]];
  const Kept kept = KeptOf(heap[before[0]], list, width);
  const size_t end = list.size() - kept.back * width;
  w.Number(kept.front);
  w.Number(kept.back);
  w.Number(end / width - kept.front);
  for (size_t at = kept.front * width; at < end; at += width)
    EncodeValue(types, heap, *item, list.subspan(at, width), w);
}

void DecodeChange(const lang::TypeTable& types, Heap& heap, TypeId id, std::span<const Word> before,
                  Reader& r, std::vector<Word>& words) {
  const std::optional<TypeId> item = ItemOfList(types, id);
  if (!item) return DecodeValue(types, heap, id, r, words);
  const uint32_t width = Layout::Width(types, *item);
  const size_t length = heap[before[0]].size() / width;
  const Kept kept{r.Number(length), r.Number(length)};
  const size_t fresh = r.Number(kMostItems);
  if (kept.front + kept.back > length || kept.front + kept.back + fresh > kMostItems) r.Fail();
  if (!r.ok()) return;
  const size_t start = words.size();
  const auto keep = [&](size_t from, size_t count) {
    const auto old = heap[before[0]].subspan(from * width, count * width);
    words.insert(words.end(), old.begin(), old.end());
  };
  keep(0, kept.front);
  for (size_t i = 0; i < fresh && r.ok(); ++i) DecodeValue(types, heap, *item, r, words, 1);
  keep(length - kept.back, kept.back);
  // In one form only.
  if (KeptOf(heap[before[0]], std::span(words).subspan(start), width) != kept) r.Fail();
  Gather(heap, r, start, words);
}

}  // namespace rondo::koord::node
