#include "lang/expr_json.h"

#include <nlohmann/json.hpp>

#include "lang/expr_printer.h"

namespace rondo::lang {

nlohmann::json ExprToJson(const diag::SourceSet& sources, const ExprPool& pool, ExprId id) {
  constexpr const char* kNames[] = {"error", "int",   "float",      "string",  "bool",  "name",
                                    "pid",   "field", "index",      "call",    "unary", "binary",
                                    "list",  "tuple", "quantifier", "quantity"};
  const Expr& e = pool[id];
  const diag::Position p = sources.Locate(e.span.file, e.span.begin);
  nlohmann::json j{{"expr", kNames[static_cast<size_t>(e.kind)]}, {"line", p.line}, {"column", p.column}};
  if (!e.text.empty()) j["text"] = e.text;
  for (const ExprId arg : e.args) j["args"].push_back(ExprToJson(sources, pool, arg));
  for (const Binder& b : e.binders) {
    j["binders"].push_back(
        {{"names", b.names}, {"in", b.domain.valid() ? PrintExpr(pool, b.domain) : PrintType(pool, b.type)}});
  }
  return j;
}

}  // namespace rondo::lang
