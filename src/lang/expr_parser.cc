#include "lang/expr_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "lang/expr_parser_depth.h"
#include "lang/suggest.h"

namespace rondo::lang {

using diag::Kind;
using diag::Span;

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
  auto& report = diagnostics_.Report(Kind::kSyntaxUnexpected, span,
                                     fmt::format("{} where {} should be", Describe(Peek()), expected));
  if (!Mistyped(Peek(), expected, report) && at_ > 0) Mistyped(stream_.tokens[at_ - 1], {}, report);
  return report;
}

// Says which word was perhaps meant: one of those that are expected here, in backticks, or a longer one of the language.
bool ExprParser::Mistyped(const Token& token, std::string_view expected, diag::Diagnostic& report) const {
  std::vector<std::string> words = Words();
  const std::string text(token.text);
  if (token.kind != TokenKind::kName || std::ranges::find(words, text) != words.end()) return false;
  std::vector<std::string> here;
  for (size_t at = expected.find('`'); at != std::string_view::npos;) {
    const size_t end = expected.find('`', at + 1);
    if (end == std::string_view::npos) break;
    here.emplace_back(expected.substr(at + 1, end - at - 1));
    at = expected.find('`', end + 1);
  }
  // Names of people's own are near to short words all too often.
  constexpr size_t kShort = 4, kLong = 6;
  std::erase_if(words, [](const std::string& word) { return word.size() < kShort; });
  std::string near = text.size() > 1 ? Suggest(text, here) : std::string();
  if (near.empty() && text.size() >= kShort) near = Suggest(text, words, text.size() < kLong ? 1 : 2);
  if (near.empty()) return false;
  report.Help(fmt::format("did you mean `{}`?", near)).Fix(token.span, near);
  return true;
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
