#include "expr/arena.h"

#include <fmt/format.h>

#include <utility>

#include "base/check.h"
#include "expr/elementary.h"

namespace rondo::expr {

Arena::Arena() : interned_(64, Hash{this}, Equal{this}) {
  bool_ = AddSort({SortKind::kBool, "Bool", {}, {}});
  int_ = AddSort({SortKind::kInt, "Int", {}, {}});
  real_ = AddSort({SortKind::kReal, "Real", {}, {}});
  false_ = Intern(Op::kBool, bool_, 0, {});
  true_ = Intern(Op::kBool, bool_, 1, {});
}

// -- sorts

SortId Arena::AddSort(Sort sort) {
  const auto [it, fresh] = sort_names_.emplace(sort.name, SortId(sorts_.size()));
  if (fresh) {
    sorts_.push_back(std::move(sort));
  } else {
    const Sort& old = sorts_[it->second.index()];
    CHECK(old.kind == sort.kind && old.names == sort.names && old.parts == sort.parts)
        << "two different sorts are called " << sort.name;
  }
  return it->second;
}

SortId Arena::Enum(std::string_view name, std::vector<std::string> members) {
  return AddSort({SortKind::kEnum, std::string(name), std::move(members), {}});
}
SortId Arena::Record(std::string_view name, std::vector<std::string> fields, std::vector<SortId> sorts) {
  CHECK(fields.size() == sorts.size() && !fields.empty());
  return AddSort({SortKind::kRecord, std::string(name), std::move(fields), std::move(sorts)});
}
SortId Arena::Opaque(std::string_view name) {
  return AddSort({SortKind::kOpaque, std::string(name), {}, {}});
}
SortId Arena::Array(SortId index, SortId element) {
  return AddSort({SortKind::kArray,
                  fmt::format("Array<{},{}>", sort(index).name, sort(element).name),
                  {},
                  {index, element}});
}
SortId Arena::List(SortId element) {
  return AddSort({SortKind::kList, fmt::format("List<{}>", sort(element).name), {}, {element}});
}

// -- symbols

SymbolId Arena::Declare(std::string_view name, std::vector<SortId> parameters, SortId result) {
  const auto it = symbol_names_.find(std::string(name));
  if (it != symbol_names_.end()) {
    const Symbol& old = symbol(it->second);
    CHECK(old.parameters == parameters && old.result == result)
        << "two different symbols are called " << name;
    return it->second;
  }
  const SymbolId id(symbols_.size());
  symbol_names_.emplace(name, id);
  symbols_.push_back({std::string(name), std::move(parameters), result, false});
  return id;
}

SymbolId Arena::Fresh(std::string_view name, std::vector<SortId> parameters, SortId result) {
  std::string unique(name);
  int& serial = serials_[unique];
  while (symbol_names_.contains(unique)) unique = fmt::format("{}!{}", name, ++serial);
  return Declare(unique, std::move(parameters), result);
}

TermId Arena::FreshBound(std::string_view name, SortId sort) {
  const SymbolId id = Fresh(name, {}, sort);
  symbols_[id.index()].bound = true;
  return Variable(id);
}

// -- terms

std::span<const TermId> Arena::args(TermId id) const {
  const Term& t = term(id);
  return {pool_.data() + t.first, t.count};
}

const Rational& Arena::number(TermId id) const {
  CHECK(IsNumber(id)) << Name(op(id));
  return numbers_[term(id).payload];
}

size_t Arena::Hash::operator()(TermId id) const {
  const Term& t = arena->term(id);
  size_t h =
      static_cast<size_t>(t.op) * 0x9E3779B97F4A7C15u ^ (uint64_t{t.sort.value} * 0x85EBCA6Bu) ^ t.payload;
  for (const TermId arg : arena->args(id)) h = (h ^ arg.value) * 0x100000001B3u;
  return h;
}

bool Arena::Equal::operator()(TermId a, TermId b) const {
  const Term& x = arena->term(a);
  const Term& y = arena->term(b);
  if (x.op != y.op || x.sort != y.sort || x.payload != y.payload || x.count != y.count) return false;
  return std::equal(arena->pool_.begin() + x.first, arena->pool_.begin() + x.first + x.count,
                    arena->pool_.begin() + y.first);
}

bool Arena::HasFreeBound(TermId id, std::span<const TermId> own) const {
  std::unordered_set<TermId> seen;
  const std::function<bool(TermId, std::vector<TermId>)> visit = [&](TermId t, std::vector<TermId> bound) {
    if (!open_[t.index()]) return false;
    if (op(t) == Op::kVariable) return std::find(bound.begin(), bound.end(), t) == bound.end();
    const bool binder = op(t) == Op::kForall || op(t) == Op::kExists;
    if (binder) bound.insert(bound.end(), args(t).begin(), args(t).end() - 1);
    // A variable belongs to one quantifier, so a term means the same wherever it occurs: visit it once.
    if (!seen.insert(t).second) return false;
    for (const TermId arg : args(t)) {
      if (visit(arg, bound)) return true;
    }
    return false;
  };
  return visit(id, {own.begin(), own.end()});
}

TermId Arena::Intern(Op op, SortId sort, uint32_t payload, std::span<const TermId> args) {
  const std::vector<TermId> copy(args.begin(), args.end());  // `args` may point into the pool
  const TermId candidate(terms_.size());
  terms_.push_back(
      {op, sort, payload, static_cast<uint32_t>(pool_.size()), static_cast<uint32_t>(copy.size())});
  pool_.insert(pool_.end(), copy.begin(), copy.end());
  const auto [it, fresh] = interned_.insert(candidate);
  if (!fresh) {
    pool_.resize(terms_.back().first);
    terms_.pop_back();
    return *it;
  }
  bool open = op == Op::kVariable && symbol(SymbolId(payload)).bound;
  bool quantified = op == Op::kForall || op == Op::kExists;
  bool partial = op == Op::kElementary && IsPartialFunction(static_cast<Elementary>(payload));
  for (const TermId arg : copy) {
    open = open || open_[arg.index()];
    quantified = quantified || quantified_[arg.index()];
    partial = partial || partial_[arg.index()];
  }
  if (quantified && (op == Op::kForall || op == Op::kExists)) {
    open = HasFreeBound(copy.back(), std::span(copy).first(payload));
  }
  open_.push_back(open);
  quantified_.push_back(quantified);
  partial_.push_back(partial);
  return candidate;
}

TermId Arena::Raw(Op op, SortId sort, uint32_t payload, std::vector<TermId> args) {
  return Intern(op, sort, payload, args);
}

TermId Arena::Fire(Rewrite rewrite, Op op, SortId sort, uint32_t payload, std::vector<TermId> args,
                   TermId result) {
  if (observer) {
    const auto watch = std::exchange(observer, nullptr);
    watch(rewrite, Raw(op, sort, payload, std::move(args)), result);
    observer = watch;
  }
  return result;
}

TermId Arena::Rebuild(const Term& like, std::vector<TermId> args) {
  switch (like.op) {
    case Op::kBool:
    case Op::kNumber:
    case Op::kMember:
    case Op::kVariable:
      return Intern(like.op, like.sort, like.payload, {});
    case Op::kApply:
      return Apply(SymbolId(like.payload), std::move(args));
    case Op::kNot:
      return Not(args[0]);
    case Op::kAnd:
      return And(args);
    case Op::kOr:
      return Or(args);
    case Op::kEq:
      return Eq(args[0], args[1]);
    case Op::kIte:
      return Ite(args[0], args[1], args[2]);
    case Op::kForall:
    case Op::kExists: {
      const TermId body = args.back();
      args.pop_back();
      return Quantify(like.op, args, body);
    }
    case Op::kAdd:
      return Add(std::move(args));
    case Op::kMul:
      return Mul(args[0], args[1]);
    case Op::kDivide:
      return Divide(args[0], args[1]);
    case Op::kIntDiv:
      return IntDiv(args[0], args[1]);
    case Op::kMod:
      return Mod(args[0], args[1]);
    case Op::kLe:
      return Le(args[0], args[1]);
    case Op::kLt:
      return Lt(args[0], args[1]);
    case Op::kElementary:
      return Apply(static_cast<Elementary>(like.payload), std::move(args));
    case Op::kToReal:
      return ToReal(args[0]);
    case Op::kSelect:
      return Select(args[0], args[1]);
    case Op::kStore:
      return Store(args[0], args[1], args[2]);
    case Op::kRecord:
      return MakeRecord(like.sort, std::move(args));
    case Op::kField:
      return Field(args[0], like.payload);
    case Op::kListMake:
      return MakeList(sort(like.sort).parts[0], std::move(args));
    case Op::kListLength:
      return Length(args[0]);
    case Op::kListAt:
      return At(args[0], args[1]);
    case Op::kListAppend:
      return Append(args[0], args[1]);
    case Op::kListRemove:
      return Remove(args[0], args[1]);
    case Op::kListSet:
      return Set(args[0], args[1], args[2]);
    case Op::kListInsert:
      return Insert(args[0], args[1], args[2]);
    case Op::kListDrop:
      return Drop(args[0], args[1]);
    case Op::kListSlice:
      return Slice(args[0], args[1], args[2]);
  }
  CHECK(false);
  return {};
}

}  // namespace rondo::expr
