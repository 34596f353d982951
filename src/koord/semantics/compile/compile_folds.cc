#include "koord/semantics/compile/compiler.h"

namespace rondo::koord::semantics {

using lang::TypeKind;

// Robot by robot, in order: what is there so far, and the value of the next one.
void Compiler::Fold(ExprId id, const lang::Expr& e) {
  const auto& types = model_.types;
  const FoldKind kind = *FoldOf(e.text);
  const ExprId body = e.args[0];
  const TypeId type = model_.TypeOf(body);
  const bool adds = kind == FoldKind::kCount || kind == FoldKind::kSum;
  const uint32_t width = adds && kind == FoldKind::kCount ? 1 : Width(type);
  const uint32_t robot = FrameOf(model_.domains.at(id).bindings[0][0]);
  const uint32_t end = NewFrame(1);
  const uint32_t value = NewFrame(width);  // so far
  const uint32_t next = NewFrame(width);
  const uint32_t best = NewFrame(1);  // whose value it is
  Constant(0);
  Emit(Op::kSetFrame, robot, 1);
  Constant(FromInt(static_cast<int64_t>(layout_.robots())));
  Emit(Op::kSetFrame, end, 1);
  if (adds) {
    for (uint32_t i = 0; i < width; ++i)
      Constant(types.Is(type, TypeKind::kInt) || kind == FoldKind::kCount ? FromInt(0) : FromFloat(0));
    Emit(Op::kSetFrame, value, width);
  }
  const size_t top = Here();
  Gen(body);
  span_ = e.span;
  if (kind == FoldKind::kCount) {
    const size_t no = Emit(Op::kJumpUnless);
    Emit(Op::kFrame, value, 1);
    Constant(FromInt(1));
    Emit(Op::kAddInt);
    Emit(Op::kSetFrame, value, 1);
    Patch(no);
  } else if (kind == FoldKind::kSum) {
    Emit(Op::kSetFrame, next, width);
    Emit(Op::kFrame, value, width);
    Emit(Op::kFrame, next, width);
    Emit(width > 1 ? Op::kAddPos : types.Is(type, TypeKind::kInt) ? Op::kAddInt : Op::kAddFloat);
    Emit(Op::kSetFrame, value, width);
  } else {
    Emit(Op::kSetFrame, next, 1);
    Emit(Op::kFrame, robot, 1);
    Constant(0);
    Emit(Op::kEqual, 1);
    const size_t first = Emit(Op::kJumpIf);
    const bool least = kind == FoldKind::kMin || kind == FoldKind::kArgmin;
    Emit(Op::kFrame, least ? next : value, 1);
    Emit(Op::kFrame, least ? value : next, 1);
    Emit(types.Is(type, TypeKind::kInt) ? Op::kLessInt : Op::kLessFloat);
    const size_t worse = Emit(Op::kJumpUnless);
    Patch(first);
    Emit(Op::kFrame, next, 1);
    Emit(Op::kSetFrame, value, 1);
    Emit(Op::kFrame, robot, 1);
    Emit(Op::kSetFrame, best, 1);
    Patch(worse);
  }
  Emit(Op::kForNext, robot, end, top);
  const bool whose = kind == FoldKind::kArgmin || kind == FoldKind::kArgmax;
  Emit(Op::kFrame, whose ? best : value, whose ? 1 : width);
}

}  // namespace rondo::koord::semantics
