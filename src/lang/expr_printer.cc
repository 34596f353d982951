#include "lang/expr_printer.h"

#include <fmt/format.h>

#include "lang/expr_queries.h"

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

}  // namespace

std::string PrintExpr(const ExprPool& pool, ExprId expr) { return Printer(pool).Print(expr, 0); }
std::string PrintType(const ExprPool& pool, const TypeSyntax& type) { return Printer(pool).Type(type); }

}  // namespace rondo::lang
