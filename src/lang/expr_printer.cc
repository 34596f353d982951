#include "lang/expr_printer.h"

#include <fmt/format.h>

namespace rondo::lang {
namespace {

// How tightly an expression binds; larger binds tighter.
enum Level : int {
  kConditionalLevel,
  kQuantifierLevel,
  kImpliesLevel,
  kOrLevel,
  kAndLevel,
  kNotLevel,
  kCompareLevel,
  kSumLevel,
  kProductLevel,
  kUnaryLevel,
  kPostfixLevel
};

int LevelOf(const Expr& e) {
  switch (e.kind) {
    case ExprKind::kConditional:
      return kConditionalLevel;
    case ExprKind::kQuantifier:
    case ExprKind::kFold:
      return kQuantifierLevel;
    case ExprKind::kAny:
      return kSumLevel;
    case ExprKind::kUnary:
      return e.text == "not" ? kNotLevel : kUnaryLevel;
    case ExprKind::kBinary:
      if (e.text == "implies") return kImpliesLevel;
      if (e.text == "or") return kOrLevel;
      if (e.text == "and") return kAndLevel;
      if (e.text == "+" || e.text == "-") return kSumLevel;
      if (e.text == "*" || e.text == "/" || e.text == "%") return kProductLevel;
      return kCompareLevel;
    case ExprKind::kError:
    case ExprKind::kInt:
    case ExprKind::kFloat:
    case ExprKind::kString:
    case ExprKind::kBool:
    case ExprKind::kName:
    case ExprKind::kPid:
    case ExprKind::kField:
    case ExprKind::kIndex:
    case ExprKind::kCall:
    case ExprKind::kList:
    case ExprKind::kTuple:
    case ExprKind::kQuantity:
      return kPostfixLevel;
  }
  return kPostfixLevel;
}

class Printer {
 public:
  explicit Printer(const ExprPool& pool) : pool_(pool) {}

  std::string Print(ExprId id, int least) const {
    const Expr& e = pool_[id];
    const std::string text = Bare(e);
    return LevelOf(e) < least ? fmt::format("({})", text) : text;
  }

  std::string Type(const TypeSyntax& type) const {
    std::string text = type.name;
    for (size_t i = 0; i < type.arguments.size(); ++i)
      text += (i == 0 ? "<" : ", ") + Type(type.arguments[i]);
    if (!type.arguments.empty()) text += ">";
    for (const ExprId d : type.dimensions) text += fmt::format("[{}]", d.valid() ? Print(d, 0) : "");
    return text;
  }

 private:
  std::string Items(const Expr& e, size_t from) const {
    std::string text;
    for (size_t i = from; i < e.args.size(); ++i) text += (i == from ? "" : ", ") + Print(e.args[i], 0);
    return text;
  }

  std::string Bare(const Expr& e) const {
    const int level = LevelOf(e);
    switch (e.kind) {
      case ExprKind::kError:
        return "<error>";
      case ExprKind::kInt:
      case ExprKind::kFloat:
      case ExprKind::kString:
      case ExprKind::kBool:
      case ExprKind::kName:
        return e.text;
      case ExprKind::kPid:
        return "pid";
      case ExprKind::kField:
        return fmt::format("{}.{}", Base(e.args[0]), e.text);
      case ExprKind::kIndex:
        return fmt::format("{}[{}]", Base(e.args[0]), Print(e.args[1], 0));
      case ExprKind::kCall:
        if (pool_[e.args[0]].text == kSlice)
          return fmt::format("{}[{}:{}]", Base(e.args[1]), IsZero(e.args[2]) ? "" : Print(e.args[2], 0),
                             e.args.size() > 3 ? Print(e.args[3], 0) : "");
        return fmt::format("{}({})", Base(e.args[0]), Items(e, 1));
      case ExprKind::kUnary:
        return fmt::format("{}{}", e.text == "not" ? "not " : "-", Print(e.args[0], level));
      case ExprKind::kBinary: {
        // `implies` binds to the right, the rest to the left; comparisons do not chain.
        const int left = e.text == "implies" || level == kCompareLevel ? level + 1 : level;
        const int right = e.text == "implies" ? level : level + 1;
        return fmt::format("{} {} {}", Print(e.args[0], left), e.text, Right(e, right));
      }
      case ExprKind::kList:
        return fmt::format("[{}]", Items(e, 0));
      case ExprKind::kTuple:
        return fmt::format("({})", Items(e, 0));
      case ExprKind::kQuantity:
        return Print(e.args[0], 0) + (e.text.empty() ? "" : " " + e.text);
      case ExprKind::kConditional:
        // What stands behind a quantifier belongs to it.
        return fmt::format("{} if {} else {}", Print(e.args[1], kImpliesLevel),
                           Print(e.args[0], kImpliesLevel), Print(e.args[2], kConditionalLevel));
      case ExprKind::kAny: {
        const std::string first = Print(e.args[0], kSumLevel);
        const std::string last = e.args.size() > 1 ? ".." + Print(e.args[1], kSumLevel) : "";
        return fmt::format("any {} in {}{}", e.text, first, last);
      }
      case ExprKind::kQuantifier:
      case ExprKind::kFold: {
        if (const auto range = RangeOf(pool_, e)) {
          const std::string limits =
              (IsZero(range->from) ? "" : Print(range->from, 0) + ", ") + Print(range->to, 0);
          return fmt::format("{} {} in range({}): {}", e.text, fmt::join(e.binders[0].names, ", "), limits,
                             Print(range->body, 0));
        }
        std::string binders;
        for (const Binder& b : e.binders) {
          if (!binders.empty()) binders += ", ";
          for (size_t i = 0; i < b.names.size(); ++i) binders += (i == 0 ? "" : ", ") + b.names[i];
          binders += " in " + (b.domain.valid() ? Print(b.domain, kSumLevel) : Type(b.type));
        }
        return fmt::format("{} {}: {}", e.text, binders, Print(e.args[0], 0));
      }
    }
    return "";
  }

  bool IsZero(ExprId id) const { return pool_[id].kind == ExprKind::kInt && pool_[id].text == "0"; }

  // `1.x` would read as a number.
  std::string Base(ExprId id) const {
    const ExprKind kind = pool_[id].kind;
    const std::string text = Print(id, kPostfixLevel);
    return kind == ExprKind::kInt || kind == ExprKind::kFloat ? fmt::format("({})", text) : text;
  }

  // A quantifier reaches as far to the right as it can; behind `implies` nothing else can follow.
  std::string Right(const Expr& e, int least) const {
    const ExprId right = e.args[1];
    return Print(right, e.text == "implies" && pool_[right].kind == ExprKind::kQuantifier ? 0 : least);
  }

  const ExprPool& pool_;
};

bool Mentions(const ExprPool& pool, ExprId id, const std::vector<std::string>& names) {
  const Expr& e = pool[id];
  if (e.kind == ExprKind::kName && std::ranges::find(names, e.text) != names.end()) return true;
  return std::ranges::any_of(e.args, [&](ExprId arg) { return Mentions(pool, arg, names); }) ||
         std::ranges::any_of(
             e.binders, [&](const Binder& b) { return b.domain.valid() && Mentions(pool, b.domain, names); });
}

}  // namespace

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
  const bool own = Mentions(pool, range.from, binder.names) || Mentions(pool, range.to, binder.names);
  return own ? std::nullopt : std::optional(range);
}

std::string PrintExpr(const ExprPool& pool, ExprId expr) { return Printer(pool).Print(expr, 0); }
std::string PrintType(const ExprPool& pool, const TypeSyntax& type) { return Printer(pool).Type(type); }

}  // namespace rondo::lang
