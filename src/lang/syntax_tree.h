#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/id.h"
#include "diag/source.h"

/// The syntax of types and expressions, common to all of Rondo's languages.
namespace rondo::lang {

/// Names an expression of one ExprPool.
using ExprId = base::Id<struct ExprTag>;

/// Is a type as it is written, such as `float`, `pos[N_sys]`, `List<Task>`: a name, arguments, and one
/// dimension for each pair of brackets.
struct TypeSyntax {
  std::string name;
  diag::Span span;
  std::vector<TypeSyntax> arguments;
  std::vector<ExprId> dimensions;  ///< an invalid id for `[]` and `[*]`
};

/// Says what an expression is, and so what `text`, `args` and `binders` hold.
enum class ExprKind : uint8_t {
  kError,   // reported already
  kInt,     // text
  kFloat,   // text
  kString,  // text, with its quotes
  kBool,    // text: true or false
  kName,    // text
  kPid,
  kField,        // args: base; text: member
  kIndex,        // args: base, index
  kCall,         // args: callee, arguments...
  kUnary,        // text: - or not
  kBinary,       // text: operator
  kList,         // args: items
  kTuple,        // args: items, at least 2
  kQuantifier,   // text: forall or exists; binders; args: body
  kFold,         // text: count, sum, min, max, argmin or argmax; binders; args: body
  kQuantity,     // text: unit; args: a literal number
  kConditional,  // `args[1] if args[0] else args[2]`
  kAny,          // `any text in ...`; args: a list, or the first and the last whole number
};

/// Is the name of the function that `l[a:b]` calls, with the arguments l, a and b, or l and a for
/// `l[a:]`; no program can write it.
inline constexpr std::string_view kSlice = "[:]";

/// Is a group of bound variables, `i, j in ID`: their domain is a type if `type` has a name, else the
/// expression `domain`.
struct Binder {
  std::vector<std::string> names;
  std::vector<diag::Span> spans;  ///< of the names
  TypeSyntax type;
  ExprId domain;
};

/// Is one node of a syntax tree; nothing is known of types and names yet.
struct Expr {
  ExprKind kind = ExprKind::kError;
  diag::Span span;
  std::string text;
  std::vector<ExprId> args;
  std::vector<Binder> binders;
};

/// Owns the expressions of one parse. An id is valid for as long as its pool.
class ExprPool {
 public:
  ExprId Add(Expr expr) {
    exprs_.push_back(std::move(expr));
    return ExprId(exprs_.size() - 1);
  }
  const Expr& operator[](ExprId id) const { return exprs_[id.index()]; }
  size_t size() const { return exprs_.size(); }

 private:
  std::vector<Expr> exprs_;
};

}  // namespace rondo::lang
