#include "expr/op.h"

namespace rondo::expr {

std::string_view Name(Op op) {
  switch (op) {
    case Op::kBool:
      return "bool";
    case Op::kNumber:
      return "number";
    case Op::kMember:
      return "member";
    case Op::kVariable:
      return "variable";
    case Op::kApply:
      return "apply";
    case Op::kNot:
      return "not";
    case Op::kAnd:
      return "and";
    case Op::kOr:
      return "or";
    case Op::kEq:
      return "=";
    case Op::kIte:
      return "ite";
    case Op::kForall:
      return "forall";
    case Op::kExists:
      return "exists";
    case Op::kAdd:
      return "+";
    case Op::kMul:
      return "*";
    case Op::kDivide:
      return "/";
    case Op::kIntDiv:
      return "div";
    case Op::kMod:
      return "mod";
    case Op::kLe:
      return "<=";
    case Op::kLt:
      return "<";
    case Op::kToReal:
      return "to_real";
    case Op::kElementary:
      return "elementary";
    case Op::kSelect:
      return "select";
    case Op::kStore:
      return "store";
    case Op::kRecord:
      return "record";
    case Op::kField:
      return "field";
    case Op::kListMake:
      return "list";
    case Op::kListLength:
      return "length";
    case Op::kListAt:
      return "at";
    case Op::kListAppend:
      return "append";
    case Op::kListRemove:
      return "remove";
    case Op::kListSet:
      return "set";
    case Op::kListInsert:
      return "insert";
    case Op::kListDrop:
      return "drop";
    case Op::kListSlice:
      return "slice";
  }
  return "";
}

std::string_view Name(Elementary function) {
  static constexpr std::string_view kNames[] = {
#define RONDO_ELEMENTARY(kind, name, other, arity, partial) name,
#include "expr/elementary.def"
#undef RONDO_ELEMENTARY
      ""};
  return kNames[static_cast<size_t>(function)];
}

size_t Arity(Elementary function) {
  static constexpr size_t kArities[] = {
#define RONDO_ELEMENTARY(kind, name, other, arity, partial) arity,
#include "expr/elementary.def"
#undef RONDO_ELEMENTARY
      0};
  return kArities[static_cast<size_t>(function)];
}

std::string_view Name(Rewrite rewrite) {
  switch (rewrite) {
    case Rewrite::kNotConstant:
      return "not-constant";
    case Rewrite::kNotNot:
      return "not-not";
    case Rewrite::kNotComparison:
      return "not-comparison";
    case Rewrite::kJunctionFlatten:
      return "junction-flatten";
    case Rewrite::kJunctionNeutral:
      return "junction-neutral";
    case Rewrite::kJunctionZero:
      return "junction-zero";
    case Rewrite::kJunctionSame:
      return "junction-same";
    case Rewrite::kJunctionOpposite:
      return "junction-opposite";
    case Rewrite::kEqReflexive:
      return "eq-reflexive";
    case Rewrite::kEqConstants:
      return "eq-constants";
    case Rewrite::kEqBoolean:
      return "eq-boolean";
    case Rewrite::kEqOrder:
      return "eq-order";
    case Rewrite::kEqRecords:
      return "eq-records";
    case Rewrite::kEqDistance:
      return "eq-distance";
    case Rewrite::kIteConstant:
      return "ite-constant";
    case Rewrite::kIteSame:
      return "ite-same";
    case Rewrite::kIteNot:
      return "ite-not";
    case Rewrite::kIteBoolean:
      return "ite-boolean";
    case Rewrite::kQuantifierUnused:
      return "quantifier-unused";
    case Rewrite::kAddNormal:
      return "add-normal";
    case Rewrite::kMulConstants:
      return "mul-constants";
    case Rewrite::kMulDistribute:
      return "mul-distribute";
    case Rewrite::kMulOrder:
      return "mul-order";
    case Rewrite::kDivideConstant:
      return "divide-constant";
    case Rewrite::kIntDivConstants:
      return "intdiv-constants";
    case Rewrite::kModConstants:
      return "mod-constants";
    case Rewrite::kCompareDistance:
      return "compare-distance";
    case Rewrite::kToRealConstant:
      return "to-real-constant";
    case Rewrite::kElementaryConstant:
      return "elementary-constant";
    case Rewrite::kPowerProduct:
      return "power-product";
    case Rewrite::kSelectStore:
      return "select-store";
    case Rewrite::kStoreStore:
      return "store-store";
    case Rewrite::kFieldRecord:
      return "field-record";
    case Rewrite::kFieldIte:
      return "field-ite";
    case Rewrite::kRecordFields:
      return "record-fields";
    case Rewrite::kLengthMake:
      return "length-make";
    case Rewrite::kAtMake:
      return "at-make";
    case Rewrite::kCount_:
      return "";
  }
  return "";
}

}  // namespace rondo::expr
