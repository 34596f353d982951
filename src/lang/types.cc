#include "lang/types.h"

#include <fmt/format.h>

#include "base/check.h"

namespace rondo::lang {

TypeTable::TypeTable() {
  Add({TypeKind::kError, "?", {}, {}});
  Add({TypeKind::kBool, "bool", {}, {}});
  Add({TypeKind::kInt, "int", {}, {}});
  Add({TypeKind::kFloat, "float", {}, {}});
  Add({TypeKind::kString, "string", {}, {}});
  Add({TypeKind::kStream, "stream", {}, {}});
  const TypeId pos = Add({TypeKind::kRecord, "pos", {"x", "y", "z"}, {real(), real(), real()}});
  CHECK(pos == this->pos());
}

TypeId TypeTable::Add(Type type) {
  types_.push_back(std::move(type));
  bound_.emplace_back();
  return TypeId(types_.size() - 1);
}

TypeId TypeTable::Array(TypeId element, std::string length) {
  return Add({TypeKind::kArray, "", {}, {element}, std::move(length)});
}
TypeId TypeTable::List(TypeId element) { return Add({TypeKind::kList, "", {}, {element}}); }
TypeId TypeTable::Tuple(std::vector<TypeId> parts) {
  static const std::vector<std::string> kNames = {"first", "second", "third", "fourth", "fifth", "sixth"};
  std::vector<std::string> fields;
  for (size_t i = 0; i < parts.size(); ++i)
    fields.push_back(i < kNames.size() ? kNames[i] : fmt::format("item{}", i + 1));
  return Add({TypeKind::kTuple, "", std::move(fields), std::move(parts)});
}
TypeId TypeTable::Record(std::string name, std::vector<std::string> fields, std::vector<TypeId> parts) {
  return Add({TypeKind::kRecord, std::move(name), std::move(fields), std::move(parts)});
}
void TypeTable::SetFields(TypeId record, std::vector<std::string> fields, std::vector<TypeId> parts) {
  types_[record.index()].fields = std::move(fields);
  types_[record.index()].parts = std::move(parts);
}
TypeId TypeTable::Enum(std::string name, std::vector<std::string> members) {
  return Add({TypeKind::kEnum, std::move(name), std::move(members), {}});
}
TypeId TypeTable::Opaque(std::string name) { return Add({TypeKind::kOpaque, std::move(name), {}, {}}); }
TypeId TypeTable::FreshVariable() { return Add({TypeKind::kVariable, "", {}, {}}); }

TypeId TypeTable::Resolve(TypeId type) const {
  while (bound_[type.index()].valid()) type = bound_[type.index()];
  return type;
}

bool TypeTable::Occurs(TypeId variable, TypeId in) const {
  in = Resolve(in);
  if (in == variable) return true;
  const Type& t = types_[in.index()];
  if (t.kind == TypeKind::kRecord) return false;  // named: holds no variables
  for (const TypeId part : t.parts) {
    if (Occurs(variable, part)) return true;
  }
  return false;
}

bool TypeTable::HasVariable(TypeId type) const {
  const Type& t = (*this)[type];
  if (t.kind == TypeKind::kVariable) return true;
  if (t.kind == TypeKind::kRecord) return false;
  for (const TypeId part : t.parts) {
    if (HasVariable(part)) return true;
  }
  return false;
}

bool TypeTable::Unify(TypeId a, TypeId b) {
  a = Resolve(a);
  b = Resolve(b);
  if (a == b) return true;
  const Type& x = types_[a.index()];
  const Type& y = types_[b.index()];
  if (x.kind == TypeKind::kError || y.kind == TypeKind::kError) return true;
  if (x.kind == TypeKind::kVariable || y.kind == TypeKind::kVariable) {
    const TypeId variable = x.kind == TypeKind::kVariable ? a : b;
    const TypeId other = variable == a ? b : a;
    if (Occurs(variable, other)) return false;
    bound_[variable.index()] = other;
    return true;
  }
  if (x.kind != y.kind || x.name != y.name || x.parts.size() != y.parts.size() || x.length != y.length)
    return false;
  if (x.kind == TypeKind::kRecord) return true;  // same name, same record
  const std::vector<TypeId> left = x.parts;
  const std::vector<TypeId> right = y.parts;
  for (size_t i = 0; i < left.size(); ++i) {
    if (!Unify(left[i], right[i])) return false;
  }
  return true;
}

bool TypeTable::Coerce(TypeId from, TypeId to) {
  if (Is(from, TypeKind::kInt) && Is(to, TypeKind::kFloat)) return true;
  return Unify(from, to);
}

std::string TypeTable::WithArticle(TypeId type) const {
  const std::string name = Name(type);
  const bool vowel = std::string_view("aeioAEIO").find(name[0]) != std::string_view::npos;
  return fmt::format("{} `{}`", vowel ? "an" : "a", name);
}

std::string TypeTable::Name(TypeId type) const {
  const Type& t = (*this)[type];
  switch (t.kind) {
    case TypeKind::kArray: {
      // The outer length first, as in declarations.
      std::string lengths;
      TypeId element = type;
      for (; Is(element, TypeKind::kArray); element = (*this)[element].parts[0])
        lengths += fmt::format("[{}]", (*this)[element].length);
      return Name(element) + lengths;
    }
    case TypeKind::kList:
      return fmt::format("List<{}>", Name(t.parts[0]));
    case TypeKind::kVariable:
      return "?";
    case TypeKind::kTuple: {
      std::string text;
      for (const TypeId part : t.parts) text += (text.empty() ? "" : ", ") + Name(part);
      return fmt::format("({})", text);
    }
    case TypeKind::kError:
    case TypeKind::kBool:
    case TypeKind::kInt:
    case TypeKind::kFloat:
    case TypeKind::kString:
    case TypeKind::kStream:
    case TypeKind::kRecord:
    case TypeKind::kEnum:
    case TypeKind::kOpaque:
      return t.name;
  }
  return "?";
}

}  // namespace rondo::lang
