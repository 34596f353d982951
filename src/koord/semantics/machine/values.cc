#include "koord/semantics/machine/values.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace rondo::koord::semantics {

using lang::TypeKind;
using nlohmann::json;

namespace {

// Calls `visit(part, words of the part)` for each field of a record or item of a list.
template <typename Visit>
void ForEachPart(const lang::TypeTable& types, const lang::Type& type, std::span<const Word> words,
                 const Visit& visit) {
  size_t at = 0;
  for (size_t i = 0; i < type.parts.size(); ++i) {
    const uint32_t width = Layout::Width(types, type.parts[i]);
    visit(i, words.subspan(at, width));
    at += width;
  }
}

template <typename Visit>
void ForEachItem(const lang::TypeTable& types, const Heap& heap, TypeId element, Word list,
                 const Visit& visit) {
  const auto items = heap[list];
  const uint32_t width = Layout::Width(types, element);
  for (size_t at = 0; at + width <= items.size(); at += width) visit(items.subspan(at, width));
}

}  // namespace

std::string Show(const lang::TypeTable& types, const Heap& heap, TypeId id, std::span<const Word> words) {
  const lang::Type& type = types[id];
  std::string text;
  switch (type.kind) {
    case TypeKind::kBool:
      return words[0] != 0 ? "true" : "false";
    case TypeKind::kError:
    case TypeKind::kVariable:
    case TypeKind::kInt:
      return fmt::format("{}", ToInt(words[0]));
    case TypeKind::kFloat:
      return fmt::format("{}", ToFloat(words[0]));
    case TypeKind::kEnum:
      return words[0] < type.fields.size() ? type.fields[words[0]] : "?";
    case TypeKind::kString:
      return fmt::format("\"{}\"", heap.Text(words[0]));
    case TypeKind::kStream:
      return "stream";
    case TypeKind::kRecord:
    case TypeKind::kTuple:
      ForEachPart(types, type, words, [&](size_t i, std::span<const Word> part) {
        text += (text.empty() ? "" : ", ") + Show(types, heap, type.parts[i], part);
      });
      return "(" + text + ")";
    case TypeKind::kArray:
    case TypeKind::kList:
      ForEachItem(types, heap, type.parts[0], words[0], [&](std::span<const Word> item) {
        text += (text.empty() ? "" : ", ") + Show(types, heap, type.parts[0], item);
      });
      return "[" + text + "]";
    case TypeKind::kOpaque:
      return words[0] == 0 ? fmt::format("empty {}", type.name) : fmt::format("{} #{}", type.name, words[0]);
  }
  return "";
}

namespace {

// Puts the items of arrays together level by level: `item(words)` tells one, `list(parts)` makes one of many.
template <typename Result, typename Item, typename Join>
Result Nested(const Layout::Place& place, size_t level, std::span<const Word> words, const Item& item,
              const Join& list) {
  if (level == place.dimensions.size()) return item(words);
  const size_t part = words.size() / place.dimensions[level];
  std::vector<Result> parts;
  for (size_t at = 0; at < words.size(); at += part)
    parts.push_back(Nested<Result>(place, level + 1, words.subspan(at, part), item, list));
  return list(parts);
}

}  // namespace

std::string Show(const lang::TypeTable& types, const Heap& heap, const Layout::Place& place,
                 std::span<const Word> words) {
  return Nested<std::string>(
      place, 0, words, [&](std::span<const Word> item) { return Show(types, heap, place.item, item); },
      [](const std::vector<std::string>& parts) { return fmt::format("[{}]", fmt::join(parts, ", ")); });
}

json ToJson(const lang::TypeTable& types, const Heap& heap, const Layout::Place& place,
            std::span<const Word> words) {
  return Nested<json>(
      place, 0, words, [&](std::span<const Word> item) { return ToJson(types, heap, place.item, item); },
      [](const std::vector<json>& parts) { return json(parts); });
}

json ToJson(const lang::TypeTable& types, const Heap& heap, TypeId id, std::span<const Word> words) {
  const lang::Type& type = types[id];
  switch (type.kind) {
    case TypeKind::kBool:
      return words[0] != 0;
    case TypeKind::kError:
    case TypeKind::kVariable:
    case TypeKind::kInt:
      return ToInt(words[0]);
    case TypeKind::kFloat:
      return ToFloat(words[0]);
    case TypeKind::kEnum:
      return words[0] < type.fields.size() ? json(type.fields[words[0]]) : json(nullptr);
    case TypeKind::kString:
      return heap.Text(words[0]);
    case TypeKind::kStream:
      return nullptr;
    case TypeKind::kRecord: {
      json object = json::object();
      ForEachPart(types, type, words, [&](size_t i, std::span<const Word> part) {
        object[type.fields[i]] = ToJson(types, heap, type.parts[i], part);
      });
      return object;
    }
    case TypeKind::kTuple: {
      json list = json::array();
      ForEachPart(types, type, words, [&](size_t i, std::span<const Word> part) {
        list.push_back(ToJson(types, heap, type.parts[i], part));
      });
      return list;
    }
    case TypeKind::kArray:
    case TypeKind::kList: {
      json list = json::array();
      ForEachItem(types, heap, type.parts[0], words[0], [&](std::span<const Word> item) {
        list.push_back(ToJson(types, heap, type.parts[0], item));
      });
      return list;
    }
    case TypeKind::kOpaque: {
      json list = json::array();
      for (const Word w : heap[words[0]]) list.push_back(w);
      return list;
    }
  }
  return nullptr;
}

std::optional<std::vector<Word>> FromJson(const lang::TypeTable& types, Heap& heap, TypeId id,
                                          const json& j) {
  const lang::Type& type = types[id];
  std::vector<Word> words;
  const auto append = [&](TypeId part, const json& value) {
    const auto more = FromJson(types, heap, part, value);
    if (more) words.insert(words.end(), more->begin(), more->end());
    return more.has_value();
  };
  switch (type.kind) {
    case TypeKind::kBool:
      if (!j.is_boolean()) return std::nullopt;
      return std::vector<Word>{j.get<bool>()};
    case TypeKind::kError:
    case TypeKind::kVariable:
    case TypeKind::kInt:
      if (!j.is_number_integer()) return std::nullopt;
      if (j.is_number_unsigned() &&
          j.get<uint64_t>() > static_cast<uint64_t>(std::numeric_limits<int64_t>::max()))
        return std::nullopt;
      return std::vector<Word>{FromInt(j.get<int64_t>())};
    case TypeKind::kFloat:
      if (!j.is_number() || !std::isfinite(j.get<double>())) return std::nullopt;
      return std::vector<Word>{FromFloat(j.get<double>() + 0.0)};
    case TypeKind::kEnum:
      for (size_t i = 0; j.is_string() && i < type.fields.size(); ++i) {
        if (j.get<std::string>() == type.fields[i]) return std::vector<Word>{i};
      }
      return std::nullopt;
    case TypeKind::kString:
      if (!j.is_string()) return std::nullopt;
      return std::vector<Word>{heap.InternText(j.get<std::string>())};
    case TypeKind::kStream:
      return std::vector<Word>{0};
    case TypeKind::kRecord:
      // A point may be written as a list of its coordinates.
      if (j.is_array() && j.size() == type.parts.size()) {
        for (size_t i = 0; i < type.parts.size(); ++i) {
          if (!append(type.parts[i], j[i])) return std::nullopt;
        }
        return words;
      }
      for (size_t i = 0; i < type.parts.size(); ++i) {
        if (!j.is_object() || !j.contains(type.fields[i]) || !append(type.parts[i], j[type.fields[i]]))
          return std::nullopt;
      }
      return words;
    case TypeKind::kTuple:
      if (!j.is_array() || j.size() != type.parts.size()) return std::nullopt;
      for (size_t i = 0; i < type.parts.size(); ++i) {
        if (!append(type.parts[i], j[i])) return std::nullopt;
      }
      return words;
    case TypeKind::kArray:
    case TypeKind::kList:
      if (!j.is_array()) return std::nullopt;
      for (const json& item : j) {
        if (!append(type.parts[0], item)) return std::nullopt;
      }
      return std::vector<Word>{heap.Intern(words)};
    case TypeKind::kOpaque:
      if (!j.is_array()) return std::nullopt;
      for (const json& w : j) {
        if (!w.is_number_integer()) return std::nullopt;
        words.push_back(w.get<uint64_t>());
      }
      return std::vector<Word>{heap.Intern(words)};
  }
  return std::nullopt;
}

void MarkHandles(const lang::TypeTable& types, Heap& heap, TypeId id, std::span<const Word> words) {
  const lang::Type& type = types[id];
  switch (type.kind) {
    case TypeKind::kRecord:
    case TypeKind::kTuple:
      ForEachPart(types, type, words, [&](size_t i, std::span<const Word> part) {
        MarkHandles(types, heap, type.parts[i], part);
      });
      return;
    case TypeKind::kArray:
    case TypeKind::kList:
      if (heap.marked(words[0])) return;
      heap.Mark(words[0]);
      ForEachItem(types, heap, type.parts[0], words[0],
                  [&](std::span<const Word> item) { MarkHandles(types, heap, type.parts[0], item); });
      return;
    case TypeKind::kString:
    case TypeKind::kOpaque:
      heap.Mark(words[0]);
      return;
    case TypeKind::kError:
    case TypeKind::kVariable:
    case TypeKind::kBool:
    case TypeKind::kInt:
    case TypeKind::kFloat:
    case TypeKind::kEnum:
    case TypeKind::kStream:
      return;
  }
}

int Compare(const lang::TypeTable& types, const Heap& heap, TypeId type, Word a, Word b) {
  if (a == b) return 0;
  if (Layout::Kind(types, type) != WordKind::kHandle) return a < b ? -1 : 1;
  const auto x = heap[a], y = heap[b];
  if (x.size() != y.size()) return x.size() < y.size() ? -1 : 1;
  const lang::Type& t = types[type];
  const bool items = t.kind == TypeKind::kList || t.kind == TypeKind::kArray;
  std::vector<TypeId> parts;
  if (items) Layout::Parts(types, t.parts[0], parts);
  for (size_t i = 0; i < x.size(); ++i) {
    const int order = items ? Compare(types, heap, parts[i % parts.size()], x[i], y[i])
                            : (x[i] == y[i] ? 0 : (x[i] < y[i] ? -1 : 1));
    if (order != 0) return order;
  }
  return 0;
}

}  // namespace rondo::koord::semantics
