#include "sim/campaign/noise.h"

#include "base/mixed.h"

namespace rondo::sim::campaign {

using koord::semantics::Layout;
using koord::semantics::WordKind;

void Noise::Read(size_t robot, uint64_t, koord::node::Cell cell, std::span<koord::semantics::Word> words) {
  const lang::TypeId type = team_.layout()[cell.variable].item;
  const lang::Type& shape = team_.model().types[type];
  std::vector<WordKind> kinds;
  Layout::Kinds(team_.model().types, type, kinds);
  const uint64_t read = base::Mixed(static_cast<uint64_t>(now_) + robot * 64 + uint64_t{cell.variable} * 8);
  for (size_t i = 0; i < words.size() && i < kinds.size(); ++i) {
    const uint64_t x = base::Mixed(seed_ ^ base::Mixed(read + i));
    switch (kinds[i]) {
      case WordKind::kBool:
        words[i] = x & 1;
        break;
      case WordKind::kInt:
        words[i] = x % 8;
        break;
      case WordKind::kFloat:
        words[i] = koord::semantics::FromFloat(static_cast<double>(x % 2000) / 100 - 10);
        break;
      case WordKind::kEnum:
        if (shape.kind == lang::TypeKind::kEnum && !shape.fields.empty()) words[i] = x % shape.fields.size();
        break;
      case WordKind::kHandle:
        break;
    }
  }
}

}  // namespace rondo::sim::campaign
