// The graph of the terms of a Propagator.
#include <fmt/format.h>

#include <optional>

#include "solve/certify/arithmetic/normal.h"
#include "solve/certify/propagator.h"

namespace rondo::solve::certify {

using expr::Op;
using expr::Rational;
using expr::TermId;

namespace {

constexpr int kMostFactors = 10'000;
constexpr uint64_t kLargestForm = 1'000'000;

}  // namespace

uint32_t Propagator::Push(const Node& node) {
  if (const auto it = interned_.find(node); it != interned_.end()) return it->second;
  const auto id = static_cast<uint32_t>(nodes_.size());
  nodes_.push_back(node);
  constants_.emplace_back();
  interned_.emplace(node, id);
  return id;
}

uint32_t Propagator::Constant(const Rational& value) {
  if (const auto it = constant_ids_.find(value); it != constant_ids_.end()) return it->second;
  const auto id = Push({Kind::kConstant, static_cast<uint32_t>(nodes_.size())});
  constants_[id] = Enclosure(value);
  constant_ids_.emplace(value, id);
  return id;
}

uint32_t Propagator::Variable(TermId variable) {
  const auto index = static_cast<uint32_t>(variables_.size());
  variables_.push_back(variable);
  variable_nodes_.push_back(Push({Kind::kVariable, index}));
  return variable_nodes_.back();
}

uint32_t Propagator::Number(TermId t) {
  if (const auto it = numbers_.find(t); it != numbers_.end()) return it->second;
  const uint32_t id = NewNumber(t);
  numbers_.emplace(t, id);
  return id;
}

uint32_t Propagator::NewNumber(TermId t) {
  const auto arg = [&](size_t i) { return Number(arena_.arg(t, i)); };
  switch (arena_.op(t)) {
    case Op::kNumber:
      return Constant(arena_.number(t));
    case Op::kVariable:
      return Variable(t);
    case Op::kToReal:
      return arg(0);
    case Op::kAdd:
      return Sum(t);
    case Op::kMul:
      return Product(t);
    case Op::kDivide: {
      const uint32_t a = arg(0);
      return Push({Kind::kDiv, a, arg(1)});
    }
    case Op::kElementary: {
      const uint32_t a = arg(0);
      const uint32_t b = arena_.args(t).size() > 1 ? arg(1) : 0;
      return Push({Kind::kFunction, a, b, 0, arena_.elementary_of(t)});
    }
    case Op::kIte: {
      const TermId condition = arena_.arg(t, 0);
      // The number of a truth value.
      const auto is = [&](size_t i, int64_t n) {
        return arena_.IsNumber(arena_.arg(t, i)) && arena_.number(arena_.arg(t, i)) == Rational(n);
      };
      if (arena_.op(condition) == Op::kVariable && is(1, 1) && is(2, 0)) return Number(condition);
      const uint32_t a = arg(1);
      const uint32_t b = arg(2);
      const uint32_t yes = Formula(condition, true);
      const uint32_t no = Formula(condition, false);
      conditions_.push_back({yes, no});
      return Push({Kind::kChoose, a, b, static_cast<uint32_t>(conditions_.size() - 1)});
    }
    default:
      throw Rejection(fmt::format("terms made with `{}` cannot be checked", expr::Name(arena_.op(t))));
  }
}

// Differences of terms first, then what is scaled alike, the constant last: sums that differ in the rest
// share their beginning.
uint32_t Propagator::Sum(TermId t) {
  std::optional<uint32_t> sum;
  Rational constant;
  std::map<Rational, std::vector<TermId>> parts;  // by the size of the coefficient
  for (const TermId part : arena_.args(t)) {
    if (arena_.IsNumber(part)) {
      constant = constant + arena_.number(part);
      continue;
    }
    const bool scaled = arena_.op(part) == Op::kMul && arena_.IsNumber(arena_.arg(part, 0));
    const Rational c = scaled ? arena_.number(arena_.arg(part, 0)) : Rational(1);
    const Rational size = c < Rational(0) ? Rational(0) - c : c;
    parts[size == Rational(1) ? Rational(0) : size].push_back(part);
  }
  for (const auto& [size, group] : parts) {
    for (const TermId part : group) {
      const bool negative = arena_.op(part) == Op::kMul && arena_.IsNumber(arena_.arg(part, 0)) &&
                            arena_.number(arena_.arg(part, 0)) == Rational(-1);
      const uint32_t id = Number(negative ? arena_.arg(part, 1) : part);
      if (sum) {
        sum = Push({negative ? Kind::kSub : Kind::kAdd, *sum, id});
      } else {
        sum = negative ? Push({Kind::kNeg, id}) : id;
      }
    }
  }
  if (!sum) return Constant(constant);
  return constant.IsZero() ? *sum : Push({Kind::kAdd, *sum, Constant(constant)});
}

// A number and powers of what else is multiplied.
uint32_t Propagator::Product(TermId t) {
  Rational coefficient(1);
  std::map<TermId, uint32_t> powers;
  std::vector<TermId> todo{t};
  for (int steps = 0; !todo.empty(); ++steps) {
    if (steps > kMostFactors) throw Rejection("a product has too many factors");
    const TermId factor = todo.back();
    todo.pop_back();
    if (arena_.op(factor) == Op::kMul) {
      todo.insert(todo.end(), {arena_.arg(factor, 0), arena_.arg(factor, 1)});
    } else if (arena_.IsNumber(factor)) {
      coefficient = coefficient * arena_.number(factor);
    } else {
      ++powers[factor];
    }
  }
  std::optional<uint32_t> product;
  for (const auto& [factor, power] : powers) {
    uint32_t id = Number(factor);
    if (power > 1) id = Push({Kind::kPow, id, 0, power});
    product = product ? Push({Kind::kMul, *product, id}) : id;
  }
  if (!product) return Constant(coefficient);
  return coefficient == Rational(1) ? *product : Push({Kind::kMul, Constant(coefficient), *product});
}

uint32_t Propagator::Compare(uint32_t node, const Rational& bound, uint8_t relation) {
  const std::pair key(node, bound);
  auto it = comparison_ids_.find(key);
  if (it == comparison_ids_.end()) {
    const Enclosure enclosure(bound);
    comparisons_.push_back({node, enclosure, 0});
    it = comparison_ids_.emplace(key, static_cast<uint32_t>(comparisons_.size() - 1)).first;
  }
  forms_.push_back({Form::Kind::kLiteral, it->second, relation, {}, 1});
  return static_cast<uint32_t>(forms_.size() - 1);
}

uint32_t Propagator::Literal(TermId a, TermId b, uint8_t relation) {
  if (arena_.IsNumber(b)) return Compare(Number(a), arena_.number(b), relation);
  if (arena_.IsNumber(a)) return Compare(Number(b), arena_.number(a), Mirrored(relation));
  const uint32_t left = Number(a);
  return Compare(Push({Kind::kSub, left, Number(b)}), Rational(0), relation);
}

uint32_t Propagator::Formula(TermId t, bool positive) {
  if (const auto it = forms_of_.find({t, positive}); it != forms_of_.end()) return it->second;
  const uint32_t id = NewFormula(t, positive);
  forms_of_.emplace(std::pair(t, positive), id);
  return id;
}

uint32_t Propagator::NewFormula(TermId t, bool positive) {
  const auto junction = [&](bool conjunction, std::vector<uint32_t> parts) {
    uint64_t size = 1;
    for (const uint32_t p : parts) size += forms_[p].size;
    if (size > kLargestForm) throw Rejection("a formula grows too large");
    forms_.push_back({conjunction ? Form::Kind::kAnd : Form::Kind::kOr, 0, 0, std::move(parts), size});
    return static_cast<uint32_t>(forms_.size() - 1);
  };
  const std::vector<TermId> args(arena_.args(t).begin(), arena_.args(t).end());
  switch (arena_.op(t)) {
    case Op::kBool:
      return junction((t == arena_.True()) == positive, {});
    case Op::kNot:
      return Formula(args[0], !positive);
    case Op::kAnd:
    case Op::kOr: {
      std::vector<uint32_t> parts;
      for (const TermId a : args) parts.push_back(Formula(a, positive));
      return junction((arena_.op(t) == Op::kAnd) == positive, std::move(parts));
    }
    case Op::kEq:
    case Op::kIte: {
      if (arena_.sort_of(args[0]) != arena_.Bool())
        return Literal(args[0], args[1], positive ? kEven : kBelow | kAbove);
      const bool ite = arena_.op(t) == Op::kIte;
      const uint32_t yes = junction(true, {Formula(args[0], true), Formula(args[1], positive)});
      const uint32_t no = junction(
          true, {Formula(args[0], false), ite ? Formula(args[2], positive) : Formula(args[1], !positive)});
      return junction(false, {yes, no});
    }
    case Op::kLe:
      return Literal(args[0], args[1], positive ? kBelow | kEven : kAbove);
    case Op::kLt:
      return Literal(args[0], args[1], positive ? kBelow : kAbove | kEven);
    case Op::kVariable:
      return Compare(Number(t), Rational(positive ? 1 : 0), positive ? kAbove | kEven : kBelow | kEven);
    default:
      throw Rejection(fmt::format("formulas made with `{}` cannot be checked", expr::Name(arena_.op(t))));
  }
}

void Propagator::RequireSum(const std::vector<std::pair<Rational, TermId>>& parts, const Rational& constant) {
  std::optional<uint32_t> sum;
  for (const auto& [coefficient, term] : parts) {
    const uint32_t factor = Number(term);
    const uint32_t id = Push({Kind::kMul, Constant(coefficient), factor});
    sum = sum ? Push({Kind::kAdd, *sum, id}) : id;
  }
  if (sum) required_.push_back(Compare(*sum, Rational(0) - constant, kEven));
}

void Propagator::Require(TermId formula) { required_.push_back(Formula(formula, true)); }

}  // namespace rondo::solve::certify
