#include "codegen/koord/types.h"

#include <fmt/format.h>

#include <algorithm>

#include "codegen/koord/names.h"

namespace rondo::codegen {

using koord::semantics::Layout;
using lang::TypeKind;

namespace {

constexpr uint32_t kTextBytes = 256;  // unless something else is said
constexpr uint32_t kSaidBytes = 2048;
constexpr double kLargest = 1 << 20;  // bytes of a value, which may be on the stack

}  // namespace

Types::Types(const koord::semantics::Team& team, const Capacities& capacities, diag::Diagnostics& diagnostics)
    : team_(team), types_(team.model().types), capacities_(capacities), diagnostics_(diagnostics) {}

std::optional<uint32_t> Types::LengthOf(TypeId array) const {
  const auto length = team_.lengths().find(types_[array].length);
  if (length == team_.lengths().end()) return std::nullopt;
  return length->second;
}

std::optional<uint32_t> Types::CapacityOf(TypeId type) const {
  const std::string name = types_.Name(type);
  asked_.insert(name);
  const auto own = capacities_.by_type.find(name);
  return own == capacities_.by_type.end() ? capacities_.others : own->second;
}

uint32_t Types::TextCapacity() const {
  const auto own = capacities_.by_type.find("string");
  return own == capacities_.by_type.end() ? kTextBytes : own->second;
}

uint32_t Types::SaidCapacity() const {
  const auto own = capacities_.by_type.find("stream");
  return own == capacities_.by_type.end() ? kSaidBytes : own->second;
}

// Roughly: without what is between members.
double Types::BytesOf(TypeId type, int level) const {
  const lang::Type& t = types_[type];
  if (level > 32) return 0;  // it contains itself
  double bytes = 0;
  switch (t.kind) {
    case TypeKind::kRecord:
    case TypeKind::kTuple:
      for (const TypeId part : t.parts) bytes += BytesOf(part, level + 1);
      return bytes;
    case TypeKind::kList:
      return 8 + CapacityOf(type).value_or(1) * BytesOf(t.parts[0], level + 1);
    case TypeKind::kOpaque:
      return 8 + CapacityOf(type).value_or(1) * 8.0;
    case TypeKind::kArray:
      return LengthOf(type).value_or(1) * BytesOf(t.parts[0], level + 1);
    case TypeKind::kString:
      return 8 + TextCapacity();
    default:
      return 8;
  }
}

std::vector<std::string> Types::Unused() const {
  std::vector<std::string> unused;
  for (const auto& [name, _] : capacities_.by_type) {
    if (!asked_.contains(name) && name != "string" && name != "stream") unused.push_back(name);
  }
  return unused;
}

void Types::Refuse(TypeId type, diag::Span where, const std::string& what, const std::string& help) {
  if (!refused_.insert(types_.Name(type)).second) return;
  auto& report = diagnostics_.Report(diag::Kind::kKoordNotBuildable, where, what);
  if (!help.empty()) report.Help(help);
}

std::string Types::Of(TypeId type, diag::Span where) {
  const lang::Type& t = types_[type];
  const std::string name = types_.Name(type);
  if (BytesOf(type) > kLargest)
    Refuse(type, where,
           fmt::format("a `{}` has room for {:.3g} MB, and 1 MB is the most", name, BytesOf(type) / kLargest),
           "a smaller capacity: `--capacity TYPE=NUMBER`");
  switch (t.kind) {
    case TypeKind::kBool:
      return "bool";
    case TypeKind::kError:
    case TypeKind::kVariable:
    case TypeKind::kInt:
      return "int64_t";
    case TypeKind::kFloat:
      return "double";
    case TypeKind::kString:
    case TypeKind::kStream:
      return "Str";
    case TypeKind::kList: {
      const auto capacity = CapacityOf(type);
      if (!capacity)
        Refuse(type, where, fmt::format("nothing says how many items a `{}` has at most", name),
               fmt::format("`--capacity '{}=64'`, or `--capacity 64` for all", name));
      return fmt::format("List<{}, {}>", Of(t.parts[0], where), capacity.value_or(1));
    }
    case TypeKind::kOpaque: {
      const auto capacity = CapacityOf(type);
      if (!capacity)
        Refuse(type, where, fmt::format("nothing says how many numbers a `{}` is made of at most", name),
               fmt::format("`--capacity {}=1024`: external functions look into them", name));
      return fmt::format("Opaque<{}>", capacity.value_or(1));
    }
    case TypeKind::kArray: {
      const auto length = LengthOf(type);
      if (!length) Refuse(type, where, fmt::format("nothing says how many items a `{}` has", name), "");
      return fmt::format("std::array<{}, {}>", Of(t.parts[0], where), length.value_or(1));
    }
    case TypeKind::kRecord:
    case TypeKind::kTuple:
    case TypeKind::kEnum:
      break;
  }
  if (type == types_.pos() || (t.kind == TypeKind::kRecord && t.name == "pos")) return "Pos";
  const auto known = names_.find(name);
  return known != names_.end() ? known->second : Define(type, where);
}

std::string Types::Member(TypeId record, size_t index) const {
  static constexpr const char* kOrdinals[] = {"first", "second", "third",   "fourth",
                                              "fifth", "sixth",  "seventh", "eighth"};
  const lang::Type& t = types_[record];
  if (index < t.fields.size()) return CppName(t.fields[index]);
  return index < std::size(kOrdinals) ? kOrdinals[index] : fmt::format("part{}", index + 1);
}

std::string Types::Define(TypeId type, diag::Span where) {
  const lang::Type& t = types_[type];
  const std::string name = types_.Name(type);
  std::string cpp = CppName(t.name);
  if (t.kind == TypeKind::kTuple)
    cpp = fmt::format(
        "Tuple{}", 1 + std::ranges::count_if(names_, [](const auto& n) { return n.first.starts_with('('); }));
  if (!defining_.insert(name).second) {
    Refuse(type, where, fmt::format("a `{}` contains others of its kind", name), "");
    return cpp;
  }
  names_[name] = cpp;
  if (t.kind == TypeKind::kEnum) {
    std::string members, words;
    for (const std::string& m : t.fields) {
      members += (members.empty() ? "" : ", ") + CppName(m);
      words += (words.empty() ? "" : ", ") + CppString(m);
    }
    definitions_ += fmt::format(
        "enum class {0} : {4} {{ {1} }};\n"
        "constexpr std::array<std::string_view, {3}> NamesOf({0}) {{ return {{{2}}}; }}\n\n",
        cpp, members, words, t.fields.size(), t.fields.size() > 256 ? "uint16_t" : "uint8_t");
    defining_.erase(name);
    return cpp;
  }
  std::string members, pointers;
  for (size_t i = 0; i < t.parts.size(); ++i) {
    const std::string member = Member(type, i);
    members += fmt::format("  {} {}{{}};\n", Of(t.parts[i], where), member);
    pointers += fmt::format("{}&{}::{}", i == 0 ? "" : ", ", cpp, member);
  }
  definitions_ += fmt::format(
      "struct {0} {{\n{1}\n  static constexpr auto Members() {{ return std::tuple{{{2}}}; }}\n}};\n\n", cpp,
      members, pointers);
  defining_.erase(name);
  return cpp;
}

std::string Types::Literal(TypeId type, std::span<const Word> words, diag::Span where) {
  const lang::Type& t = types_[type];
  switch (t.kind) {
    case TypeKind::kBool:
      return words[0] != 0 ? "true" : "false";
    case TypeKind::kError:
    case TypeKind::kVariable:
    case TypeKind::kInt: {
      const int64_t value = koord::semantics::ToInt(words[0]);
      return value == INT64_MIN ? "INT64_MIN" : fmt::format("{}", value);
    }
    case TypeKind::kFloat:
      return CppFloat(koord::semantics::ToFloat(words[0]));
    case TypeKind::kEnum:
      return fmt::format("{}::{}", Of(type, where), CppName(t.fields[words[0]]));
    case TypeKind::kString:
      return fmt::format("Str({})", CppString(team_.heap().Text(words[0])));
    case TypeKind::kStream:
      return "{}";
    case TypeKind::kRecord:
    case TypeKind::kTuple: {
      std::string parts;
      size_t at = 0;
      for (const TypeId part : t.parts) {
        const uint32_t width = Layout::Width(types_, part);
        parts += (parts.empty() ? "" : ", ") + Literal(part, words.subspan(at, width), where);
        at += width;
      }
      return fmt::format("{}{{{}}}", Of(type, where), parts);
    }
    case TypeKind::kArray:
    case TypeKind::kList: {
      const auto items = team_.heap()[words[0]];
      const uint32_t width = Layout::Width(types_, t.parts[0]);
      const size_t most = (t.kind == TypeKind::kList ? CapacityOf(type) : LengthOf(type)).value_or(0);
      if (items.size() > most * width)
        Refuse(type, where, fmt::format("{} items where there is room for {}", items.size() / width, most),
               "");
      std::string parts;
      for (size_t at = 0; at + width <= items.size(); at += width)
        parts += (at == 0 ? "" : ", ") + Literal(t.parts[0], items.subspan(at, width), where);
      return fmt::format("{}{{{}}}", Of(type, where), parts);
    }
    case TypeKind::kOpaque:
      Refuse(type, where, fmt::format("a `{}` has no value that C++ can write", t.name), "");
      return "{}";
  }
  return "{}";
}

}  // namespace rondo::codegen
