#pragma once

#include <optional>
#include <vector>

#include "koord/check/model.h"
#include "koord/semantics/machine/layout.h"

/// Items of arrays that are variables of their own.
namespace rondo::koord::semantics {

/// Represents `a[i][j]` of a variable that lies flat.
struct Element {
  size_t variable;
  std::vector<ExprId> indices;  ///< the outer one first
};

/// Returns which item, or array of items, of a variable an expression is; nothing if it is none. Cells of `allread` arrays are
/// told by their robots, and no items.
std::optional<Element> ElementOf(const Model& model, const Layout& layout, ExprId target);

}  // namespace rondo::koord::semantics
