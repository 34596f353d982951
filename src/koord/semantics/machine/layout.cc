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

void Layout::Kinds(const lang::TypeTable& types, TypeId type, std::vector<WordKind>& kinds) {
  const lang::Type& t = types[type];
  switch (t.kind) {
    case TypeKind::kRecord:
    case TypeKind::kTuple:
      for (const TypeId part : t.parts) Kinds(types, part, kinds);
      return;
    case TypeKind::kBool:
      return kinds.push_back(WordKind::kBool);
    case TypeKind::kFloat:
      return kinds.push_back(WordKind::kFloat);
    case TypeKind::kEnum:
      return kinds.push_back(t.fields.size() <= 256 ? WordKind::kEnum : WordKind::kInt);
    case TypeKind::kInt:
    case TypeKind::kError:
    case TypeKind::kVariable:
      return kinds.push_back(WordKind::kInt);
    case TypeKind::kString:
    case TypeKind::kStream:
    case TypeKind::kArray:
    case TypeKind::kList:
    case TypeKind::kOpaque:
      return kinds.push_back(WordKind::kHandle);
  }
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
      std::vector<WordKind>& kinds = place.own ? block_kinds_ : shared_kinds_;
      for (uint32_t i = 0; place.exists && i < std::max<uint32_t>(1, place.length); ++i)
        Kinds(model.types, item, kinds);
    }
    places_.push_back(place);
  }
  stopped_ = block_++;
  block_kinds_.push_back(WordKind::kBool);
}

}  // namespace rondo::koord::semantics
