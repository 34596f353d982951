#include "koord/semantics/compile/element.h"

namespace rondo::koord::semantics {

std::optional<Element> ElementOf(const Model& model, const Layout& layout, ExprId target) {
  const lang::ExprPool& exprs = model.program->exprs;
  Element element{0, {}};
  while (exprs[target].kind == lang::ExprKind::kIndex && model.RefOf(target).kind == RefKind::kNone) {
    element.indices.insert(element.indices.begin(), exprs[target].args[1]);
    target = exprs[target].args[0];
  }
  const Ref root = model.RefOf(target);
  if (root.kind != RefKind::kVariable || model.variables[root.index].kind == VariableKind::kAllread ||
      element.indices.empty() || element.indices.size() > layout[root.index].dimensions.size())
    return std::nullopt;
  element.variable = root.index;
  return element;
}

}  // namespace rondo::koord::semantics
