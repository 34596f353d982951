#include <charconv>
#include <cmath>
#include <cstdlib>

#include "base/check.h"
#include "expr/rational.h"
#include "koord/semantics/compile/compiler.h"
#include "lang/expr_queries.h"

namespace rondo::koord::semantics {

using lang::ExprKind;
using lang::TypeKind;

// A list literal of ints may stand where a list of floats is needed.
void Compiler::GenAs(ExprId id, TypeId type) {
  const lang::Expr& e = exprs_[id];
  const bool sequence = model_.types.Is(type, TypeKind::kList) || model_.types.Is(type, TypeKind::kArray);
  if (e.kind == ExprKind::kList && sequence) {
    const TypeId element = model_.types[type].parts[0];
    for (const ExprId item : e.args) GenAs(item, element);
    span_ = e.span;
    Emit(Op::kListMake, e.args.size(), Width(element));
    return;
  }
  Gen(id);
  Convert(model_.TypeOf(id), type);
}

void Compiler::Convert(TypeId from, TypeId to) {
  if (model_.types.Is(from, TypeKind::kInt) && model_.types.Is(to, TypeKind::kFloat)) Emit(Op::kToFloat, 0);
}

uint32_t Compiler::FieldOffset(TypeId record, uint32_t field) const {
  uint32_t offset = 0;
  for (uint32_t i = 0; i < field; ++i) offset += Width(model_.types[record].parts[i]);
  return offset;
}

void Compiler::Gen(ExprId id) {
  const lang::Expr& e = exprs_[id];
  const Ref ref = model_.RefOf(id);
  span_ = e.span;
  switch (e.kind) {
    case ExprKind::kError:
    case ExprKind::kQuantity:
      break;
    case ExprKind::kInt: {
      int64_t number = 0;
      const auto [end, problem] = std::from_chars(e.text.data(), e.text.data() + e.text.size(), number);
      if (problem != std::errc() || end != e.text.data() + e.text.size())
        return Fail(e.span, "this number has more than 64 bits");
      return Constant(FromInt(number));
    }
    case ExprKind::kFloat: {
      // The nearest double.
      const double number = std::strtod(e.text.c_str(), nullptr);
      if (!std::isfinite(number)) return Fail(e.span, "this number is too large for a double");
      const auto exact = expr::Rational::Parse(e.text);
      code_.rounded_literals =
          code_.rounded_literals || !exact || !(expr::Rational::FromDouble(number) == *exact);
      return Constant(FromFloat(number + 0.0));
    }
    case ExprKind::kString:
      return Constant(heap_.InternText(lang::Unquoted(e.text)));
    case ExprKind::kBool:
      return Constant(e.text == "true" || e.text == "True");
    case ExprKind::kPid:
      used_robot_ = true;
      Emit(Op::kRobot);
      return;
    case ExprKind::kName:
    case ExprKind::kField:
    case ExprKind::kIndex:
      switch (ref.kind) {
        case RefKind::kVariable:
          return ReadVariable(ref.index);
        case RefKind::kCell:
          Gen(e.args[1]);
          return ReadCell(ref.index);
        case RefKind::kPortOf:
          Gen(exprs_[e.args[0]].args[1]);
          return ReadCell(ref.index);
        case RefKind::kBinding:
          Emit(Op::kFrame, FrameOf(ref.index), Width(model_.bindings[ref.index].type));
          return;
        case RefKind::kMember:
          return Constant(ref.index);
        case RefKind::kStopped:
          Gen(e.args[1]);
          span_ = e.span;
          Emit(Op::kCell, layout_.stopped(), 1);
          return;
        case RefKind::kSystemSize:
          return Constant(FromInt(static_cast<int64_t>(layout_.robots())));
        case RefKind::kOpaqueField:
          Gen(e.args[0]);
          return CallPlain(ref.index, 1, Width(model_.functions[ref.index].result));
        case RefKind::kFunction:
        case RefKind::kBuiltin:
        case RefKind::kNone:
          break;
      }
      if (e.kind == ExprKind::kField) return Slice(e.args[0], ref.index);
      CHECK(e.kind == ExprKind::kIndex) << "an unresolved name got past the checker: " << e.text;
      return Index(id);
    case ExprKind::kCall:
      return Call(id, e);
    case ExprKind::kUnary:
      return Unary(e);
    case ExprKind::kBinary:
      return Binary(id, e);
    case ExprKind::kList:
      return GenAs(id, model_.TypeOf(id));
    case ExprKind::kTuple:
      for (const ExprId item : e.args) Gen(item);
      return;
    case ExprKind::kQuantifier:
      return Quantifier(id, e);
    case ExprKind::kFold:
      return Fold(id, e);
    case ExprKind::kConditional:
      return Conditional(id, e);
    case ExprKind::kAny:
      for (const ExprId arg : e.args) Gen(arg);
      span_ = e.span;
      if (e.args.size() > 1) {
        Emit(Op::kAnyInt);
      } else {
        Emit(Op::kAnyItem, Width(model_.TypeOf(id)));
      }
      return;
  }
  CHECK(false) << "an erroneous expression got past the checker";
}

void Compiler::Slice(ExprId base, uint32_t field) {
  Gen(base);
  const TypeId record = model_.TypeOf(base);
  const uint32_t offset = FieldOffset(record, field);
  const uint32_t width = Width(model_.types[record].parts[field]);
  const uint32_t whole = Width(record);
  // A member of a variable is read directly.
  Instruction& last = code_.instructions.back();
  const bool direct = last.op == Op::kGlobal || last.op == Op::kOwn || last.op == Op::kCell ||
                      last.op == Op::kFrame || last.op == Op::kParam;
  if (direct && last.b == whole) {
    last.a += offset;
    last.b = width;
    return;
  }
  if (width != whole) Emit(Op::kSlice, offset, width, whole);
}

void Compiler::ReadVariable(size_t v) {
  const Variable& variable = model_.variables[v];
  const Layout::Place& place = layout_[v];
  if (!place.exists) return Fail(span_, "a stream has no value");
  if (variable.kind == VariableKind::kParam) {
    Emit(Op::kParam, place.at, place.width);
  } else if (variable.kind == VariableKind::kAllread && place.length > 0) {
    for (size_t r = 0; r < layout_.robots(); ++r) {
      Constant(FromInt(static_cast<int64_t>(r)));
      ReadCell(v);
    }
    Emit(Op::kListMake, layout_.robots(), 1);
  } else if (variable.kind == VariableKind::kAllread) {
    Emit(Op::kRow, place.at, place.width);
  } else {
    used_robot_ = used_robot_ || place.own;
    if (place.dimensions.size() == 1) {
      Emit(place.own ? Op::kOwnArray : Op::kGlobalArray, place.at, place.width, place.length);
      return;
    }
    Emit(place.own ? Op::kOwn : Op::kGlobal, place.at, place.words());
    if (place.length > 0) Emit(Op::kPack, ShapeBehind(place, 0), place.words());
  }
}

// The robot is on the stack.
void Compiler::ReadCell(size_t v) {
  const Layout::Place& place = layout_[v];
  if (place.dimensions.size() == 1) {
    Emit(Op::kCellArray, place.at, place.width, place.length);
    return;
  }
  if (place.length > 0) {
    Emit(Op::kCell, place.at, place.words());
    Emit(Op::kPack, ShapeBehind(place, 0), place.words());
    return;
  }
  // The robot's own cell.
  if (code_.instructions.back().op == Op::kRobot) {
    code_.instructions.back() = {Op::kOwn, place.at, place.width, 0};
    return;
  }
  Emit(Op::kCell, place.at, place.width);
}

void Compiler::FlatIndex(const Element& element) {
  const Layout::Place& place = layout_[element.variable];
  for (size_t i = 0; i < element.indices.size(); ++i) {
    Gen(element.indices[i]);
    span_ = exprs_[element.indices[i]].span;
    if (i > 0) Emit(Op::kFlatIndex, place.dimensions[i]);
  }
}

size_t Compiler::ItemsBehind(const Layout::Place& place, size_t indices) const {
  size_t items = 1;
  for (size_t i = indices; i < place.dimensions.size(); ++i) items *= place.dimensions[i];
  return items;
}

size_t Compiler::ShapeBehind(const Layout::Place& place, size_t indices) {
  code_.shapes.push_back(
      {{place.dimensions.begin() + static_cast<ptrdiff_t>(indices), place.dimensions.end()}, place.width});
  return code_.shapes.size() - 1;
}

void Compiler::Index(ExprId id) {
  const lang::Expr& e = exprs_[id];
  const TypeId base = model_.TypeOf(e.args[0]);
  if (const auto element = ElementOf(model_, layout_, id)) {
    const Layout::Place& place = layout_[element->variable];
    const size_t depth = element->indices.size();
    const size_t words = ItemsBehind(place, depth) * place.width;
    FlatIndex(*element);
    span_ = e.span;
    used_robot_ = used_robot_ || place.own;
    Emit(place.own ? Op::kOwnAt : Op::kGlobalAt, place.at, words, place.words() / words);
    if (depth < place.dimensions.size()) Emit(Op::kPack, ShapeBehind(place, depth), words);
    return;
  }
  Gen(e.args[0]);
  Gen(e.args[1]);
  span_ = e.span;
  const lang::Type& type = model_.types[base];
  if (type.kind != TypeKind::kList && type.kind != TypeKind::kArray)
    return Fail(e.span, "nothing tells its type");
  Emit(Op::kListAt, Width(type.parts[0]));
}

void Compiler::Unary(const lang::Expr& e) {
  Gen(e.args[0]);
  span_ = e.span;
  const TypeId type = model_.TypeOf(e.args[0]);
  if (e.text == "not")
    Emit(Op::kNot);
  else if (model_.types.Is(type, TypeKind::kInt))
    Emit(Op::kNegInt);
  else
    Emit(model_.types.Is(type, TypeKind::kFloat) ? Op::kNegFloat : Op::kNegPos);
}

void Compiler::Binary(ExprId id, const lang::Expr& e) {
  if (e.text == "in" || e.text == "not in") {
    Membership(e);
    if (e.text == "not in") Emit(Op::kNot);
    return;
  }
  if (e.text == "and" || e.text == "or" || e.text == "implies") return Junction(e);
  if (e.text == "==" || e.text == "!=" || e.text[0] == '<' || e.text[0] == '>') return Comparison(e);
  Arithmetic(id, e);
}

void Compiler::Junction(const lang::Expr& e) {
  Gen(e.args[0]);
  if (e.text == "implies") Emit(Op::kNot);
  const size_t decided = Emit(e.text == "and" ? Op::kJumpUnless : Op::kJumpIf);
  Gen(e.args[1]);
  const size_t out = Emit(Op::kJump);
  Patch(decided);
  Constant(e.text != "and");
  Patch(out);
}

void Compiler::Conditional(ExprId id, const lang::Expr& e) {
  const TypeId type = model_.TypeOf(id);
  Gen(e.args[0]);
  const size_t otherwise = Emit(Op::kJumpUnless);
  GenAs(e.args[1], type);
  const size_t out = Emit(Op::kJump);
  Patch(otherwise);
  GenAs(e.args[2], type);
  Patch(out);
  // The whole value again, so that what comes next does not take the last instruction for the only one that made it.
  Emit(Op::kSlice, 0, Width(type), Width(type));
}

void Compiler::Comparison(const lang::Expr& e) {
  const TypeId left = model_.TypeOf(e.args[0]);
  const TypeId right = model_.TypeOf(e.args[1]);
  const bool floats = model_.types.Is(left, TypeKind::kFloat) || model_.types.Is(right, TypeKind::kFloat);
  // An empty list literal has the type of the other side.
  const bool untyped = model_.types.HasVariable(left);
  const TypeId type = floats ? model_.types.real() : untyped ? right : left;
  const bool swap = e.text[0] == '>';
  GenAs(e.args[swap ? 1 : 0], type);
  GenAs(e.args[swap ? 0 : 1], type);
  span_ = e.span;
  if (e.text == "==" || e.text == "!=") {
    Emit(Op::kEqual, Width(type));
    if (e.text == "!=") Emit(Op::kNot);
    return;
  }
  const bool strict = e.text.size() == 1;
  if (floats || model_.types.Is(type, TypeKind::kFloat))
    Emit(strict ? Op::kLessFloat : Op::kLessEqualFloat);
  else
    Emit(strict ? Op::kLessInt : Op::kLessEqualInt);
}

void Compiler::Arithmetic(ExprId id, const lang::Expr& e) {
  const auto& types = model_.types;
  const TypeId type = model_.TypeOf(id);
  if (types.Is(type, TypeKind::kString)) {
    for (const ExprId arg : e.args) {
      Gen(arg);
      if (types.Is(model_.TypeOf(arg), TypeKind::kString)) continue;
      logged_.push_back(model_.TypeOf(arg));
      Emit(Op::kShow, logged_.size() - 1, Width(model_.TypeOf(arg)));
    }
    Emit(Op::kConcatenate);
    return;
  }
  const char op = e.text[0];
  if (types.Is(type, TypeKind::kRecord)) {
    for (const ExprId arg : e.args) {
      Gen(arg);
      if (types.Is(model_.TypeOf(arg), TypeKind::kRecord)) continue;
      Convert(model_.TypeOf(arg), types.real());
      Emit(Op::kSplat);
    }
    span_ = e.span;
    Emit(op == '+' ? Op::kAddPos : op == '-' ? Op::kSubPos : op == '*' ? Op::kMulPos : Op::kDivPos);
    return;
  }
  for (const ExprId arg : e.args) GenAs(arg, type);
  span_ = e.span;
  if (types.Is(type, TypeKind::kInt)) {
    Emit(op == '+'   ? Op::kAddInt
         : op == '-' ? Op::kSubInt
         : op == '*' ? Op::kMulInt
         : op == '/' ? Op::kDivInt
                     : Op::kModInt);
    return;
  }
  Emit(op == '+' ? Op::kAddFloat : op == '-' ? Op::kSubFloat : op == '*' ? Op::kMulFloat : Op::kDivFloat);
}

void Compiler::Membership(const lang::Expr& e) {
  const lang::Expr& set = exprs_[e.args[1]];
  const Ref ref = model_.RefOf(e.args[1]);
  if (ref.kind == RefKind::kBuiltin && static_cast<Builtin>(ref.index) == Builtin::kRect) {
    Gen(e.args[0]);
    Gen(set.args[1]);
    Gen(set.args[2]);
    Emit(Op::kInRect);
    return;
  }
  if (set.kind == ExprKind::kName && ref.kind == RefKind::kNone) {
    Gen(e.args[0]);
    Emit(Op::kIsRobot);
    return;
  }
  const TypeId element = model_.types[model_.TypeOf(e.args[1])].parts[0];
  Gen(e.args[1]);
  GenAs(e.args[0], element);
  Emit(Op::kListContains, Width(element));
}

}  // namespace rondo::koord::semantics
