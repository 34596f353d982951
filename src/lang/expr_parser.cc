#include "lang/expr_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "lang/expr_queries.h"

namespace rondo::lang {

using diag::Kind;
using diag::Span;

// Counts how deep the recursion is; reports once where it is too deep.
class ExprParser::Depth {
 public:
  explicit Depth(ExprParser& parser) : parser_(parser) { ++parser_.depth_; }
  Depth(const Depth&) = delete;
  Depth& operator=(const Depth&) = delete;
  ~Depth() { --parser_.depth_; }
  bool TooDeep() {
    if (parser_.depth_ <= kDeepest) return false;
    if (!parser_.failed_) {
      parser_.diagnostics_
          .Report(Kind::kSyntaxNesting, parser_.Peek().span, "this expression is nested too deeply")
          .Under(fmt::format("more than {} levels", kDeepest));
      parser_.failed_ = true;
    }
    return true;
  }

 private:
  ExprParser& parser_;
};

const Token& ExprParser::Peek(size_t ahead) const {
  return stream_.tokens[std::min(at_ + ahead, stream_.tokens.size() - 1)];
}
const Token& ExprParser::Take() {
  const Token& token = Peek();
  if (at_ + 1 < stream_.tokens.size()) ++at_;
  return token;
}
bool ExprParser::At(std::string_view text) const {
  const Token& token = Peek();
  return (token.kind == TokenKind::kName || token.kind == TokenKind::kPunctuation) && token.text == text;
}
bool ExprParser::Accept(std::string_view text) {
  if (!At(text)) return false;
  Take();
  return true;
}
Span ExprParser::PreviousSpan() const { return stream_.tokens[at_ == 0 ? 0 : at_ - 1].span; }

diag::Diagnostic& ExprParser::Unexpected(std::string_view expected) {
  static thread_local diag::Diagnostic ignored{};
  if (failed_) return ignored = {};
  failed_ = true;
  Span span = Peek().span;
  // The end of a line is shown right behind what stands before it.
  if (span.begin == span.end && at_ > 0) span = {span.file, PreviousSpan().end, PreviousSpan().end};
  return diagnostics_.Report(Kind::kSyntaxUnexpected, span,
                             fmt::format("{} where {} should be", Describe(Peek()), expected));
}

bool ExprParser::Expect(std::string_view text, std::string_view after) {
  if (Accept(text)) return true;
  Unexpected(fmt::format("`{}`", text)).Under(fmt::format("after {}", after));
  return false;
}

std::string ExprParser::ExpectName(std::string_view what) {
  if (AtKind(TokenKind::kName) && !IsReserved(Peek().text)) return std::string(Take().text);
  if (AtKind(TokenKind::kName) && !failed_) {
    failed_ = true;
    diagnostics_
        .Report(Kind::kSyntaxReservedName, Peek().span,
                fmt::format("`{}` is a word of the language", Peek().text))
        .Under(fmt::format("cannot be {}", what));
    return {};
  }
  Unexpected(what);
  return {};
}

ExprId ExprParser::Binary(std::string text, ExprId a, ExprId b) {
  return pool_.Add({ExprKind::kBinary, pool_[a].span.To(pool_[b].span), std::move(text), {a, b}, {}});
}

ExprId ExprParser::ParseExpr() {
  Depth depth(*this);
  if (depth.TooDeep()) return Fail(Peek().span);
  const ExprId value = ParseImplies();
  if (!HasConditionals() || failed_ || !At("if")) return value;
  Take();
  const ExprId condition = ParseImplies();
  if (!Expect("else", "the condition of a value")) return Fail(pool_[value].span);
  const ExprId otherwise = ParseExpr();
  const Span span = pool_[value].span.To(pool_[otherwise].span);
  return pool_.Add({ExprKind::kConditional, span, {}, {condition, value, otherwise}, {}});
}

ExprId ExprParser::ParseImplies() {
  const ExprId left = ParseOr();
  if (!At("implies") && !At("=>")) return left;
  Take();
  AllowLineBreak();
  Depth depth(*this);
  if (depth.TooDeep()) return Fail(Peek().span);
  return Binary("implies", left, ParseImplies());
}

bool ExprParser::TooLong(int operators) {
  if (operators <= kLongest) return false;
  if (!failed_) {
    diagnostics_.Report(Kind::kSyntaxNesting, Peek().span,
                        fmt::format("more than {} operators in a row", kLongest));
  }
  failed_ = true;
  return true;
}

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

ExprId ExprParser::ParseOr() {
  ExprId left = ParseAnd();
  for (int operators = 1; At("or") || At("||"); ++operators) {
    if (TooLong(operators)) return left;
    Take();
    AllowLineBreak();
    left = Binary("or", left, ParseAnd());
  }
  return left;
}

ExprId ExprParser::ParseAnd() {
  ExprId left = ParseNot();
  for (int operators = 1; At("and") || At("&&"); ++operators) {
    if (TooLong(operators)) return left;
    Take();
    AllowLineBreak();
    left = Binary("and", left, ParseNot());
  }
  return left;
}

ExprId ExprParser::ParseNot() {
  if (AtQuantifier()) {
    Depth depth(*this);
    if (depth.TooDeep()) return Fail(Peek().span);
    return ParseQuantifier();
  }
  if (!At("not") && !At("!")) return ParseComparison();
  Depth depth(*this);
  if (depth.TooDeep()) return Fail(Peek().span);
  const Span span = Take().span;
  const ExprId operand = ParseNot();
  return pool_.Add({ExprKind::kUnary, span.To(pool_[operand].span), "not", {operand}, {}});
}

ExprId ExprParser::ParseComparison() {
  const ExprId left = ParseSum();
  const auto operation = [&]() -> std::string {
    static constexpr std::array<std::string_view, 6> kSigns = {"==", "!=", "<", "<=", ">", ">="};
    for (const std::string_view sign : kSigns) {
      if (At(sign)) return std::string(sign);
    }
    if (At("=")) return "==";  // the papers' programs write it so
    if (At("in")) return "in";
    if (At("not") && Peek(1).text == "in") return "not in";
    return {};
  };
  std::string text = operation();
  if (text.empty()) return left;
  if (text == "not in") Take();
  Take();
  const ExprId right = ParseSum();
  const ExprId result = Binary(std::move(text), left, right);
  if (!operation().empty() && !failed_) {
    failed_ = true;
    diagnostics_.Report(Kind::kSyntaxUnexpected, Peek().span, "comparisons do not chain")
        .At(pool_[result].span, "this is true or false")
        .Help("write `a < b and b < c`");
    while (!operation().empty()) {
      Take();
      ParseSum();
    }
  }
  return result;
}

ExprId ExprParser::ParseSum() {
  ExprId left = ParseProduct();
  for (int operators = 1; At("+") || At("-"); ++operators) {
    if (TooLong(operators)) return left;
    std::string text(Take().text);
    left = Binary(std::move(text), left, ParseProduct());
  }
  return left;
}

ExprId ExprParser::ParseProduct() {
  ExprId left = ParseUnary();
  for (int operators = 1; At("*") || At("/") || At("%"); ++operators) {
    if (TooLong(operators)) return left;
    std::string text(Take().text);
    left = Binary(std::move(text), left, ParseUnary());
  }
  return left;
}

ExprId ExprParser::ParseUnary() {
  if (!At("-")) return ParsePostfix();
  Depth depth(*this);
  if (depth.TooDeep()) return Fail(Peek().span);
  const Span span = Take().span;
  const ExprId operand = ParseUnary();
  return pool_.Add({ExprKind::kUnary, span.To(pool_[operand].span), "-", {operand}, {}});
}

ExprId ExprParser::ParsePostfix() {
  ExprId base = ParsePrimary();
  while (true) {
    if (At(".") && Peek(1).kind == TokenKind::kName) {
      Take();
      const Token& member = Take();
      base = pool_.Add(
          {ExprKind::kField, pool_[base].span.To(member.span), std::string(member.text), {base}, {}});
    } else if (At("[")) {
      const Span bracket = Take().span;
      const ExprId index =
          HasFolds() && At(":") ? pool_.Add({ExprKind::kInt, bracket, "0", {}, {}}) : ParseExpr();
      if (HasFolds() && At(":")) {
        base = ParseSlice(base, index);
        continue;
      }
      if (!Expect("]", "an index")) return Fail(pool_[base].span);
      base = pool_.Add({ExprKind::kIndex, pool_[base].span.To(PreviousSpan()), {}, {base, index}, {}});
    } else if (At("(")) {
      Take();
      std::vector<ExprId> args = ParseItems(")");
      args.insert(args.begin(), base);
      base = pool_.Add({ExprKind::kCall, pool_[base].span.To(PreviousSpan()), {}, std::move(args), {}});
    } else {
      return base;
    }
  }
}

// `l[a:b]` calls a function that nobody else can name; without b, up to the end.
ExprId ExprParser::ParseSlice(ExprId list, ExprId from) {
  const Span colon = Take().span;
  std::vector<ExprId> args{pool_.Add({ExprKind::kName, colon, std::string(kSlice), {}, {}}), list, from};
  if (!At("]")) args.push_back(ParseExpr());
  if (!Expect("]", "a slice")) return Fail(pool_[list].span);
  return pool_.Add({ExprKind::kCall, pool_[list].span.To(PreviousSpan()), {}, std::move(args), {}});
}

std::vector<ExprId> ExprParser::ParseItems(std::string_view close) {
  std::vector<ExprId> items;
  while (!At(close) && !failed_) {
    items.push_back(ParseExpr());
    if (!Accept(",")) break;
  }
  Expect(close, "this list");
  return items;
}

// any q in [1, 2, 4]  |  any int in 0..5
ExprId ExprParser::ParseAny() {
  const Span start = Take().span;
  std::string word(Take().text);
  Take();
  Depth depth(*this);
  if (depth.TooDeep()) return Fail(start);
  std::vector<ExprId> args{ParseSum()};
  if (Accept("..")) args.push_back(ParseSum());
  const Span span = start.To(pool_[args.back()].span);
  return pool_.Add({ExprKind::kAny, span, std::move(word), std::move(args), {}});
}

ExprId ExprParser::ParsePrimary() {
  const Token token = Peek();
  switch (token.kind) {
    case TokenKind::kInt:
    case TokenKind::kFloat: {
      Take();
      const ExprKind kind = token.kind == TokenKind::kInt ? ExprKind::kInt : ExprKind::kFloat;
      const ExprId number = pool_.Add({kind, token.span, std::string(token.text), {}, {}});
      if (!AtKind(TokenKind::kName) || !IsUnit(Peek().text)) return number;
      const Token unit = Take();
      return pool_.Add({ExprKind::kQuantity, token.span.To(unit.span), std::string(unit.text), {number}, {}});
    }
    case TokenKind::kString:
      Take();
      return pool_.Add({ExprKind::kString, token.span, std::string(token.text), {}, {}});
    case TokenKind::kName: {
      if (AtFold()) {
        Depth depth(*this);
        return depth.TooDeep() ? Fail(token.span) : ParseQuantifier();
      }
      if (token.text == "true" || token.text == "True") {
        Take();
        return pool_.Add({ExprKind::kBool, token.span, "true", {}, {}});
      }
      if (token.text == "false" || token.text == "False") {
        Take();
        return pool_.Add({ExprKind::kBool, token.span, "false", {}, {}});
      }
      if (token.text == "pid") {
        Take();
        return pool_.Add({ExprKind::kPid, token.span, {}, {}, {}});
      }
      if (token.text == "any" && Peek(1).kind == TokenKind::kName && Peek(2).text == "in") return ParseAny();
      if (IsReserved(token.text)) break;
      Take();
      return pool_.Add({ExprKind::kName, token.span, std::string(token.text), {}, {}});
    }
    case TokenKind::kPunctuation: {
      if (token.text == "(") {
        Take();
        std::vector<ExprId> items = ParseItems(")");
        const Span span = token.span.To(PreviousSpan());
        if (items.size() == 1) return items[0];
        if (items.empty()) {
          if (!failed_) {
            failed_ = true;
            diagnostics_.Report(Kind::kSyntaxUnexpected, span, "nothing between the brackets");
          }
          return Fail(span);
        }
        return pool_.Add({ExprKind::kTuple, span, {}, std::move(items), {}});
      }
      if (token.text == "[") {
        Take();
        std::vector<ExprId> items = ParseItems("]");
        return pool_.Add({ExprKind::kList, token.span.To(PreviousSpan()), {}, std::move(items), {}});
      }
      break;
    }
    case TokenKind::kEnd:
    case TokenKind::kNewline:
    case TokenKind::kIndent:
    case TokenKind::kDedent:
      break;
  }
  auto& report = Unexpected("a value");
  if (token.text == "for" && Peek(1).text == "all") report.Help("write `forall`");
  return Fail(token.span);
}

TypeSyntax ExprParser::ParseType() {
  TypeSyntax type;
  type.span = Peek().span;
  type.name = ExpectName("a type");
  if (type.name.empty()) return type;
  Depth depth(*this);
  if (depth.TooDeep()) return type;
  const bool angle = At("<");
  if (angle || At("(")) {
    Take();
    do {
      type.arguments.push_back(ParseType());
    } while (!failed_ && Accept(","));
    Expect(angle ? ">" : ")", "the arguments of a type");
    type.span = type.span.To(PreviousSpan());
  }
  while (At("[") && !failed_) {
    Take();
    if (At("]") || At("*")) {
      Accept("*");
      type.dimensions.emplace_back();
    } else {
      type.dimensions.push_back(ParseExpr());
    }
    Expect("]", "a dimension");
    type.span = type.span.To(PreviousSpan());
  }
  return type;
}

}  // namespace rondo::lang
