#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "koord/check/checker.h"
#include "lang/expr_queries.h"

namespace rondo::koord {

using diag::Kind;
using diag::Span;
using lang::ExprKind;
using lang::TypeKind;

TypeId Checker::Mismatch(Span span, std::string message) {
  diagnostics_.Report(Kind::kKoordTypeMismatch, span, std::move(message));
  return model_.types.error();
}

TypeId Checker::Expr(ExprId id) {
  const TypeId type = Visit(id, exprs_[id]);
  model_.type_of[id.index()] = type;
  return type;
}

TypeId Checker::Visit(ExprId id, const lang::Expr& e) {
  auto& types = model_.types;
  switch (e.kind) {
    case ExprKind::kError:
      return types.error();
    case ExprKind::kInt:
      return types.integer();
    case ExprKind::kFloat:
      return types.real();
    case ExprKind::kString:
      return types.string();
    case ExprKind::kBool:
      return types.boolean();
    case ExprKind::kPid:
      return types.integer();
    case ExprKind::kName:
      return Name(id, e);
    case ExprKind::kField:
      return Field(id, e);
    case ExprKind::kIndex:
      return Index(id, e);
    case ExprKind::kCall:
      return Call(id, e);
    case ExprKind::kUnary:
      return Unary(e);
    case ExprKind::kBinary:
      return Binary(e);
    case ExprKind::kList:
      return List(e);
    case ExprKind::kTuple: {
      std::vector<TypeId> parts;
      for (const ExprId arg : e.args) parts.push_back(Expr(arg));
      return types.Tuple(std::move(parts));
    }
    case ExprKind::kQuantifier:
      return Quantifier(id, e);
    case ExprKind::kFold:
      return Fold(id, e);
    case ExprKind::kConditional:
      return Conditional(e);
    case ExprKind::kAny:
      return Any(e);
    case ExprKind::kQuantity:
      break;  // not part of Koord
  }
  return types.error();
}

void Checker::NeedBool(ExprId e, std::string_view what) {
  const TypeId type = Expr(e);
  if (model_.types.Unify(type, model_.types.boolean())) return;
  diagnostics_.Report(Kind::kKoordNotBoolean, exprs_[e].span, fmt::format("{} must be true or false", what))
      .Under(fmt::format("this is {}", model_.types.WithArticle(type)));
}

bool Checker::IsArrayLiteral(ExprId e, TypeId wanted) const {
  return exprs_[e].kind == ExprKind::kList && model_.types.Is(wanted, TypeKind::kArray);
}

// A list of as many items as the array has.
void Checker::NeedArray(ExprId e, TypeId array, std::string_view what) {
  const lang::Expr& list = exprs_[e];
  const std::string length = model_.types[array].length;
  const TypeId item = model_.types[array].parts[0];
  model_.type_of[e.index()] = array;
  const bool number = std::ranges::all_of(length, [](unsigned char c) { return std::isdigit(c) != 0; });
  if (!number || length != std::to_string(list.args.size())) {
    auto& report = diagnostics_.Report(Kind::kKoordTypeMismatch, list.span,
                                       fmt::format("{} must be {}", what, model_.types.WithArticle(array)));
    report.Under(fmt::format("these are {} items", list.args.size()));
    if (!number) report.Help("how many items there are is known only when it runs: assign them in `init`");
  }
  for (const ExprId arg : list.args) NeedType(arg, item, "an item");
}

void Checker::NeedType(ExprId e, TypeId wanted, std::string_view what) {
  if (IsArrayLiteral(e, wanted)) return NeedArray(e, wanted, what);
  const TypeId type = Expr(e);
  if (model_.types.Coerce(type, wanted)) return;
  auto& report = diagnostics_.Report(Kind::kKoordTypeMismatch, exprs_[e].span,
                                     fmt::format("{} must be {}", what, model_.types.WithArticle(wanted)));
  report.Under(fmt::format("this is {}", model_.types.WithArticle(type)));
}

TypeId Checker::Unary(const lang::Expr& e) {
  auto& types = model_.types;
  if (e.text == "not") {
    NeedBool(e.args[0], "the operand of `not`");
    return types.boolean();
  }
  const TypeId type = Expr(e.args[0]);
  if (types.Is(type, TypeKind::kVariable)) types.Unify(type, types.real());
  if (types.IsNumeric(type) || types.Is(type, TypeKind::kError) || types.Resolve(type) == types.pos())
    return type;
  return Mismatch(e.span, fmt::format("`-` needs a number, not {}", types.WithArticle(type)));
}

TypeId Checker::Binary(const lang::Expr& e) {
  auto& types = model_.types;
  if (e.text == "and" || e.text == "or" || e.text == "implies") {
    for (const ExprId arg : e.args) NeedBool(arg, fmt::format("an operand of `{}`", e.text));
    return types.boolean();
  }
  const TypeId a = Expr(e.args[0]);
  if (e.text == "in" || e.text == "not in") return Membership(e, a);
  const TypeId b = Expr(e.args[1]);
  const bool arithmetic = e.text == "+" || e.text == "-" || e.text == "*" || e.text == "/" || e.text == "%";
  return arithmetic ? Arithmetic(e, a, b) : Comparison(e, a, b);
}

TypeId Checker::Arithmetic(const lang::Expr& e, TypeId a, TypeId b) {
  auto& types = model_.types;
  if (types.Is(a, TypeKind::kError) || types.Is(b, TypeKind::kError)) return types.error();
  // What nothing has told yet: like the other side, but a factor or divisor of a point is a number.
  const bool scales = e.text == "*" || e.text == "/";
  const auto settle = [&](TypeId unknown, TypeId other) {
    if (!types.Is(unknown, TypeKind::kVariable)) return;
    types.Unify(unknown, types.Is(other, TypeKind::kInt) || types.Is(other, TypeKind::kVariable) || scales
                             ? types.real()
                             : other);
  };
  settle(a, b);
  settle(b, a);
  const bool pos_a = types.Resolve(a) == types.pos();
  const bool pos_b = types.Resolve(b) == types.pos();
  if (types.IsNumeric(a) && types.IsNumeric(b)) {
    const bool both_int = types.Is(a, TypeKind::kInt) && types.Is(b, TypeKind::kInt);
    if (e.text == "%" && !both_int) return Mismatch(e.span, "`%` needs two integers");
    return both_int ? types.integer() : types.real();
  }
  if (pos_a && pos_b && (e.text == "+" || e.text == "-")) return types.pos();
  if (pos_a && types.IsNumeric(b) && scales) return types.pos();
  if (types.IsNumeric(a) && pos_b && e.text == "*") return types.pos();
  if (e.text == "+" && (types.Is(a, TypeKind::kString) || types.Is(b, TypeKind::kString)))
    return types.string();
  diagnostics_
      .Report(
          Kind::kKoordTypeMismatch, e.span,
          fmt::format("`{}` does not work on {} and {}", e.text, types.WithArticle(a), types.WithArticle(b)))
      .At(exprs_[e.args[0]].span, fmt::format("`{}`", types.Name(a)))
      .At(exprs_[e.args[1]].span, fmt::format("`{}`", types.Name(b)));
  return types.error();
}

TypeId Checker::Comparison(const lang::Expr& e, TypeId a, TypeId b) {
  auto& types = model_.types;
  const auto literal = [&](ExprId x) { return exprs_[x].kind == ExprKind::kInt; };
  // A whole number beside something unknown does not make it an int.
  if (types.Is(a, TypeKind::kVariable) && literal(e.args[1])) types.Unify(a, types.real());
  if (types.Is(b, TypeKind::kVariable) && literal(e.args[0])) types.Unify(b, types.real());
  const bool equality = e.text == "==" || e.text == "!=";
  const bool numbers = types.IsNumeric(a) && types.IsNumeric(b);
  if (numbers || types.Is(a, TypeKind::kError) || types.Is(b, TypeKind::kError)) return types.boolean();
  if (types.Unify(a, b)) {
    if (equality && !types.Is(a, TypeKind::kStream)) return types.boolean();
    if (types.Is(a, TypeKind::kVariable)) types.Unify(a, types.real());
    if (types.IsNumeric(a)) return types.boolean();
    diagnostics_.Report(Kind::kKoordTypeMismatch, e.span,
                        fmt::format("`{}` compares numbers, not {}", e.text, types.WithArticle(a)));
    return types.boolean();
  }
  diagnostics_
      .Report(Kind::kKoordTypeMismatch, e.span,
              fmt::format("{} cannot be compared with {}", types.WithArticle(a), types.WithArticle(b)))
      .At(exprs_[e.args[0]].span, fmt::format("`{}`", types.Name(a)))
      .At(exprs_[e.args[1]].span, fmt::format("`{}`", types.Name(b)));
  return types.boolean();
}

// p in rect(a, b); x in list; i in ID
TypeId Checker::Membership(const lang::Expr& e, TypeId a) {
  auto& types = model_.types;
  const ExprId right = e.args[1];
  const lang::Expr& set = exprs_[right];
  if (set.kind == ExprKind::kName && set.text == "ID" && FindVariable("ID") < 0) {
    if (!types.Unify(a, types.integer()))
      Mismatch(exprs_[e.args[0]].span, "the number of a robot is an `int`");
    return types.boolean();
  }
  if (set.kind == ExprKind::kCall && exprs_[set.args[0]].kind == ExprKind::kName &&
      exprs_[set.args[0]].text == "rect" && !claimed_.contains("rect")) {
    Set(right, RefKind::kBuiltin, static_cast<size_t>(Builtin::kRect));
    if (Arity(set, 2, 2, "rect")) {
      NeedType(set.args[1], types.pos(), "a corner of `rect`");
      NeedType(set.args[2], types.pos(), "a corner of `rect`");
    }
    if (!types.Unify(a, types.pos())) {
      Mismatch(exprs_[e.args[0]].span,
               fmt::format("only a `pos` can be in a `rect`, not {}", types.WithArticle(a)));
    }
    return types.boolean();
  }
  const TypeId b = Expr(right);
  const TypeId element = types.FreshVariable();
  if (types.Is(b, TypeKind::kError)) return types.boolean();
  if (!types.Is(b, TypeKind::kList) && !types.Is(b, TypeKind::kVariable)) {
    Mismatch(set.span, fmt::format("`in` needs a list, `ID` or `rect(a, b)`, not {}", types.WithArticle(b)));
    return types.boolean();
  }
  types.Unify(b, types.List(element));
  if (!types.Coerce(a, element)) {
    Mismatch(e.span, fmt::format("{} cannot be in {}", types.WithArticle(a), types.WithArticle(b)));
  }
  return types.boolean();
}

uint32_t Checker::Bind(const std::string& name, TypeId type, Span span) {
  const auto index = static_cast<uint32_t>(model_.bindings.size());
  model_.bindings.push_back({name, type, span});
  scope_.push_back(index);
  return index;
}

TypeId Checker::Conditional(const lang::Expr& e) {
  auto& types = model_.types;
  NeedBool(e.args[0], "the condition of a value");
  const TypeId a = Expr(e.args[1]);
  const TypeId b = Expr(e.args[2]);
  if (types.IsNumeric(a) && types.IsNumeric(b))
    return types.Is(a, TypeKind::kInt) && types.Is(b, TypeKind::kInt) ? types.integer() : types.real();
  if (types.Is(a, TypeKind::kError) || types.Is(b, TypeKind::kError)) return types.error();
  if (types.Unify(a, b)) return a;
  diagnostics_.Report(Kind::kKoordTypeMismatch, e.span, "both values must have one type")
      .At(exprs_[e.args[1]].span, fmt::format("`{}`", types.Name(a)))
      .At(exprs_[e.args[2]].span, fmt::format("`{}`", types.Name(b)));
  return types.error();
}

// any q in [1, 2, 4]; any int in 0..5: one of these values, and nothing says which.
TypeId Checker::Any(const lang::Expr& e) {
  auto& types = model_.types;
  if (!may_choose_) {
    diagnostics_.Report(Kind::kKoordSpecScope, e.span, "only a running event can choose a value")
        .Help("`any` belongs into `eff` or `init`, outside quantifiers; keep what was chosen in a variable");
  }
  TypeId element = types.integer();
  if (e.args.size() > 1) {
    NeedType(e.args[0], types.integer(), "the first value of a range");
    NeedType(e.args[1], types.integer(), "the last value of a range");
  } else {
    const TypeId list = Expr(e.args[0]);
    element = types.FreshVariable();
    if (!types.Unify(list, types.List(element))) {
      return Mismatch(exprs_[e.args[0]].span,
                      fmt::format("`any` chooses from a list or a range such as `0..5`, not from {}",
                                  types.WithArticle(list)));
    }
  }
  const auto named = TypeNamed(e.text);
  if (named && !(e.args.size() > 1 ? types.Unify(element, *named) : types.Coerce(element, *named)))
    return Mismatch(e.span,
                    fmt::format("these are values of type `{}`, not `{}`", types.Name(element), e.text));
  return element;
}

// What a word between `any` and `in` says of the type; nothing if it is only a name.
std::optional<TypeId> Checker::TypeNamed(const std::string& word) const {
  const auto& types = model_.types;
  if (const auto it = model_.named_types.find(word); it != model_.named_types.end()) return it->second;
  if (word == "int") return types.integer();
  if (word == "float") return types.real();
  if (word == "bool") return types.boolean();
  if (word == "string") return types.string();
  if (word == "pos") return types.pos();
  return std::nullopt;
}

// Does what the quantifier's body supposes bound these numbers from both sides?
bool Checker::Bounds(const lang::Expr& quantifier, const std::vector<std::string>& names) const {
  const std::vector<ExprId> conditions =
      lang::SuppositionsOf(exprs_, quantifier.args[0], quantifier.text == "forall");
  const auto bounded = [&](const std::string& name, bool above) {
    return std::ranges::any_of(conditions, [&](ExprId id) {
      const lang::Expr& e = exprs_[id];
      if (e.kind != ExprKind::kBinary || (e.text[0] != '<' && e.text[0] != '>')) return false;
      const size_t side = (e.text[0] == '<') == above ? 0 : 1;
      return exprs_[e.args[side]].kind == ExprKind::kName && exprs_[e.args[side]].text == name;
    });
  };
  return std::ranges::all_of(
      names, [&](const std::string& name) { return bounded(name, true) && bounded(name, false); });
}

TypeId Checker::Quantifier(ExprId id, const lang::Expr& e) {
  auto& types = model_.types;
  const size_t depth = scope_.size();
  Model::Domains domains;
  for (const lang::Binder& binder : e.binders) {
    DomainKind kind = DomainKind::kType;
    TypeId type = types.error();
    const lang::Expr* domain = binder.domain.valid() ? &exprs_[binder.domain] : nullptr;
    if (domain == nullptr) {
      type = TypeOf(binder.type);
    } else if (domain->kind == ExprKind::kName && domain->text == "ID" && FindVariable("ID") < 0) {
      kind = DomainKind::kRobots;
      type = types.integer();
    } else if (domain->kind == ExprKind::kName && FindVariable(domain->text) < 0 &&
               (model_.named_types.contains(domain->text) || domain->text == "int" ||
                domain->text == "float" || domain->text == "bool" || domain->text == "pos" ||
                domain->text == "Point" ||
                (std::isupper(static_cast<unsigned char>(domain->text[0])) &&
                 !claimed_.contains(domain->text)))) {
      lang::TypeSyntax syntax;
      syntax.name = domain->text;
      syntax.span = domain->span;
      type = TypeOf(syntax);
    } else {
      kind = DomainKind::kList;
      const TypeId list = Expr(binder.domain);
      type = types.FreshVariable();
      if (!types.Is(list, TypeKind::kError) && !types.Unify(list, types.List(type))) {
        Mismatch(domain->span, fmt::format("`{}` ranges over `ID`, a type or a list, not over {}", e.text,
                                           types.WithArticle(list)));
        type = types.error();
      }
    }
    if (kind == DomainKind::kType && place_ != Place::kSpec &&
        !(types.Is(type, TypeKind::kInt) && Bounds(e, binder.names))) {
      diagnostics_
          .Report(Kind::kKoordSpecScope, e.span,
                  "a program can only range over robots, lists and ranges of numbers")
          .Help("a robot cannot try every value of a type; `forall c in range(n): ...` tries 0 .. n - 1");
    }
    std::vector<uint32_t> bound;
    for (size_t i = 0; i < binder.names.size(); ++i)
      bound.push_back(Bind(binder.names[i], type, binder.spans[i]));
    domains.kinds.push_back(kind);
    domains.bindings.push_back(std::move(bound));
  }
  const bool may_choose = std::exchange(may_choose_, false);
  NeedBool(e.args[0], fmt::format("the body of `{}`", e.text));
  if (const auto range = lang::RangeOf(exprs_, e)) {
    for (const ExprId limit : {range->from, range->to}) {
      if (types.Is(model_.TypeOf(limit), TypeKind::kFloat))
        Mismatch(exprs_[limit].span, "the limits of a range are ints, and this is a `float`");
    }
  }
  may_choose_ = may_choose;
  scope_.resize(depth);
  model_.domains[id] = std::move(domains);
  return types.boolean();
}

TypeId Checker::List(const lang::Expr& e) {
  auto& types = model_.types;
  TypeId element = types.FreshVariable();
  for (const ExprId item : e.args) {
    const TypeId type = Expr(item);
    if (types.Is(element, TypeKind::kInt) && types.Is(type, TypeKind::kFloat)) element = types.real();
    if (!types.Coerce(type, element)) {
      diagnostics_.Report(Kind::kKoordTypeMismatch, exprs_[item].span, "the items of a list have one type")
          .Under(fmt::format("this is {}", types.WithArticle(type)))
          .At(exprs_[e.args[0]].span, fmt::format("this is {}", types.WithArticle(element)));
    }
  }
  return types.List(element);
}

}  // namespace rondo::koord
