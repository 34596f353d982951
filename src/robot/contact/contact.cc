#include "robot/contact/contact.h"

#include <algorithm>
#include <limits>

#include "robot/contact/solid.h"

namespace rondo::robot {

std::optional<Contact> FindContact(Arena& arena, const Shape& a, const Shape& b,
                                   const expr::Numeric::Point& state) {
  std::vector<TermId> variables = VariablesOf(arena, a);
  for (const TermId v : VariablesOf(arena, b)) {
    if (std::ranges::find(variables, v) == variables.end()) variables.push_back(v);
  }
  std::vector<double> values;
  for (const TermId v : variables) {
    const auto it = state.find(v);
    values.push_back(it == state.end() ? 0 : it->second);
  }
  auto first = Solid::Of(arena, a, variables), second = Solid::Of(arena, b, variables);
  if (!first || !second) return std::nullopt;
  if (!first->Place(values) || !second->Place(values)) return std::nullopt;
  return first->With(*second, std::numeric_limits<double>::infinity());
}

}  // namespace rondo::robot
