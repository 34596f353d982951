#include "choreo/syntax/legacy_expr.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace rondo::choreo {

using diag::Kind;
using diag::Span;
using lang::ExprKind;
using lang::Token;
using lang::TokenKind;

namespace {

constexpr int kDeepestBracket = 100;
constexpr int kPrefixLevel = 5;

bool IsComparison(std::string_view sign) {
  constexpr std::array<std::string_view, 6> kSigns = {"==", "!=", "<", "<=", ">", ">="};
  return std::ranges::find(kSigns, sign) != kSigns.end();
}

bool IsLogic(std::string_view sign) { return sign == "&&" || sign == "||"; }

}  // namespace

LegacyExprParser::LegacyExprParser(const lang::TokenStream& stream, Module& module,
                                   diag::Diagnostics& diagnostics, Dialect dialect)
    : ExprParser(stream, module.exprs, diagnostics), dialect_(dialect), point_{"fpx", "fpy", "fpz"} {
  for (const Item& item : module.items) {
    if (const auto* world = std::get_if<WorldDef>(&item)) world_ = world;
  }
}

void LegacyExprParser::SetPoint(std::string x, std::string y, std::string z) {
  point_[0] = std::move(x);
  point_[1] = std::move(y);
  point_[2] = std::move(z);
}

Name LegacyExprParser::ParseName(std::string_view what) {
  const Span span = Peek().span;
  return {ExpectName(what), span};
}

// The binary operator that stands next; `**` is two signs without a gap.
std::string LegacyExprParser::SignAhead() const {
  if (!AtKind(TokenKind::kPunctuation)) return {};
  if (At("*") && Peek(1).text == "*" && Peek(1).span.begin == Peek().span.end) return "**";
  return std::string(Peek().text);
}

int LegacyExprParser::LevelOf(std::string_view sign) const {
  if (IsLogic(sign)) return 0;
  if (IsComparison(sign)) return dialect_ == Dialect::kChoreography ? 1 : 0;
  if (sign == "+" || sign == "-") return 2;
  if (sign == "*" || sign == "/" || sign == "%") return 3;
  return sign == "**" ? 4 : -1;
}

void LegacyExprParser::Unusual(Span span, std::string_view read, std::string_view help) {
  diagnostics_.Report(Kind::kChoreoPrecedence, span, fmt::format("this is read as {}", read))
      .Note("so does the original tool, whose operators bind in an unusual way")
      .Help(std::string(help));
}

ExprId LegacyExprParser::ParseLegacy() { return ParseLevel(0); }

ExprId LegacyExprParser::ParseLevel(int level) {
  if (level == kPrefixLevel) return ParsePrefix();
  ExprId left = ParseLevel(level + 1);
  for (int operators = 1; !failed(); ++operators) {
    const std::string sign = SignAhead();
    if (sign.empty() || LevelOf(sign) != level || TooLong(operators)) break;
    Take();
    if (sign == "**") Take();
    const ExprId right = ParseLevel(level + 1);
    left = Combine(sign, left, right);
  }
  return left;
}

ExprId LegacyExprParser::Combine(std::string sign, ExprId a, ExprId b) {
  const lang::Expr& left = pool_[a];
  const Span span = left.span.To(pool_[b].span);
  const bool bare = left.kind == ExprKind::kBinary && !bracketed_.contains(a.value);
  const auto text = [&](std::string_view of) { return left.text == of; };
  if (bare && sign == "&&" && text("or"))
    Unusual(span, "`(a || b) && c`", "write brackets: `a || (b && c)` or `(a || b) && c`");
  if (bare && dialect_ == Dialect::kProgram && IsComparison(sign) && (text("and") || text("or")))
    Unusual(span, "`(a && b) == c`", "write brackets around comparisons: `(a == b) && (c == d)`");
  if (sign == "**" && left.kind == ExprKind::kUnary && left.text == "-" && !bracketed_.contains(a.value))
    Unusual(span, "`(-a)**b`", "write brackets: `-(a**b)` or `(-a)**b`");
  if (sign == "**" && left.kind == ExprKind::kCall && pool_[left.args[0]].text == "pow" &&
      !bracketed_.contains(a.value))
    Unusual(span, "`(a**b)**c`", "write brackets: `a**(b**c)` or `(a**b)**c`");
  if (bare && dialect_ == Dialect::kChoreography && IsComparison(sign) && IsComparison(left.text)) {
    diagnostics_.Report(Kind::kSyntaxUnexpected, span, "comparisons do not chain")
        .Help("write `(a < b) && (b < c)`");
  }
  if (sign == "**") {
    const ExprId callee = pool_.Add({ExprKind::kName, span, "pow", {}, {}});
    // The exponent is a number, not a quantity in SI units.
    const ExprId power = pool_[b].kind == ExprKind::kQuantity ? pool_[b].args[0] : b;
    return pool_.Add({ExprKind::kCall, span, {}, {callee, a, power}, {}});
  }
  if (sign == "&&") sign = "and";
  if (sign == "||") sign = "or";
  return pool_.Add({ExprKind::kBinary, span, std::move(sign), {a, b}, {}});
}

ExprId LegacyExprParser::ParsePrefix() {
  if (!At("!") && !At("-")) return ParseAtom();
  if (++depth_ > kDeepestBracket) {
    if (!failed())
      diagnostics_.Report(Kind::kSyntaxNesting, Peek().span, "an expression is nested too deeply");
    Unexpected("a simpler expression");
    --depth_;
    return Fail(Peek().span);
  }
  const bool negation = At("!");
  const Span span = Take().span;
  // In programs `!` binds looser than sums.
  const ExprId operand = negation && dialect_ == Dialect::kProgram ? ParseLevel(2) : ParsePrefix();
  if (negation && IsComparison(SignAhead()))
    Unusual(span, "`(!a) == b`", "write brackets: `!(a == b)` or `(!a) == b`");
  --depth_;
  return pool_.Add({ExprKind::kUnary, span.To(pool_[operand].span), negation ? "not" : "-", {operand}, {}});
}

ExprId LegacyExprParser::Number(Span span, std::string text, std::string unit) {
  const bool whole = text.find('.') == std::string::npos;
  const ExprId literal =
      pool_.Add({whole ? ExprKind::kInt : ExprKind::kFloat, span, std::move(text), {}, {}});
  return pool_.Add({ExprKind::kQuantity, span, std::move(unit), {literal}, {}});
}

ExprId LegacyExprParser::ParseAtom() {
  const Token token = Peek();
  if (token.kind == TokenKind::kInt || token.kind == TokenKind::kFloat) {
    Take();
    return Number(token.span, std::string(token.text), "");
  }
  if (token.kind == TokenKind::kName) {
    Take();
    if (At("(")) return Call(token);
    return Named(token);
  }
  if (Accept("(")) {
    if (++depth_ > kDeepestBracket) {
      if (!failed())
        diagnostics_.Report(Kind::kSyntaxNesting, token.span, "an expression is nested too deeply");
      Unexpected("a simpler expression");
      --depth_;
      return Fail(token.span);
    }
    const ExprId inner = ParseLegacy();
    --depth_;
    Expect(")", "an expression");
    bracketed_.insert(inner.value);
    return inner;
  }
  Unexpected("a value");
  return Fail(token.span);
}

// `cart_x`: x of the robot cart; `fpx`: a coordinate.
ExprId LegacyExprParser::Named(const Token& token) {
  const std::string text(token.text);
  if (text == "true" || text == "True" || text == "false" || text == "False")
    return pool_.Add(
        {ExprKind::kBool, token.span, text == "true" || text == "True" ? "true" : "false", {}, {}});
  for (size_t i = 0; i < 3; ++i) {
    if (text == point_[i]) return pool_.Add({ExprKind::kName, token.span, std::string(1, "xyz"[i]), {}, {}});
  }
  const Component* owner = nullptr;
  if (world_ != nullptr) {
    for (const Component& c : world_->components) {
      const std::string& name = c.name.text;
      const bool fits = text.size() > name.size() + 1 && text.starts_with(name) && text[name.size()] == '_';
      if (fits && (owner == nullptr || owner->name.text.size() < name.size())) owner = &c;
    }
  }
  if (owner == nullptr) return pool_.Add({ExprKind::kName, token.span, text, {}, {}});
  const ExprId robot = pool_.Add({ExprKind::kName, token.span, owner->name.text, {}, {}});
  return pool_.Add({ExprKind::kField, token.span, text.substr(owner->name.text.size() + 1), {robot}, {}});
}

std::vector<ExprId> LegacyExprParser::ParseLegacyArguments() {
  std::vector<ExprId> args;
  if (!Expect("(", "a name")) return args;
  while (!At(")") && !failed()) {
    args.push_back(ParseLegacy());
    if (!Accept(",")) break;
  }
  Expect(")", "the arguments");
  return args;
}

ExprId LegacyExprParser::Call(const Token& name) {
  if (++depth_ > kDeepestBracket) {
    Unexpected("a simpler expression");
    --depth_;
    return Fail(name.span);
  }
  std::vector<ExprId> args = ParseLegacyArguments();
  --depth_;
  const Span span = name.span.To(PreviousSpan());
  if (name.text == "rad" && args.size() == 1) {
    // Degrees, exactly: 90 becomes 90 deg.
    return pool_.Add({ExprKind::kBinary, span, "*", {args[0], Number(span, "1", "deg")}, {}});
  }
  args.insert(
      args.begin(),
      pool_.Add({ExprKind::kName, name.span, name.text == "Pnt" ? "point" : std::string(name.text), {}, {}}));
  return pool_.Add({ExprKind::kCall, span, {}, std::move(args), {}});
}

}  // namespace rondo::choreo
