#include "lang/expr_queries.h"

#include <algorithm>

#include "lang/expr_printer.h"

namespace rondo::lang {

namespace {

// The parts of a conjunction.
void Conjuncts(const ExprPool& pool, ExprId id, std::vector<ExprId>& out) {
  const Expr& e = pool[id];
  if (e.kind == ExprKind::kBinary && e.text == "and") {
    for (const ExprId arg : e.args) Conjuncts(pool, arg, out);
  } else {
    out.push_back(id);
  }
}

}  // namespace

bool MentionsName(const ExprPool& pool, ExprId expr, const std::vector<std::string>& names) {
  const Expr& e = pool[expr];
  if (e.kind == ExprKind::kName && std::ranges::find(names, e.text) != names.end()) return true;
  return std::ranges::any_of(e.args, [&](ExprId arg) { return MentionsName(pool, arg, names); }) ||
         std::ranges::any_of(e.binders, [&](const Binder& b) {
           return b.domain.valid() && MentionsName(pool, b.domain, names);
         });
}

std::vector<ExprId> SuppositionsOf(const ExprPool& pool, ExprId body, bool forall) {
  std::vector<ExprId> parts;
  while (forall && pool[body].kind == ExprKind::kBinary && pool[body].text == "implies") {
    Conjuncts(pool, pool[body].args[0], parts);
    body = pool[body].args[1];
  }
  if (!forall) Conjuncts(pool, body, parts);
  return parts;
}

std::optional<RangeDomain> RangeOf(const ExprPool& pool, const Expr& quantifier) {
  if (quantifier.kind != ExprKind::kQuantifier || quantifier.binders.size() != 1) return std::nullopt;
  const Binder& binder = quantifier.binders[0];
  const Expr& body = pool[quantifier.args[0]];
  const std::string_view word = quantifier.text == "forall" ? "implies" : "and";
  const bool ints = binder.domain.valid() && pool[binder.domain].kind == ExprKind::kName &&
                    pool[binder.domain].text == "int";
  if (!ints || body.kind != ExprKind::kBinary || body.text != word) return std::nullopt;
  RangeDomain range{{}, {}, body.args[1]};
  // (from <= a and a < to) and (from <= b and b < to): the last pair outermost.
  std::vector<ExprId> limits;
  ExprId rest = body.args[0];
  for (size_t i = binder.names.size(); i-- > 0;) {
    if (pool[rest].kind != ExprKind::kBinary || pool[rest].text != "and") return std::nullopt;
    const ExprId pair = i > 0 ? pool[rest].args[1] : rest;
    if (pool[pair].kind != ExprKind::kBinary || pool[pair].text != "and") return std::nullopt;
    limits.insert(limits.begin(), pool[pair].args.begin(), pool[pair].args.end());
    rest = pool[rest].args[0];
  }
  for (size_t i = 0; i < limits.size(); ++i) {
    const bool low = i % 2 == 0;
    const Expr& e = pool[limits[i]];
    if (e.kind != ExprKind::kBinary || e.text != (low ? "<=" : "<")) return std::nullopt;
    const Expr& variable = pool[e.args[low ? 1 : 0]];
    if (variable.kind != ExprKind::kName || variable.text != binder.names[i / 2]) return std::nullopt;
    ExprId& limit = low ? range.from : range.to;
    const ExprId other = e.args[low ? 0 : 1];
    if (limit.valid() && PrintExpr(pool, limit) != PrintExpr(pool, other)) return std::nullopt;
    limit = other;
  }
  // A variable in its own limits is bound by the quantifier, and none of a range.
  const bool own = MentionsName(pool, range.from, binder.names) || MentionsName(pool, range.to, binder.names);
  return own ? std::nullopt : std::optional(range);
}

std::string Unquoted(const std::string& literal) {
  std::string result;
  for (size_t i = 1; i + 1 < literal.size(); ++i) {
    if (literal[i] != '\\' || i + 2 >= literal.size()) {
      result += literal[i];
      continue;
    }
    ++i;
    result += literal[i] == 'n' ? '\n' : literal[i] == 't' ? '\t' : literal[i];
  }
  return result;
}

}  // namespace rondo::lang
