#include "koord/node/values.h"

#include <cmath>

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
      const std::string text = heap.Text(words[0]);
      w.Block(View(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
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
      const size_t count = r.Number(kMostItems);
      std::vector<Word> items;
      for (size_t i = 0; i < count && r.ok(); ++i)
        DecodeValue(types, heap, type.parts[0], r, items, level + 1);
      words.push_back(r.ok() ? heap.Intern(items) : 0);
      return;
    }
    case TypeKind::kOpaque: {
      const size_t count = r.Number(kMostItems);
      std::vector<Word> items;
      for (size_t i = 0; i < count && r.ok(); ++i) items.push_back(r.Fixed());
      words.push_back(r.ok() ? heap.Intern(items) : 0);
      return;
    }
  }
}

}  // namespace rondo::koord::node
