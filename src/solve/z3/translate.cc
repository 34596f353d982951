#include "solve/z3/translate.h"

#include "base/check.h"
#include "expr/smtlib/smtlib.h"
#include "expr/substitute.h"

namespace rondo::solve::z3 {

using expr::Op;
using expr::SortKind;
using expr::TermId;

const Translator::SortInfo& Translator::Sort(expr::SortId id) {
  if (const auto it = sorts_.find(id); it != sorts_.end()) return it->second;
  const expr::Sort& s = arena_.sort(id);
  SortInfo info{context_.bool_sort(), ::z3::func_decl_vector(context_), ::z3::func_decl_vector(context_)};
  const std::string name = "sort " + s.name;
  switch (s.kind) {
    case SortKind::kBool:
      break;
    case SortKind::kInt:
      info.sort = context_.int_sort();
      break;
    case SortKind::kReal:
      info.sort = context_.real_sort();
      break;
    case SortKind::kArray:
      info.sort = context_.array_sort(Sort(s.parts[0]).sort, Sort(s.parts[1]).sort);
      break;
    case SortKind::kList:
    case SortKind::kOpaque:
      info.sort = context_.uninterpreted_sort(name.c_str());
      break;
    case SortKind::kEnum: {
      std::vector<std::string> names;
      std::vector<const char*> pointers;
      for (const std::string& member : s.names) names.push_back(s.name + "." + member);
      for (const std::string& member : names) pointers.push_back(member.c_str());
      ::z3::func_decl_vector testers(context_);
      info.sort = context_.enumeration_sort(name.c_str(), static_cast<unsigned>(pointers.size()),
                                            pointers.data(), info.constructors, testers);
      break;
    }
    case SortKind::kRecord: {
      std::vector<std::string> names;
      std::vector<const char*> pointers;
      std::vector<::z3::sort> sorts;
      for (size_t i = 0; i < s.parts.size(); ++i) {
        names.push_back(s.name + "." + s.names[i]);
        sorts.push_back(Sort(s.parts[i]).sort);
      }
      for (const std::string& field : names) pointers.push_back(field.c_str());
      const ::z3::func_decl make = context_.tuple_sort(name.c_str(), static_cast<unsigned>(pointers.size()),
                                                       pointers.data(), sorts.data(), info.fields);
      info.sort = make.range();
      info.constructors.push_back(make);
      break;
    }
  }
  return sorts_.emplace(id, std::move(info)).first->second;
}

::z3::func_decl Translator::Function(expr::SymbolId id) {
  if (const auto it = functions_.find(id); it != functions_.end()) return it->second;
  const expr::Symbol& symbol = arena_.symbol(id);
  ::z3::sort_vector domain(context_);
  for (const expr::SortId p : symbol.parameters) domain.push_back(Sort(p).sort);
  ::z3::func_decl f = context_.function(symbol.name.c_str(), domain, Sort(symbol.result).sort);
  functions_.emplace(id, f);
  return f;
}

::z3::func_decl Translator::ListFunction(TermId t) {
  const auto args = arena_.args(t);
  const Op op = arena_.op(t);
  const expr::SortId list = op == Op::kListMake ? arena_.sort_of(t) : arena_.sort_of(args[0]);
  ::z3::sort_vector domain(context_);
  for (const TermId arg : args) domain.push_back(Sort(arena_.sort_of(arg)).sort);
  const std::string name = expr::ListFunctionName(arena_, op, list, args.size());
  return context_.function(name.c_str(), domain, Sort(arena_.sort_of(t)).sort);
}

::z3::expr_vector Translator::Args(TermId t) {
  ::z3::expr_vector args(context_);
  for (const TermId arg : arena_.args(t)) args.push_back(terms_.at(arg));
  return args;
}

::z3::expr Translator::operator()(TermId root) {
  expr::VisitPostorder(arena_, root, seen_, [&](TermId t) { terms_.emplace(t, Build(t, Args(t))); });
  return terms_.at(root);
}

// Z3's own power has other values where ours is some number or 1: only products are told.
::z3::expr Translator::Power(TermId exponent, const ::z3::expr& base) {
  constexpr int64_t kMost = 64;
  if (!arena_.IsNumber(exponent) || !arena_.number(exponent).IsInteger() ||
      arena_.number(exponent) > expr::Rational(kMost) || arena_.number(exponent) < expr::Rational(-kMost))
    throw ::z3::exception("Z3 does not know this power");
  const auto n = static_cast<int64_t>(arena_.number(exponent).ToDouble());
  ::z3::expr product = context_.real_val(1);
  for (int64_t i = 0; i < std::abs(n); ++i) product = product * base;
  return n < 0 ? context_.real_val(1) / product : product;
}

::z3::expr Translator::Build(TermId t, const ::z3::expr_vector& args) {
  const expr::Term& term = arena_.term(t);
  const auto arg = [&](unsigned i) { return args[static_cast<int>(i)]; };
  switch (term.op) {
    case Op::kBool:
      return context_.bool_val(t == arena_.True());
    case Op::kNumber: {
      const expr::Rational& value = arena_.number(t);
      if (term.sort == arena_.Int()) return context_.int_val(value.Numerator().c_str());
      return context_.real_val((value.Numerator() + "/" + value.Denominator()).c_str());
    }
    case Op::kMember:
      return Sort(term.sort).constructors[static_cast<int>(term.payload)]();
    case Op::kVariable:
    case Op::kApply:
      return Function(expr::SymbolId(term.payload))(args);
    case Op::kNot:
      return !arg(0);
    case Op::kAnd:
      return ::z3::mk_and(args);
    case Op::kOr:
      return ::z3::mk_or(args);
    case Op::kEq:
      return arg(0) == arg(1);
    case Op::kIte:
      return ::z3::ite(arg(0), arg(1), arg(2));
    case Op::kForall:
    case Op::kExists: {
      ::z3::expr_vector variables(context_);
      for (unsigned i = 0; i + 1 < args.size(); ++i) variables.push_back(arg(i));
      const ::z3::expr body = arg(args.size() - 1);
      return term.op == Op::kForall ? ::z3::forall(variables, body) : ::z3::exists(variables, body);
    }
    case Op::kAdd:
      return ::z3::sum(args);
    case Op::kMul:
      return arg(0) * arg(1);
    case Op::kDivide:
    case Op::kIntDiv:
      return arg(0) / arg(1);
    case Op::kMod:
      return ::z3::mod(arg(0), arg(1));
    case Op::kLe:
      return arg(0) <= arg(1);
    case Op::kLt:
      return arg(0) < arg(1);
    case Op::kToReal:
      return ::z3::to_real(arg(0));
    case Op::kElementary:
      switch (static_cast<expr::Elementary>(term.payload)) {
        case expr::Elementary::kAbs:
          return ::z3::ite(arg(0) >= 0, arg(0), -arg(0));
        case expr::Elementary::kMin:
          return ::z3::ite(arg(0) <= arg(1), arg(0), arg(1));
        case expr::Elementary::kMax:
          return ::z3::ite(arg(0) >= arg(1), arg(0), arg(1));
        case expr::Elementary::kPower:
          return Power(arena_.arg(t, 1), arg(0));
        default:
          // Caught where other errors of Z3 are.
          throw ::z3::exception("Z3 does not know this function of reals");
      }
    case Op::kSelect:
      return ::z3::select(arg(0), arg(1));
    case Op::kStore:
      return ::z3::store(arg(0), arg(1), arg(2));
    case Op::kRecord:
      return Sort(term.sort).constructors[0](args);
    case Op::kField:
      return Sort(arena_.sort_of(arena_.arg(t, 0))).fields[static_cast<int>(term.payload)](args);
    case Op::kListMake:
    case Op::kListLength:
    case Op::kListAt:
    case Op::kListAppend:
    case Op::kListRemove:
    case Op::kListSet:
    case Op::kListInsert:
    case Op::kListDrop:
    case Op::kListSlice:
      return ListFunction(t)(args);
  }
  CHECK(false);
  return context_.bool_val(false);
}

std::optional<expr::Rational> Translator::Near(const ::z3::expr& value) {
  if (!value.is_algebraic() || value.is_numeral()) return std::nullopt;
  constexpr unsigned kDigits = 20;
  const ::z3::expr below(context_, Z3_get_algebraic_number_lower(context_, value, kDigits));
  return expr::Rational::Parse(Z3_get_numeral_string(context_, below));
}

expr::Value Translator::Read(const ::z3::expr& value, expr::SortId id) {
  const expr::Sort& s = arena_.sort(id);
  switch (s.kind) {
    case SortKind::kBool:
      return {value.is_true()};
    case SortKind::kInt:
    case SortKind::kReal: {
      const auto number =
          value.is_numeral() ? expr::Rational::Parse(Z3_get_numeral_string(context_, value)) : std::nullopt;
      if (!number) throw ::z3::exception("not a rational number");
      return {*number};
    }
    case SortKind::kEnum: {
      const std::string name = value.decl().name().str();
      return {name.substr(s.name.size() + 1)};
    }
    case SortKind::kRecord: {
      expr::Value::Fields fields;
      if (value.num_args() != s.parts.size()) throw ::z3::exception("not a record value");
      for (unsigned i = 0; i < value.num_args(); ++i) fields.push_back(Read(value.arg(i), s.parts[i]));
      return {std::move(fields)};
    }
    case SortKind::kArray:
      return {std::string("[...]")};  // a function over all integers: too much to tell
    case SortKind::kList:
    case SortKind::kOpaque:
      return {value.to_string()};
  }
  CHECK(false);
  return {};
}

}  // namespace rondo::solve::z3
