#include <algorithm>
#include <utility>

#include "base/check.h"
#include "koord/check/targets.h"
#include "koord/semantics/compile/compiler.h"

namespace rondo::koord::semantics {

using lang::ExprKind;
using lang::TypeKind;

void Compiler::Body(const std::vector<Stmt>& body) {
  for (const Stmt& stmt : body) Execute(stmt);
}

void Compiler::Mark(const Stmt* stmt, bool otherwise) {
  Emit(Op::kMark, branches_.size());
  branches_.emplace_back(stmt, otherwise);
}

void Compiler::Execute(const Stmt& stmt) {
  span_ = stmt.span;
  switch (stmt.kind) {
    case StmtKind::kAssign:
      GenAs(stmt.value, model_.TypeOf(stmt.target));
      span_ = stmt.span;
      return Assign(stmt.target);
    case StmtKind::kAddAssign:
    case StmtKind::kIncrement: {
      const TypeId type = model_.TypeOf(stmt.target);
      Gen(stmt.target);
      if (stmt.kind == StmtKind::kIncrement)
        Constant(model_.types.Is(type, TypeKind::kInt) ? FromInt(1) : FromFloat(1));
      else
        GenAs(stmt.value, type);
      span_ = stmt.span;
      if (model_.types.Is(type, TypeKind::kString)) {
        if (!model_.types.Is(model_.TypeOf(stmt.value), TypeKind::kString)) {
          logged_.push_back(model_.TypeOf(stmt.value));
          Emit(Op::kShow, logged_.size() - 1, Width(model_.TypeOf(stmt.value)));
        }
        Emit(Op::kConcatenate);
      } else {
        Emit(model_.types.Is(type, TypeKind::kInt)     ? Op::kAddInt
             : model_.types.Is(type, TypeKind::kFloat) ? Op::kAddFloat
                                                       : Op::kAddPos);
      }
      return Assign(stmt.target);
    }
    case StmtKind::kLocal: {
      const uint32_t binding = model_.bound_by.at(&stmt)[0];
      const TypeId type = model_.bindings[binding].type;
      GenAs(stmt.value, type);
      span_ = stmt.span;
      Emit(Op::kSetFrame, FrameOf(binding), Width(type));
      return;
    }
    case StmtKind::kPass:
      return;
    case StmtKind::kCall:
      return Method(stmt);
    case StmtKind::kStream:
      return Log(stmt);
    case StmtKind::kStop:
      Emit(Op::kStop);
      returns_.push_back(Emit(Op::kJump));
      return;
    case StmtKind::kBreak:
      loops_.back().breaks.push_back(Emit(Op::kJump));
      return;
    case StmtKind::kContinue:
      loops_.back().continues.push_back(Emit(Op::kJump));
      return;
    case StmtKind::kReturn:
      if (function_ < 0) {
        returns_.push_back(Emit(Op::kJump));
        return;
      }
      if (stmt.value.valid()) {
        GenAs(stmt.value, model_.functions[static_cast<size_t>(function_)].result);
      } else {
        Emit(Op::kFault, static_cast<size_t>(Fault::kReturn));
        const uint32_t width = Width(model_.functions[static_cast<size_t>(function_)].result);
        for (uint32_t i = 0; i < width; ++i) Constant(0);
      }
      Emit(Op::kReturn);
      return;
    case StmtKind::kIf:
      return If(stmt);
    case StmtKind::kForIn:
      return LoopIn(stmt);
    case StmtKind::kForRange:
      return LoopRange(stmt);
    case StmtKind::kWhile:
      return LoopWhile(stmt);
    case StmtKind::kAtomic:
      Emit(Op::kLock);
      locks_ = true;
      return Body(stmt.body);
  }
}

// One line for each statement: of several values, their texts one behind the other.
void Compiler::Log(const Stmt& stmt) {
  const bool one = stmt.operands.size() == 1;
  const TypeId type = one ? model_.TypeOf(stmt.operands[0]) : model_.types.string();
  for (const ExprId e : stmt.operands) {
    Gen(e);
    if (one) break;
    if (!model_.types.Is(model_.TypeOf(e), TypeKind::kString)) {
      logged_.push_back(model_.TypeOf(e));
      Emit(Op::kShow, logged_.size() - 1, Width(model_.TypeOf(e)));
    }
    if (e != stmt.operands.front()) Emit(Op::kConcatenate);
  }
  logged_.push_back(type);
  Emit(Op::kLog, logged_.size() - 1, Width(type));
}

void Compiler::If(const Stmt& stmt) {
  Gen(stmt.value);
  const size_t otherwise = Emit(Op::kJumpUnless);
  Mark(&stmt, false);
  Body(stmt.body);
  const size_t out = Emit(Op::kJump);
  Patch(otherwise);
  Mark(&stmt, true);
  Body(stmt.orelse);
  Patch(out);
}

// The index is in the frame, `before` ends are jumps that leave the loop.
void Compiler::LoopBody(const Stmt& stmt, uint32_t index, uint32_t end, const std::vector<size_t>& before) {
  const size_t top = before.front();
  Body(stmt.body);
  LoopJumps jumps = std::move(loops_.back());
  loops_.pop_back();
  for (const size_t jump : jumps.continues) Patch(jump);
  Emit(Op::kForNext, index, end, top);
  for (const size_t jump : jumps.breaks) Patch(jump);
  Patch(before.back());
}

void Compiler::LoopRange(const Stmt& stmt) {
  const uint32_t variable = FrameOf(model_.bound_by.at(&stmt)[0]);
  const uint32_t index = NewFrame(1);
  const uint32_t end = NewFrame(1);
  Gen(stmt.value);
  Gen(stmt.operands[0]);
  Emit(Op::kSetFrame, end, 1);
  Emit(Op::kSetFrame, index, 1);
  Emit(Op::kFrame, index, 1);
  Emit(Op::kFrame, end, 1);
  Emit(Op::kLessInt);
  const size_t empty = Emit(Op::kJumpUnless);
  const size_t top = Here();
  Emit(Op::kFrame, index, 1);
  Emit(Op::kSetFrame, variable, 1);
  loops_.emplace_back();
  LoopBody(stmt, index, end, {top, empty});
}

// A counter beside the condition: a loop that is repeated more often than it says has no value.
void Compiler::LoopWhile(const Stmt& stmt) {
  const uint32_t index = NewFrame(1);
  const uint32_t end = NewFrame(1);
  Gen(stmt.operands[0]);
  Emit(Op::kSetFrame, end, 1);
  Constant(0);
  Emit(Op::kSetFrame, index, 1);
  const size_t top = Here();
  Gen(stmt.value);
  const size_t out = Emit(Op::kJumpUnless);
  Emit(Op::kFrame, index, 1);
  Emit(Op::kFrame, end, 1);
  Emit(Op::kLessInt);
  const size_t full = Emit(Op::kJumpUnless);
  loops_.emplace_back();
  Body(stmt.body);
  const LoopJumps jumps = std::move(loops_.back());
  loops_.pop_back();
  for (const size_t jump : jumps.continues) Patch(jump);
  Emit(Op::kForNext, index, end, top);
  Gen(stmt.value);
  const size_t done = Emit(Op::kJumpUnless);
  Patch(full);
  span_ = stmt.span;
  Emit(Op::kFault, static_cast<size_t>(Fault::kLoop));
  Patch(done);
  Patch(out);
  for (const size_t jump : jumps.breaks) Patch(jump);
}

void Compiler::LoopIn(const Stmt& stmt) {
  const TypeId type = model_.TypeOf(stmt.value);
  const TypeId element = model_.types[type].parts[0];
  const uint32_t list = NewFrame(1);
  const uint32_t index = NewFrame(1);
  const uint32_t end = NewFrame(1);
  Gen(stmt.value);
  span_ = stmt.span;
  Emit(Op::kSetFrame, list, 1);
  Emit(Op::kFrame, list, 1);
  Emit(Op::kListLength, Width(element));
  Emit(Op::kSetFrame, end, 1);
  Constant(0);
  Emit(Op::kSetFrame, index, 1);
  Constant(0);
  Emit(Op::kFrame, end, 1);
  Emit(Op::kLessInt);
  const size_t empty = Emit(Op::kJumpUnless);
  const size_t top = Here();
  Emit(Op::kFrame, list, 1);
  Emit(Op::kFrame, index, 1);
  Emit(Op::kListAt, Width(element));
  const std::vector<uint32_t>& variables = model_.bound_by.at(&stmt);
  for (size_t i = variables.size(); i-- > 0;)
    Emit(Op::kSetFrame, FrameOf(variables[i]), Width(model_.bindings[variables[i]].type));
  loops_.emplace_back();
  LoopBody(stmt, index, end, {top, empty});
}

void Compiler::Method(const Stmt& stmt) {
  const Ref ref = model_.RefOf(stmt.value);
  const lang::Expr& call = exprs_[stmt.value];
  const auto builtin = ref.kind == RefKind::kBuiltin ? static_cast<Builtin>(ref.index) : Builtin::kPos;
  if (!WritesList(builtin)) {
    Gen(stmt.value);
    Emit(Op::kPop, Width(model_.TypeOf(stmt.value)));
    return;
  }
  const ExprId target = exprs_[call.args[0]].args[0];
  const TypeId element = model_.types[model_.TypeOf(target)].parts[0];
  if (builtin == Builtin::kClear) {
    Emit(Op::kListMake, 0, Width(element));
    return Assign(target);
  }
  Gen(target);
  switch (builtin) {
    case Builtin::kInsert:
      Gen(call.args[1]);
      GenAs(call.args[2], element);
      break;
    case Builtin::kPop:
      if (call.args.size() > 1)
        Gen(call.args[1]);
      else
        Constant(0);
      break;
    default:
      GenAs(call.args[1], element);
  }
  span_ = stmt.span;
  Emit(builtin == Builtin::kAppend   ? Op::kListAppend
       : builtin == Builtin::kInsert ? Op::kListInsert
       : builtin == Builtin::kPop    ? Op::kListDrop
                                     : Op::kListRemove,
       Width(element));
  Assign(target);
}

// Writes the value on the stack: a member or item of a variable is a change of the whole.
void Compiler::Assign(ExprId target) {
  const lang::Expr& e = exprs_[target];
  const Ref ref = model_.RefOf(target);
  if (ref.kind == RefKind::kVariable || ref.kind == RefKind::kCell) {
    assigned_.insert(ref.index);
    return Store(ref.index);
  }
  if (ref.kind == RefKind::kBinding) {
    Emit(Op::kSetFrame, FrameOf(ref.index), Width(model_.bindings[ref.index].type));
    return;
  }
  const ExprId inner = e.args[0];
  const TypeId whole = model_.TypeOf(inner);
  if (e.kind == ExprKind::kField) {
    Gen(inner);
    Emit(Op::kReplace, FieldOffset(whole, ref.index), Width(model_.TypeOf(target)), Width(whole));
    return Assign(inner);
  }
  CHECK(e.kind == ExprKind::kIndex);
  // A cell of an array, or an array of cells, is written by itself.
  if (const auto element = ElementOf(model_, layout_, target)) {
    const Layout::Place& place = layout_[element->variable];
    const size_t depth = element->indices.size();
    const size_t words = ItemsBehind(place, depth) * place.width;
    if (depth < place.dimensions.size()) Emit(Op::kUnpack, ShapeBehind(place, depth), words);
    FlatIndex(*element);
    span_ = e.span;
    Emit(place.own ? Op::kSetOwnAt : Op::kSetGlobalAt, place.at, words, place.words() / words, place.width);
    return;
  }
  Gen(inner);
  Gen(e.args[1]);
  span_ = e.span;
  Emit(Op::kListSet, Width(model_.TypeOf(target)));
  Assign(inner);
}

void Compiler::Store(size_t v) {
  const Layout::Place& place = layout_[v];
  if (!place.exists) return Fail(span_, "a stream is not a variable");
  if (place.dimensions.size() == 1) {
    Emit(place.own ? Op::kSetOwnArray : Op::kSetGlobalArray, place.at, place.width, place.length);
  } else if (model_.variables[v].kind == VariableKind::kParam) {
    Emit(Op::kSetParam, place.at, place.width);
  } else {
    if (place.length > 0) Emit(Op::kUnpack, ShapeBehind(place, 0), place.words());
    Emit(place.own ? Op::kSetOwn : Op::kSetGlobal, place.at, place.words(), 0,
         place.length > 0 ? place.width : 0);
  }
}

}  // namespace rondo::koord::semantics
