#include "solve/certify/propagator.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "solve/certify/normal.h"

namespace rondo::solve::certify {

using expr::Elementary;
using expr::Op;
using expr::Rational;
using expr::TermId;

namespace {

const Enclosure& Line() {
  static const Enclosure kLine;
  return kLine;
}

Enclosure NotNegative(Enclosure z) {
  z.AtLeast(Enclosure::Interval(0, 0));
  return z;
}

}  // namespace

// -- the graph

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

// Differences of terms first, then what is scaled alike, the constant last: sums that differ in the rest share
// their beginning.
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
  while (!todo.empty()) {
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
    const bool exact = !enclosure.MayBeBelow(enclosure);
    comparisons_.push_back({node, enclosure, exact, 0});
    it = comparison_ids_.emplace(key, static_cast<uint32_t>(comparisons_.size() - 1)).first;
  }
  forms_.push_back({Form::Kind::kLiteral, it->second, relation, {}});
  return static_cast<uint32_t>(forms_.size() - 1);
}

uint32_t Propagator::Literal(TermId a, TermId b, uint8_t relation) {
  const auto mirrored = [&] {
    return static_cast<uint8_t>((relation & kEven) | ((relation & kBelow) != 0 ? kAbove : 0) |
                                ((relation & kAbove) != 0 ? kBelow : 0));
  };
  if (arena_.IsNumber(b)) return Compare(Number(a), arena_.number(b), relation);
  if (arena_.IsNumber(a)) return Compare(Number(b), arena_.number(a), mirrored());
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
    forms_.push_back({conjunction ? Form::Kind::kAnd : Form::Kind::kOr, 0, 0, std::move(parts)});
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
      if (arena_.sort_of(args[0]) != arena_.Bool()) return Literal(args[0], args[1], positive ? kEven : kBelow | kAbove);
      const bool ite = arena_.op(t) == Op::kIte;
      const uint32_t yes = junction(true, {Formula(args[0], true), Formula(args[1], positive)});
      const uint32_t no =
          junction(true, {Formula(args[0], false), ite ? Formula(args[2], positive) : Formula(args[1], !positive)});
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

void Propagator::Require(TermId formula) { required_.push_back(Formula(formula, true)); }

// -- contraction

Enclosure Propagator::Evaluate(const Node& n) const {
  const Enclosure& a = values_[n.a];
  const Enclosure& b = values_[n.b];
  switch (n.kind) {
    case Kind::kVariable:
    case Kind::kConstant:
      return Line();  // have their values
    case Kind::kAdd:
      return a + b;
    case Kind::kSub:
      return a - b;
    case Kind::kNeg:
      return Enclosure::Interval(0, 0) - a;
    case Kind::kMul:
      return a * b;
    case Kind::kDiv:
      return a / b;
    case Kind::kPow:
      return Power(a, n.n);
    case Kind::kChoose: {
      Enclosure r = a;
      r.Clear();
      if (MayHold(conditions_[n.n][0])) r.Join(a);
      if (MayHold(conditions_[n.n][1])) r.Join(b);
      return r;
    }
    case Kind::kFunction:
      break;
  }
  const auto unit = [&] {
    Enclosure r = a;
    r.Meet(Enclosure::Interval(-1, 1));
    return r;
  };
  switch (n.function) {
    case Elementary::kSqrt:
      return Root(a, 2);
    case Elementary::kAbs:
      return Abs(a);
    case Elementary::kMin:
      return Min(a, b);
    case Elementary::kMax:
      return Max(a, b);
    case Elementary::kSin:
      return Sin(a);
    case Elementary::kCos:
      return Cos(a);
    case Elementary::kTan:
      return Tan(a);
    case Elementary::kAsin:
      return Increasing(unit(), mpfr_asin);
    case Elementary::kAcos:
      return Decreasing(unit(), mpfr_acos);
    case Elementary::kAtan:
      return Increasing(a, mpfr_atan);
    case Elementary::kAtan2:
      return Atan2(a, b);
    case Elementary::kExp:
      return Increasing(a, mpfr_exp);
    case Elementary::kLog:
      return Log(a);
    case Elementary::kCount_:
      break;
  }
  return Line();
}

void Propagator::Forward(bool again) {
  for (uint32_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].kind == Kind::kVariable || nodes_[i].kind == Kind::kConstant) continue;
    Enclosure now = Evaluate(nodes_[i]);
    if (again) now.Meet(values_[i]);
    values_[i] = now;
  }
}

// What the number can be, compared with the bound: as far as its enclosure and earlier demands tell.
uint8_t Propagator::Possible(const Comparison& c) const {
  const Enclosure& v = values_[c.node];
  if (v.IsEmpty()) return 0;
  const auto now = static_cast<uint8_t>((v.MayBeBelow(c.bound) ? kBelow : 0) | (v.MayBeEqual(c.bound) ? kEven : 0) |
                                        (v.MayBeAbove(c.bound) ? kAbove : 0));
  return now & c.possible;
}

bool Propagator::MayHold(uint32_t form) const {
  const Form& f = forms_[form];
  switch (f.kind) {
    case Form::Kind::kLiteral:
      return (Possible(comparisons_[f.comparison]) & f.relation) != 0;
    case Form::Kind::kAnd:
      return std::ranges::all_of(f.parts, [this](uint32_t p) { return MayHold(p); });
    case Form::Kind::kOr:
      return std::ranges::any_of(f.parts, [this](uint32_t p) { return MayHold(p); });
  }
  return true;
}

// False: it cannot hold.
bool Propagator::Demand(uint32_t form) {
  const Form& f = forms_[form];
  switch (f.kind) {
    case Form::Kind::kLiteral:
      return DemandComparison(f);
    case Form::Kind::kAnd:
      return std::ranges::all_of(f.parts, [this](uint32_t p) { return Demand(p); });
    case Form::Kind::kOr: {
      std::optional<uint32_t> only;
      for (const uint32_t p : f.parts) {
        if (!MayHold(p)) continue;
        if (only) return true;
        only = p;
      }
      return only && Demand(*only);
    }
  }
  return true;
}

bool Propagator::DemandComparison(const Form& form) {
  Comparison& c = comparisons_[form.comparison];
  c.possible = Possible(c) & form.relation;
  if (c.possible == 0) return false;
  Enclosure& v = values_[c.node];
  if ((c.possible & kAbove) == 0) v.AtMost(c.bound);
  if ((c.possible & kBelow) == 0) v.AtLeast(c.bound);
  needed_[c.node] = 1;
  return !v.IsEmpty();
}

bool Propagator::Backward() {
  std::ranges::fill(needed_, 0);
  for (const uint32_t f : required_) {
    if (!Demand(f)) return false;
  }
  for (auto i = static_cast<uint32_t>(nodes_.size()); i-- > 0;) {
    if (needed_[i] != 0 && !BackwardNode(i)) return false;
  }
  return true;
}

// False: nothing is left.
bool Propagator::Narrow(uint32_t node, const Enclosure& to) {
  needed_[node] = 1;
  if (nodes_[node].kind == Kind::kConstant) return !to.IsEmpty() && to.MayBeEqual(values_[node]);
  values_[node].Meet(to);
  return !values_[node].IsEmpty();
}

bool Propagator::BackwardNode(uint32_t id) {
  const Node& n = nodes_[id];
  const Enclosure z = values_[id];
  if (z.IsEmpty()) return false;
  const auto a = [&]() -> const Enclosure& { return values_[n.a]; };
  const auto b = [&]() -> const Enclosure& { return values_[n.b]; };
  switch (n.kind) {
    case Kind::kVariable:
    case Kind::kConstant:
      return true;
    case Kind::kAdd:
      return Narrow(n.a, z - b()) && Narrow(n.b, z - a());
    case Kind::kSub:
      return Narrow(n.a, z + b()) && Narrow(n.b, a() - z);
    case Kind::kNeg:
      return Narrow(n.a, Enclosure::Interval(0, 0) - z);
    case Kind::kMul:
      return Narrow(n.a, WhereTimes(z, b(), a())) && Narrow(n.b, WhereTimes(z, a(), b()));
    case Kind::kDiv:
      // A quotient by 0 is some number.
      if (b().HasZero()) return Narrow(n.a, Line()) && Narrow(n.b, Line());
      return Narrow(n.a, z * b()) && Narrow(n.b, WhereTimes(a(), z, b()));
    case Kind::kPow:
      return Narrow(n.a, WherePower(z, n.n, a()));
    case Kind::kChoose:
      return BackwardChoice(n, z);
    case Kind::kFunction:
      return BackwardFunction(n, z);
  }
  return true;
}

bool Propagator::BackwardChoice(const Node& n, const Enclosure& z) {
  const auto [yes, no] = conditions_[n.n];
  const auto open = [&](uint32_t branch, uint32_t condition) {
    Enclosure v = values_[branch];
    v.Meet(z);
    return !v.IsEmpty() && MayHold(condition);
  };
  const bool a = open(n.a, yes);
  const bool b = open(n.b, no);
  if (!a && !b) return false;
  if (!b) return Demand(yes) && Narrow(n.a, z);
  if (!a) return Demand(no) && Narrow(n.b, z);
  return true;
}

bool Propagator::BackwardFunction(const Node& n, const Enclosure& z) {
  const Enclosure a = values_[n.a];
  const Enclosure half = Enclosure::Pi() / Enclosure::Interval(2, 2);
  switch (n.function) {
    case Elementary::kSqrt:
      return Narrow(n.a, Power(NotNegative(z), 2));
    case Elementary::kAbs:
      return Narrow(n.a, WherePower(Power(NotNegative(z), 2), 2, a));
    case Elementary::kMin:
    case Elementary::kMax: {
      // z = min(a, b): neither is less, and one that is greater leaves it to the other.
      const bool min = n.function == Elementary::kMin;
      const auto side = [&](const Enclosure& other) {
        Enclosure r;
        if (min) {
          r.AtLeast(z);
          if (!other.MayBeEqual(z)) r.AtMost(z);
        } else {
          r.AtMost(z);
          if (!other.MayBeEqual(z)) r.AtLeast(z);
        }
        return r;
      };
      return Narrow(n.a, side(values_[n.b])) && Narrow(n.b, side(a));
    }
    case Elementary::kSin:
      return Narrow(n.a, WhereSin(z, a));
    case Elementary::kCos: {
      const Enclosure shifted = WhereSin(z, a + half);
      return Narrow(n.a, shifted - half);
    }
    case Elementary::kAsin:
      return Narrow(n.a, Sin(z));
    case Elementary::kAcos:
      return Narrow(n.a, Cos(z));
    case Elementary::kAtan:
      return Narrow(n.a, Tan(z));
    case Elementary::kExp:
      return Narrow(n.a, Log(z));
    case Elementary::kLog:
      return Narrow(n.a, Increasing(z, mpfr_exp));
    default:
      return Narrow(n.a, Line()) && (n.function != Elementary::kAtan2 || Narrow(n.b, Line()));
  }
}

bool Propagator::Contract(Box& box, int sweeps) {
  values_ = constants_;
  needed_.assign(nodes_.size(), 0);
  for (Comparison& c : comparisons_) c.possible = kBelow | kEven | kAbove;
  for (size_t v = 0; v < variables_.size(); ++v) values_[variable_nodes_[v]] = box[v];
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    Forward(sweep > 0);
    if (!Backward()) return false;
    bool progress = false;
    for (size_t v = 0; v < variables_.size(); ++v) {
      Enclosure& value = values_[variable_nodes_[v]];
      if (arena_.sort_of(variables_[v]) != arena_.Real()) value.Integers();
      if (value.IsEmpty()) return false;
      progress = progress || value.Share(box[v]) < 0.99;
      box[v] = value;
    }
    if (!progress && sweep > 0) break;
  }
  return true;
}

}  // namespace rondo::solve::certify
