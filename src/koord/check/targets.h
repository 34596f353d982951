#pragma once

#include "koord/check/model.h"

/// Tells what statements write.
namespace rondo::koord {

/// Returns the part of a target that names the variable: `M.to` of `M.to.x`, `a` of `a[1][2]`.
inline ExprId RootOf(const Model& model, ExprId target) {
  while (model.RefOf(target).kind != RefKind::kVariable && !model.program->exprs[target].args.empty())
    target = model.program->exprs[target].args[0];
  return target;
}

/// Reports whether a method writes the list that it is called on.
constexpr bool WritesList(Builtin method) {
  return method == Builtin::kRemove || method == Builtin::kAppend || method == Builtin::kClear ||
         method == Builtin::kInsert || method == Builtin::kPop;
}

}  // namespace rondo::koord
