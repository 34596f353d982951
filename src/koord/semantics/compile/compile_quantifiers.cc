#include "koord/semantics/compile/compiler.h"

namespace rondo::koord::semantics {

using lang::TypeKind;

void Compiler::Range(const std::vector<Limit>& limits, Op pick, uint32_t slot) {
  for (size_t i = 0; i < limits.size(); ++i) {
    Gen(limits[i].value);
    if (limits[i].plus != 0) {
      Constant(FromInt(limits[i].plus));
      Emit(Op::kAddInt);
    }
    if (i > 0) Emit(pick);
  }
  Emit(Op::kSetFrame, slot, 1);
}

void Compiler::Quantifier(ExprId id, const lang::Expr& e) {
  const bool forall = e.text == "forall";
  std::vector<size_t> decided;
  Loop(BoundsOf(model_, id), 0, e.args[0], forall, decided);
  Constant(forall);
  const size_t out = Emit(Op::kJump);
  for (const size_t jump : decided) Patch(jump);
  Constant(!forall);
  Patch(out);
}

// Leaves by one of the jumps `decided` if an instance decides the quantifier, else falls through.
void Compiler::Loop(const std::vector<Bound>& all, size_t i, ExprId body, bool forall,
                    std::vector<size_t>& decided) {
  if (i == all.size()) {
    Gen(body);
    decided.push_back(Emit(forall ? Op::kJumpUnless : Op::kJumpIf));
    return;
  }
  const Bound& bound = all[i];
  const TypeId type = model_.bindings[bound.binding].type;
  const uint32_t variable = FrameOf(bound.binding);
  const bool over_list = bound.kind == DomainKind::kList;
  const uint32_t index = over_list ? NewFrame(1) : variable;
  const uint32_t end = NewFrame(1);
  const uint32_t list = over_list ? NewFrame(1) : 0;
  Constant(0);
  Emit(Op::kSetFrame, index, 1);
  if (over_list) {
    Gen(bound.list);
    Emit(Op::kSetFrame, list, 1);
    Emit(Op::kFrame, list, 1);
    Emit(Op::kListLength, Width(type));
    Emit(Op::kSetFrame, end, 1);
  } else if (bound.kind == DomainKind::kRobots) {
    Constant(FromInt(static_cast<int64_t>(layout_.robots())));
    Emit(Op::kSetFrame, end, 1);
  } else if (model_.types.Is(type, TypeKind::kBool) || model_.types.Is(type, TypeKind::kEnum)) {
    Constant(model_.types.Is(type, TypeKind::kBool) ? 2 : model_.types[type].fields.size());
    Emit(Op::kSetFrame, end, 1);
  } else if (model_.types.Is(type, TypeKind::kInt)) {
    const Limits limits = LimitsOf(model_, all, i, body, forall);
    if (limits.lower.empty() || limits.upper.empty()) {
      return Fail(model_.bindings[bound.binding].span, "nothing bounds the ints that it is about");
    }
    Range(limits.lower, Op::kMaxInt, index);
    Range(limits.upper, Op::kMinInt, end);
  } else {
    return Fail(model_.bindings[bound.binding].span,
                "it is about all values of `" + model_.types.Name(type) + "`");
  }
  Emit(Op::kFrame, index, 1);
  Emit(Op::kFrame, end, 1);
  Emit(Op::kLessInt);
  const size_t empty = Emit(Op::kJumpUnless);
  const size_t top = Here();
  if (over_list) {
    Emit(Op::kFrame, list, 1);
    Emit(Op::kFrame, index, 1);
    Emit(Op::kListAt, Width(type));
    Emit(Op::kSetFrame, variable, Width(type));
  }
  Loop(all, i + 1, body, forall, decided);
  Emit(Op::kForNext, index, end, top);
  Patch(empty);
}

}  // namespace rondo::koord::semantics
