#pragma once

#include <cstdint>
#include <string_view>

/// The operators of terms, the elementary functions, and the rewrites that constructors of terms may apply.
namespace rondo::expr {

/// Names the operators of terms. `payload` is what a term has besides its arguments.
enum class Op : uint8_t {
  kBool,      // payload 0 or 1
  kNumber,    // payload indexes the arena's numbers; sort Int or Real
  kMember,    // payload: member of an enumeration
  kVariable,  // payload: symbol without parameters
  kApply,     // payload: symbol
  kNot,
  kAnd,
  kOr,
  kEq,
  kIte,
  kForall,  // payload: number of variables; args: variables, body
  kExists,
  kAdd,
  kMul,
  kDivide,
  kIntDiv,
  kMod,
  kLe,
  kLt,
  kToReal,
  kElementary,  // payload: an Elementary function of reals
  kSelect,
  kStore,
  kRecord,
  kField,  // payload: field
  kListMake,
  kListLength,
  kListAt,
  kListAppend,
  kListRemove,
  kListSet,
  kListInsert,
  kListDrop,
  kListSlice,
};

/// Names the functions of reals that have no exact arithmetic (elementary.def is the table of them). A
/// partial function has no value outside its domain: an atomic formula about it is false there.
///
/// power(x, y) is exp(y log x) for x > 0; 0 for x = 0 < y and 1 for y = 0, whatever x; a product of x's or
/// its reciprocal where y is an integer. Elsewhere (0 to a negative power, a negative base with an exponent
/// that is no integer) it is some number, as 1 / 0 is (docs/adr/0017-powers.md).
enum class Elementary : uint8_t {
#define RONDO_ELEMENTARY(kind, name, other, arity, partial) k##kind,
#include "expr/elementary.def"
#undef RONDO_ELEMENTARY
  kCount_,
};

/// Names every simplification that a constructor of `Arena` may apply.
enum class Rewrite : uint8_t {
  kNotConstant,
  kNotNot,
  kNotComparison,     // not a <= b  ->  b < a
  kJunctionFlatten,   // and(and(a, b), c)  ->  and(a, b, c)
  kJunctionNeutral,   // and(a, true)  ->  a
  kJunctionZero,      // and(a, false)  ->  false
  kJunctionSame,      // and(a, a)  ->  a
  kJunctionOpposite,  // and(a, not a)  ->  false
  kEqReflexive,
  kEqConstants,
  kEqBoolean,   // a = true  ->  a
  kEqOrder,     // b = a  ->  a = b
  kEqRecords,   // (a, b) = (c, d)  ->  a = c and b = d
  kEqDistance,  // a = a + 1  ->  false
  kIteConstant,
  kIteSame,
  kIteNot,      // if not c then a else b  ->  if c then b else a
  kIteBoolean,  // if c then true else b  ->  c or b
  kQuantifierUnused,
  kAddNormal,  // linear normal form: one coefficient per term, one constant
  kMulConstants,
  kMulDistribute,  // 2 * (a + b)  ->  2a + 2b
  kMulOrder,
  kDivideConstant,  // a / 2  ->  0.5 * a
  kIntDivConstants,
  kModConstants,
  kCompareDistance,  // a <= a + 1  ->  true
  kToRealConstant,
  kElementaryConstant,  // sqrt 4  ->  2
  kPowerProduct,        // power(x, 3)  ->  x * x * x;  power(x, -1)  ->  1 / x
  kSelectStore,         // store(a, i, v)[j]  ->  if i = j then v else a[j]
  kStoreStore,          // store(store(a, i, v), i, w)  ->  store(a, i, w)
  kFieldRecord,         // (a, b).0  ->  a
  kFieldIte,            // (if c then r else s).0  ->  if c then r.0 else s.0
  kRecordFields,        // (r.0, r.1)  ->  r
  kLengthMake,
  kAtMake,
  kCount_,
};

/// Returns the name as messages and tests show it.
std::string_view Name(Op op);
std::string_view Name(Elementary function);
/// Returns how many arguments the function takes.
size_t Arity(Elementary function);
std::string_view Name(Rewrite rewrite);

}  // namespace rondo::expr
