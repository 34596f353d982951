#include "lang/expr_json.h"

#include <nlohmann/json.hpp>

#include "lang/expr_printer.h"

namespace rondo::lang {

namespace {

const char* Name(ExprKind kind) {
  switch (kind) {
    case ExprKind::kError:
      return "error";
    case ExprKind::kInt:
      return "int";
    case ExprKind::kFloat:
      return "float";
    case ExprKind::kString:
      return "string";
    case ExprKind::kBool:
      return "bool";
    case ExprKind::kName:
      return "name";
    case ExprKind::kPid:
      return "pid";
    case ExprKind::kField:
      return "field";
    case ExprKind::kIndex:
      return "index";
    case ExprKind::kCall:
      return "call";
    case ExprKind::kUnary:
      return "unary";
    case ExprKind::kBinary:
      return "binary";
    case ExprKind::kList:
      return "list";
    case ExprKind::kTuple:
      return "tuple";
    case ExprKind::kQuantifier:
      return "quantifier";
    case ExprKind::kFold:
      return "fold";
    case ExprKind::kQuantity:
      return "quantity";
    case ExprKind::kConditional:
      return "conditional";
    case ExprKind::kAny:
      return "any";
  }
  return "";
}

}  // namespace

nlohmann::json ExprToJson(const diag::SourceSet& sources, const ExprPool& pool, ExprId id) {
  const Expr& e = pool[id];
  const diag::Position p = sources.Locate(e.span.file, e.span.begin);
  nlohmann::json j{{"expr", Name(e.kind)}, {"line", p.line}, {"column", p.column}};
  if (!e.text.empty()) j["text"] = e.text;
  for (const ExprId arg : e.args) j["args"].push_back(ExprToJson(sources, pool, arg));
  for (const Binder& b : e.binders) {
    j["binders"].push_back(
        {{"names", b.names}, {"in", b.domain.valid() ? PrintExpr(pool, b.domain) : PrintType(pool, b.type)}});
  }
  return j;
}

}  // namespace rondo::lang
