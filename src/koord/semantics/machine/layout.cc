#include "koord/semantics/machine/layout.h"

#include <algorithm>

namespace rondo::koord::semantics {

using lang::TypeKind;

uint32_t Layout::Width(const lang::TypeTable& types, TypeId type) {
  const lang::Type& t = types[type];
  if (t.kind != TypeKind::kRecord && t.kind != TypeKind::kTuple) return 1;
  uint32_t width = 0;
  for (const TypeId part : t.parts) width += Width(types, part);
  return width;
}

void Layout::Parts(const lang::TypeTable& types, TypeId type, std::vector<TypeId>& parts) {
  const lang::Type& t = types[type];
  if (t.kind != TypeKind::kRecord && t.kind != TypeKind::kTuple) return parts.push_back(type);
  for (const TypeId part : t.parts) Parts(types, part, parts);
}

WordKind Layout::Kind(const lang::TypeTable& types, TypeId part) {
  const lang::Type& t = types[part];
  switch (t.kind) {
    case TypeKind::kBool:
      return WordKind::kBool;
    case TypeKind::kFloat:
      return WordKind::kFloat;
    case TypeKind::kEnum:
      return t.fields.size() <= 256 ? WordKind::kEnum : WordKind::kInt;
    case TypeKind::kInt:
    case TypeKind::kError:
    case TypeKind::kVariable:
    case TypeKind::kRecord:
    case TypeKind::kTuple:
      return WordKind::kInt;
    case TypeKind::kString:
    case TypeKind::kStream:
    case TypeKind::kArray:
    case TypeKind::kList:
    case TypeKind::kOpaque:
      break;
  }
  return WordKind::kHandle;
}

void Layout::Kinds(const lang::TypeTable& types, TypeId type, std::vector<WordKind>& kinds) {
  std::vector<TypeId> parts;
  Parts(types, type, parts);
  for (const TypeId part : parts) kinds.push_back(Kind(types, part));
}

Layout::Layout(const Model& model, size_t robots, const Lengths& lengths) : robots_(robots) {
  for (size_t v = 0; v < model.variables.size(); ++v) {
    const Variable& variable = model.variables[v];
    Place place;
    TypeId item = variable.type;
    while (variable.kind != VariableKind::kParam && model.types.Is(item, TypeKind::kArray)) {
      const auto length = lengths.find(model.types[item].length);
      if (length == lengths.end()) break;
      place.dimensions.push_back(length->second);
      place.length = std::max<uint32_t>(1, place.length) * length->second;
      item = model.types[item].parts[0];
    }
    place.item = item;
    place.width = Width(model.types, item);
    place.own = variable.PerRobot();
    place.exists = variable.function < 0 && !model.types.Is(variable.type, TypeKind::kStream);
    const uint32_t words = place.words();
    if (variable.kind == VariableKind::kParam) {
      place.at = params_;
      params_ += words;
    } else {
      place.at = place.own ? block_ : shared_;
      (place.own ? block_ : shared_) += words;
      std::vector<TypeId> parts;
      for (uint32_t i = 0; place.exists && i < std::max<uint32_t>(1, place.length); ++i)
        Parts(model.types, item, parts);
      for (const TypeId part : parts)
        (place.own ? block_slots_ : shared_slots_).push_back({Kind(model.types, part), part});
    }
    places_.push_back(place);
  }
  stopped_ = block_++;
  block_slots_.push_back({WordKind::kBool, {}});
}

}  // namespace rondo::koord::semantics
