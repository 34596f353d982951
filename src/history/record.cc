#include "history/record.h"

namespace rondo::history {

using koord::semantics::Heap;
using koord::semantics::Layout;
using koord::semantics::Team;
using lang::TypeId;
using lang::TypeKind;
using lang::TypeTable;

namespace {

void Flatten(const TypeTable& types, const Heap& heap, TypeId id, std::span<const Word> words, Image& image) {
  const lang::Type& type = types[id];
  switch (type.kind) {
    case TypeKind::kString:
    case TypeKind::kOpaque: {
      const auto items = heap[words[0]];
      image.push_back(items.size());
      image.insert(image.end(), items.begin(), items.end());
      return;
    }
    case TypeKind::kArray:
    case TypeKind::kList: {
      const auto items = heap[words[0]];
      const size_t width = Layout::Width(types, type.parts[0]);
      image.push_back(width == 0 ? 0 : items.size() / width);
      for (size_t at = 0; width > 0 && at + width <= items.size(); at += width)
        Flatten(types, heap, type.parts[0], items.subspan(at, width), image);
      return;
    }
    case TypeKind::kRecord:
    case TypeKind::kTuple: {
      size_t at = 0;
      for (const TypeId part : type.parts) {
        const size_t width = Layout::Width(types, part);
        Flatten(types, heap, part, words.subspan(at, width), image);
        at += width;
      }
      return;
    }
    default:
      image.insert(image.end(), words.begin(), words.end());
  }
}

// Takes a value off the front of an image; false if there is none.
bool Build(const TypeTable& types, Heap& heap, TypeId id, std::span<const Word>& image,
           std::vector<Word>& words) {
  const lang::Type& type = types[id];
  const auto take = [&](Word& word) {
    if (image.empty()) return false;
    word = image[0];
    image = image.subspan(1);
    return true;
  };
  switch (type.kind) {
    case TypeKind::kString:
    case TypeKind::kOpaque: {
      Word size = 0;
      if (!take(size) || size > image.size()) return false;
      words.push_back(heap.Intern(image.first(size)));
      image = image.subspan(size);
      return true;
    }
    case TypeKind::kArray:
    case TypeKind::kList: {
      Word size = 0;
      if (!take(size) || size > image.size() + 1) return false;
      std::vector<Word> items;
      for (Word i = 0; i < size; ++i) {
        if (!Build(types, heap, type.parts[0], image, items)) return false;
      }
      words.push_back(heap.Intern(items));
      return true;
    }
    case TypeKind::kRecord:
    case TypeKind::kTuple:
      for (const TypeId part : type.parts) {
        if (!Build(types, heap, part, image, words)) return false;
      }
      return true;
    case TypeKind::kStream:
      return true;
    default: {
      Word word = 0;
      if (!take(word)) return false;
      words.push_back(word);
      return true;
    }
  }
}

// Calls `visit(place, address)` for each item of each variable, and for the marks of robots that stopped.
template <typename Visit>
void ForEachItem(const Team& team, const Visit& visit) {
  const Layout& layout = team.layout();
  for (size_t v = 0; v < team.model().variables.size(); ++v) {
    const Layout::Place& place = layout[v];
    if (!place.exists || team.model().variables[v].kind == koord::VariableKind::kParam) continue;
    for (size_t r = 0; r < (place.own ? team.robots() : 1); ++r) {
      for (uint32_t i = 0; i < std::max<uint32_t>(1, place.length); ++i)
        visit(&place, layout.Address(v, r) + i * place.width);
    }
  }
  for (size_t r = 0; r < team.robots(); ++r) visit(nullptr, layout.block(r) + layout.stopped());
}

}  // namespace

Image ImageOf(const Team& team, std::span<const Word> state) {
  Image image;
  ForEachItem(team, [&](const Layout::Place* place, uint32_t at) {
    if (place == nullptr)
      image.push_back(state[at]);
    else
      Flatten(team.model().types, team.heap(), place->item, state.subspan(at, place->width), image);
  });
  return image;
}

std::vector<Word> StateOf(Team& team, std::span<const Word> image) {
  std::vector<Word> state = team.blank();
  std::vector<Word> words;
  bool good = true;
  ForEachItem(team, [&](const Layout::Place* place, uint32_t at) {
    words.clear();
    if (!good) return;
    if (place == nullptr) {
      good = !image.empty();
      if (!good) return;
      words.push_back(image[0]);
      image = image.subspan(1);
    } else {
      good = Build(team.model().types, team.heap(), place->item, image, words);
    }
    if (good) std::copy(words.begin(), words.end(), state.begin() + at);
  });
  if (!good || !image.empty()) return {};
  return state;
}

std::string_view Name(Kind kind) {
  switch (kind) {
    case Kind::kStarted:
      return "started";
    case Kind::kCrashed:
      return "crashed";
    case Kind::kContributed:
      return "contributed";
    case Kind::kStored:
      return "stored";
    case Kind::kCommitted:
      return "committed";
    case Kind::kActed:
      return "acted";
    case Kind::kFellBack:
      return "fell-back";
    case Kind::kAdopted:
      return "adopted";
  }
  return "";
}

}  // namespace rondo::history
