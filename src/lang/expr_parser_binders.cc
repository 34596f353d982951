// Quantifiers and folds: their words, variables and domains.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "lang/expr_parser_depth.h"
#include "lang/expr_queries.h"

namespace rondo::lang {

using diag::Kind;
using diag::Span;

// These words mean a fold only where a variable and its domain follow.
bool ExprParser::AtFold() const {
  static constexpr std::array<std::string_view, 6> kFolds = {"count", "sum",    "min",
                                                             "max",   "argmin", "argmax"};
  return HasFolds() && AtKind(TokenKind::kName) && std::ranges::find(kFolds, Peek().text) != kFolds.end() &&
         Peek(1).kind == TokenKind::kName && (Peek(2).text == "in" || Peek(2).text == ",");
}

// `all i in ID` and `any i in ID` are other words for `forall` and `exists`; `any q in [a, b]` is a choice.
bool ExprParser::AtQuantifier() const {
  if (At("forall") || At("exists")) return true;
  if (!HasFolds() || Peek(1).kind != TokenKind::kName) return false;
  if (At("all")) return Peek(2).text == "in" || Peek(2).text == ",";
  return At("any") && Peek(2).text == "in" && (Peek(3).text == "ID" || Peek(3).text == "range");
}

ExprId ExprParser::ParseQuantifier() {
  const bool fold = AtFold();
  const Token& word = Take();
  const std::string text(word.text == "all" ? "forall" : word.text == "any" ? "exists" : word.text);
  return ParseBinders(word.span, fold ? ExprKind::kFold : ExprKind::kQuantifier, text);
}

// Behind a range, the other variables are those of a quantifier inside: the range says where that one is asked.
ExprId ExprParser::ParseBinders(Span start, ExprKind kind, const std::string& text) {
  Depth depth(*this);
  if (depth.TooDeep()) return Fail(start);
  Expr quantifier{kind, start, text, {}, {}};
  ExprId range;
  do {
    Binder binder;
    if (!ParseBinder(binder, range)) return Fail(start);
    quantifier.binders.push_back(std::move(binder));
  } while (!range.valid() && Accept(","));
  if (kind == ExprKind::kFold && range.valid()) {
    diagnostics_.Report(Kind::kSyntaxUnexpected, quantifier.binders.back().spans[0],
                        fmt::format("`{}` goes over robots, not over numbers", text));
    failed_ = true;
    return Fail(start);
  }
  ExprId body;
  if (range.valid() && Accept(",")) {
    body = ParseBinders(Peek().span, kind, text);
  } else {
    if (!Accept(".") && !Expect(":", "the variables of a quantifier")) return Fail(start);
    AllowLineBreak();
    body = ParseExpr();
  }
  if (range.valid()) {
    const diag::Span span = pool_[range].span.To(pool_[body].span);
    body = pool_.Add({ExprKind::kBinary, span, text == "forall" ? "implies" : "and", {range, body}, {}});
  }
  quantifier.args = {body};
  quantifier.span = quantifier.span.To(pool_[body].span);
  return pool_.Add(std::move(quantifier));
}

// `c in range(n)` is c in int with 0 <= c and c < n.
ExprId ExprParser::ParseRange(const std::vector<std::string>& names) {
  const Span span = Take().span;
  Take();
  const std::vector<ExprId> limits = ParseItems(")");
  if (failed_) return Fail(span);
  if (limits.size() != 1 && limits.size() != 2) {
    failed_ = true;
    diagnostics_.Report(Kind::kSyntaxUnexpected, span.To(PreviousSpan()),
                        "`range` has an end, or a start and an end");
    return Fail(span);
  }
  for (const ExprId limit : limits) {
    if (!MentionsName(pool_, limit, names)) continue;
    failed_ = true;
    diagnostics_
        .Report(Kind::kSyntaxUnexpected, pool_[limit].span,
                "the range of a variable cannot depend on the variable")
        .Help("give the variable another name");
    return Fail(span);
  }
  const ExprId from = limits.size() == 2 ? limits[0] : pool_.Add({ExprKind::kInt, span, "0", {}, {}});
  ExprId all;
  for (const std::string& name : names) {
    const ExprId variable = pool_.Add({ExprKind::kName, span, name, {}, {}});
    const ExprId both = Binary("and", pool_.Add({ExprKind::kBinary, span, "<=", {from, variable}, {}}),
                               pool_.Add({ExprKind::kBinary, span, "<", {variable, limits.back()}, {}}));
    all = all.valid() ? Binary("and", all, both) : both;
  }
  return all;
}

bool ExprParser::ParseBinder(Binder& binder, ExprId& range) {
  do {
    const Span span = Peek().span;
    std::string name = ExpectName("the name of a variable");
    if (name.empty()) return false;
    binder.names.push_back(std::move(name));
    binder.spans.push_back(span);
  } while (Accept(","));
  if (Accept(":")) {
    binder.type = ParseType();
    return !failed_;
  }
  if (!Expect("in", "the variables of a quantifier")) return false;
  if (HasFolds() && At("range") && Peek(1).text == "(") {
    binder.domain = pool_.Add({ExprKind::kName, Peek().span, "int", {}, {}});
    range = ParseRange(binder.names);
    return !failed_;
  }
  static constexpr std::array<std::string_view, 8> kTypeWords = {"List", "Queue", "Map", "Set",
                                                                 "list", "queue", "map", "set"};
  if (AtKind(TokenKind::kName) &&
      std::find(kTypeWords.begin(), kTypeWords.end(), Peek().text) != kTypeWords.end() &&
      (Peek(1).text == "<" || Peek(1).text == "(")) {
    binder.type = ParseType();
  } else {
    binder.domain = ParseSum();
  }
  return !failed_;
}

}  // namespace rondo::lang
