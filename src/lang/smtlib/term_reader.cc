#include "lang/smtlib/term_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "expr/elementary.h"
#include "lang/suggest.h"

namespace rondo::lang::smtlib {

using diag::Kind;
using expr::Elementary;
using expr::Rational;
using expr::SortId;

namespace {

// Expansions of definitions, so that a few lines cannot ask for more terms than memory holds.
constexpr size_t kMostExpansions = 1'000'000;
// Definitions inside definitions, which may use themselves.
constexpr size_t kDeepestExpansion = 200;
constexpr size_t kMostDigits = 20'000;
// Powers of powers, written out.
constexpr uint64_t kMostFactors = 1'000;

}  // namespace

expr::TermId TermReader::Wrong(const SExpr& e, const std::string& message) {
  diagnostics_.Report(Kind::kSmtSort, e.span, message);
  return {};
}

bool TermReader::IsNumeric(TermId t) const {
  const SortId s = arena_.sort_of(t);
  return s == arena_.Int() || s == arena_.Real();
}

expr::TermId TermReader::Real(TermId t) { return arena_.sort_of(t) == arena_.Int() ? arena_.ToReal(t) : t; }

expr::TermId TermReader::As(TermId t, SortId sort, const SExpr& e) {
  if (!t.valid() || arena_.sort_of(t) == sort) return t;
  if (sort == arena_.Real() && arena_.sort_of(t) == arena_.Int()) return arena_.ToReal(t);
  return Wrong(e, fmt::format("this is of sort `{}`, not `{}`", arena_.sort(arena_.sort_of(t)).name,
                              arena_.sort(sort).name));
}

std::optional<SortId> TermReader::ReadSort(const SExpr& e) {
  if (e.Is("Real")) return arena_.Real();
  if (e.Is("Int")) return arena_.Int();
  if (e.Is("Bool")) return arena_.Bool();
  diagnostics_.Report(Kind::kSmtUnsupported, e.span, "this sort is not supported")
      .Help("sorts are `Real`, `Int` and `Bool`");
  return std::nullopt;
}

bool TermReader::IsReserved(const std::string& name) {
  static const std::set<std::string, std::less<>> kReserved{
      "true",     "false", "and", "or", "not", "xor", "=>", "ite", "let", "=",
      "distinct", "<",     "<=",  ">",  ">=",  "+",   "-",  "*",   "/",   "!"};
  return kReserved.contains(name) || Rational::Parse(name).has_value();
}

void TermReader::Declare(const SExpr& name, TermId variable) { variables_[name.text] = variable; }
void TermReader::Define(const SExpr& name, Macro macro) { macros_[name.text] = std::move(macro); }

expr::TermId TermReader::ReadFormula(const SExpr& e) { return As(Read(e), arena_.Bool(), e); }

expr::TermId TermReader::Read(const SExpr& e) {
  switch (e.kind) {
    case SExpr::Kind::kSymbol:
      return Symbol(e);
    case SExpr::Kind::kString:
    case SExpr::Kind::kBracket:
      diagnostics_.Report(Kind::kSmtSyntax, e.span, "a term should stand here");
      return {};
    case SExpr::Kind::kList:
      break;
  }
  return Bounded(Application(e), e);
}

// Definitions can nest terms deeper than any list; what works on terms recursively must not.
expr::TermId TermReader::Bounded(TermId t, const SExpr& e) {
  if (!t.valid()) return t;
  if (arena_.IsNumber(t) && arena_.number(t).Digits() > kMostDigits) {
    diagnostics_.Report(Kind::kSmtUnsupported, e.span, "this number is too large");
    return {};
  }
  const size_t known = depths_.size();
  depths_.resize(std::max(known, arena_.size()));
  factors_.resize(depths_.size());
  for (size_t i = known; i < arena_.size(); ++i) {
    const bool product = arena_.op(TermId(i)) == expr::Op::kMul;
    uint64_t factors = product ? 0 : 1;
    for (const TermId arg : arena_.args(TermId(i))) {
      depths_[i] = std::max(depths_[i], depths_[arg.index()] + 1);
      factors = product ? factors + factors_[arg.index()] : std::max(factors, factors_[arg.index()]);
    }
    factors_[i] = std::min(factors, kMostFactors + 1);
  }
  if (factors_[t.index()] > kMostFactors) {
    diagnostics_.Report(Kind::kSmtUnsupported, e.span, "this product has too many factors");
    return {};
  }
  if (depths_[t.index()] <= 2 * kDeepest) return t;
  diagnostics_.Report(Kind::kSyntaxNesting, e.span, "nested too deeply");
  return {};
}

expr::TermId TermReader::Symbol(const SExpr& e) {
  for (size_t s = scopes_.size(); s-- > scope_floor_;) {
    if (const auto it = scopes_[s].find(e.text); it != scopes_[s].end()) return it->second;
  }
  if (const auto it = variables_.find(e.text); it != variables_.end()) return it->second;
  if (const auto it = macros_.find(e.text); it != macros_.end()) return Expand(e, it->second, {});
  if (e.text == "true") return arena_.True();
  if (e.text == "false") return arena_.False();
  if (const auto number = Rational::Parse(e.text)) {
    const bool integer = e.text.find_first_not_of("-0123456789") == std::string::npos;
    return arena_.Number(integer ? arena_.Int() : arena_.Real(), *number);
  }
  if (std::isdigit(static_cast<unsigned char>(e.text[0])) || e.text[0] == '#') {
    diagnostics_
        .Report(Kind::kSmtUnsupported, e.span, fmt::format("`{}` is no number that can be read", e.text))
        .Help("numbers are written 12, 1.5 or 1e-3, with exponents up to 400");
    return {};
  }
  std::vector<std::string> names;
  for (const auto& [name, term] : variables_) names.push_back(name);
  for (const auto& [name, macro] : macros_) names.push_back(name);
  auto& report =
      diagnostics_.Report(Kind::kSmtUndeclared, e.span, fmt::format("`{}` is not declared", e.text));
  if (const std::string near = Suggest(e.text, names); !near.empty())
    report.Help(fmt::format("did you mean `{}`?", near)).Fix(e.span, near);
  return {};
}

expr::TermId TermReader::Let(const SExpr& e) {
  if (e.items.size() != 3 || !e.items[1].IsList()) {
    diagnostics_.Report(Kind::kSmtSyntax, e.span, "`let` is written (let ((name term) ...) term)");
    return {};
  }
  std::map<std::string, TermId, std::less<>> scope;
  for (const SExpr& binding : e.items[1].items) {
    if (!binding.IsList() || binding.items.size() != 2 || binding.items[0].kind != SExpr::Kind::kSymbol) {
      diagnostics_.Report(Kind::kSmtSyntax, binding.span, "a binding is written (name term)");
      return {};
    }
    const TermId value = Read(binding.items[1]);
    if (!value.valid()) return {};
    scope[binding.items[0].text] = value;
  }
  scopes_.push_back(std::move(scope));
  const TermId result = Read(e.items[2]);
  scopes_.pop_back();
  return result;
}

expr::TermId TermReader::Expand(const SExpr& e, const Macro& macro, Args args) {
  if (const size_t wanted = macro.parameters.size(); args.size() != wanted)
    return Wrong(e, fmt::format("`{}` takes {} argument{}, not {}", e.IsList() ? e.items[0].text : e.text,
                                wanted, wanted == 1 ? "" : "s", args.size()));
  if (++expansions_ > kMostExpansions || scopes_.size() > kDeepestExpansion) {
    diagnostics_.Report(Kind::kSmtUnsupported, e.span, "too many uses of definitions");
    return {};
  }
  std::map<std::string, TermId, std::less<>> scope;
  for (size_t i = 0; i < args.size(); ++i) {
    const TermId arg = As(args[i], macro.parameters[i].second, e);
    if (!arg.valid()) return {};
    scope[macro.parameters[i].first] = arg;
  }
  const size_t floor = scope_floor_;
  scope_floor_ = scopes_.size();
  scopes_.push_back(std::move(scope));
  const TermId result = As(Read(macro.body), macro.result, macro.body);
  scopes_.pop_back();
  scope_floor_ = floor;
  return result;
}

expr::TermId TermReader::Application(const SExpr& e) {
  if (e.items.empty() || e.items[0].kind != SExpr::Kind::kSymbol) {
    diagnostics_.Report(Kind::kSmtSyntax, e.span, "an operator should stand first");
    return {};
  }
  const std::string& head = e.items[0].text;
  if (head == "let") return Let(e);
  if (head == "!") {
    // A term with attributes.
    if (e.items.size() >= 2) return Read(e.items[1]);
    diagnostics_.Report(Kind::kSmtSyntax, e.span, "a term should stand here");
    return {};
  }
  if (head == "forall" || head == "exists") {
    diagnostics_.Report(Kind::kSmtUnsupported, e.span, "quantifiers are not supported");
    return {};
  }
  Args args;
  bool good = true;
  for (size_t i = 1; i < e.items.size(); ++i) {
    args.push_back(Read(e.items[i]));
    good = good && args.back().valid();
  }
  if (!good) return {};
  if (const auto it = macros_.find(head); it != macros_.end()) return Expand(e, it->second, std::move(args));
  for (const Family family : {&TermReader::Logic, &TermReader::Arithmetic, &TermReader::Function}) {
    if (const auto result = (this->*family)(e, args)) return *result;
  }
  std::vector<std::string> names{"and", "or", "not", "ite", "distinct"};
  for (size_t f = 0; f < static_cast<size_t>(Elementary::kCount_); ++f)
    names.emplace_back(Name(static_cast<Elementary>(f)));
  for (const auto& [name, macro] : macros_) names.push_back(name);
  auto& report =
      diagnostics_.Report(Kind::kSmtUnsupported, e.items[0].span, fmt::format("`{}` is no operator", head));
  if (const std::string near = Suggest(head, names); !near.empty())
    report.Help(fmt::format("did you mean `{}`?", near)).Fix(e.items[0].span, near);
  return {};
}

bool TermReader::Count(const SExpr& e, const Args& args, size_t least, size_t most) {
  if (args.size() >= least && args.size() <= most) return true;
  Wrong(e, fmt::format("`{}` does not take {} argument{}", e.items[0].text, args.size(),
                       args.size() == 1 ? "" : "s"));
  return false;
}

std::optional<expr::TermId> TermReader::Logic(const SExpr& e, const Args& args) {
  const std::string& head = e.items[0].text;
  if (head == "ite") {
    if (!Count(e, args, 3, 3)) return TermId{};
    const TermId condition = As(args[0], arena_.Bool(), e.items[1]);
    Args branches{args[1], args[2]};
    if (!condition.valid() || (arena_.sort_of(args[1]) != arena_.sort_of(args[2]) && !Unify(e, branches)))
      return TermId{};
    return arena_.Ite(condition, branches[0], branches[1]);
  }
  if (head == "=" || head == "distinct" || head == "<" || head == "<=" || head == ">" || head == ">=")
    return Compare(e, args);
  if (head != "and" && head != "or" && head != "not" && head != "=>" && head != "xor" && head != "implies") {
    return std::nullopt;
  }
  for (size_t i = 0; i < args.size(); ++i) {
    if (!As(args[i], arena_.Bool(), e.items[i + 1]).valid()) return TermId{};
  }
  if (head == "and") return arena_.And(args);
  if (head == "or") return arena_.Or(args);
  if (head == "not") return Count(e, args, 1, 1) ? arena_.Not(args[0]) : TermId{};
  if (!Count(e, args, 2, SIZE_MAX)) return TermId{};
  if (head == "xor") {
    TermId result = args[0];
    for (size_t i = 1; i < args.size(); ++i) result = arena_.Not(arena_.Eq(result, args[i]));
    return result;
  }
  TermId result = args.back();
  for (size_t i = args.size() - 1; i-- > 0;) result = arena_.Implies(args[i], result);
  return result;
}

bool TermReader::Unify(const SExpr& e, Args& args) {
  bool real = false;
  for (size_t i = 0; i < args.size(); ++i) {
    if (!IsNumeric(args[i])) {
      Wrong(i + 1 < e.items.size() ? e.items[i + 1] : e, "a number is needed here");
      return false;
    }
    real = real || arena_.sort_of(args[i]) == arena_.Real();
  }
  if (real) {
    for (TermId& a : args) a = Real(a);
  }
  return true;
}

expr::TermId TermReader::Compare(const SExpr& e, const Args& given) {
  if (!Count(e, given, 2, SIZE_MAX)) return {};
  const std::string& head = e.items[0].text;
  Args args = given;
  const bool equality = head == "=" || head == "distinct";
  const bool formulas =
      std::all_of(args.begin(), args.end(), [&](TermId t) { return arena_.sort_of(t) == arena_.Bool(); });
  if (!(equality && formulas) && !Unify(e, args)) return {};
  const auto compare = [&](TermId a, TermId b) {
    if (head == "=") return arena_.Eq(a, b);
    if (head == "distinct") return arena_.Not(arena_.Eq(a, b));
    if (head == "<") return arena_.Lt(a, b);
    if (head == "<=") return arena_.Le(a, b);
    return head == ">" ? arena_.Lt(b, a) : arena_.Le(b, a);
  };
  Args parts;
  for (size_t i = 0; i + 1 < args.size(); ++i) {
    const size_t last = head == "distinct" ? args.size() : i + 2;
    for (size_t j = i + 1; j < last; ++j) parts.push_back(compare(args[i], args[j]));
  }
  return arena_.And(parts);
}

std::optional<expr::TermId> TermReader::Arithmetic(const SExpr& e, const Args& given) {
  const std::string& head = e.items[0].text;
  if (head != "+" && head != "-" && head != "*" && head != "/") {
    return std::nullopt;
  }
  Args args = given;
  if (!Count(e, args, 1, SIZE_MAX) || !Unify(e, args)) return TermId{};
  if (head == "+") return arena_.Add(args);
  if (head == "-" && args.size() == 1) return arena_.Neg(args[0]);
  TermId result = head == "/" ? Real(args[0]) : args[0];
  for (size_t i = 1; i < args.size(); ++i) {
    result = head == "-"   ? arena_.Sub(result, args[i])
             : head == "*" ? arena_.Mul(result, args[i])
                           : arena_.Divide(result, Real(args[i]));
  }
  return result;
}

// x^(n/2), written with a number, is a power of a root; anything else is `power`.
expr::TermId TermReader::Power(const SExpr& e, TermId base, TermId exponent) {
  if (arena_.IsNumber(exponent)) {
    const Rational& y = arena_.number(exponent);
    if (y > Rational(64) || y < Rational(-64)) {
      diagnostics_.Report(Kind::kSmtUnsupported, e.span, "exponents beyond 64 are not supported");
      return {};
    }
    if (!y.IsInteger() && (y + y).IsInteger())
      return arena_.Apply(Elementary::kPower, {arena_.Apply(Elementary::kSqrt, {base}), Number(y + y)});
  }
  return arena_.Apply(Elementary::kPower, {base, exponent});
}

std::optional<expr::TermId> TermReader::Function(const SExpr& e, const Args& given) {
  const std::string& head = e.items[0].text;
  const std::optional<Elementary> function = expr::FindElementary(head);
  const bool hyperbolic = head == "sinh" || head == "cosh" || head == "tanh";
  const bool power = head == "^" || head == "pow";
  if (!function && !hyperbolic && !power && head != "to_real") {
    return std::nullopt;
  }
  const size_t arity = function ? Arity(*function) : power ? 2 : 1;
  Args args = given;
  if (!Count(e, args, arity, arity) || !Unify(e, args)) return TermId{};
  for (TermId& a : args) a = Real(a);
  if (head == "to_real") return args[0];
  if (power) return Power(e, args[0], args[1]);
  if (function) return arena_.Apply(*function, args);
  const TermId up = arena_.Apply(Elementary::kExp, {args[0]});
  const TermId down = arena_.Apply(Elementary::kExp, {arena_.Neg(args[0])});
  const TermId half = Number(*Rational::Parse("0.5"));
  if (head == "sinh") return arena_.Mul(half, arena_.Sub(up, down));
  if (head == "cosh") return arena_.Mul(half, arena_.Add(up, down));
  return arena_.Divide(arena_.Sub(up, down), arena_.Add(up, down));
}

}  // namespace rondo::lang::smtlib
