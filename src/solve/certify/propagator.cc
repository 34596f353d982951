#include "solve/certify/propagator.h"

#include <algorithm>
#include <optional>

#include "solve/certify/arithmetic/normal.h"

namespace rondo::solve::certify {

using expr::Elementary;

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
      Enclosure r = Enclosure::Empty();
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
    case Elementary::kPower:
      return RealPower(a, b);
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
  const auto now =
      static_cast<uint8_t>((v.MayBeBelow(c.bound) ? kBelow : 0) | (v.MayBeEqual(c.bound) ? kEven : 0) |
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
  Enclosure& value = values_[node];
  if (progress_) {
    value.Meet(to);
    return !value.IsEmpty();
  }
  const Enclosure before = value;
  value.Meet(to);
  if (value.IsEmpty()) return false;
  // Terms that are tied to each other may get narrow long before any variable does.
  progress_ = value.Share(before) < 0.95;
  return true;
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
      return Narrow(n.a, Line()) && (expr::Arity(n.function) < 2 || Narrow(n.b, Line()));
  }
}

bool Propagator::Contract(Box& box, int sweeps) {
  values_ = constants_;
  needed_.assign(nodes_.size(), 0);
  for (Comparison& c : comparisons_) c.possible = kBelow | kEven | kAbove;
  for (size_t v = 0; v < variables_.size(); ++v) values_[variable_nodes_[v]] = box[v];
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    Forward(sweep > 0);
    progress_ = false;
    if (!Backward()) return false;
    for (size_t v = 0; v < variables_.size(); ++v) {
      Enclosure& value = values_[variable_nodes_[v]];
      if (arena_.sort_of(variables_[v]) != arena_.Real()) value.Integers();
      if (value.IsEmpty()) return false;
      progress_ = progress_ || value.Share(box[v]) < 0.99;
      box[v] = value;
    }
    if (!progress_ && sweep > 0) break;
  }
  return true;
}

}  // namespace rondo::solve::certify
