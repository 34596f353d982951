#include "reach/problem/bounds.h"

#include <algorithm>
#include <cmath>

#include "expr/substitute.h"
#include "verdict/truth.h"

namespace rondo::reach {

using expr::Op;

namespace {

// term <= 0 with a term of the form factor * variable + constant bounds the variable.
struct Bound {
  size_t variable;
  bool upper;
  Rational value;
};
std::optional<Bound> BoundOf(const expr::Arena& arena, const Program& p, TermId term) {
  Rational constant(0);
  TermId rest = term;
  if (arena.op(term) == Op::kAdd) {
    const auto args = arena.args(term);
    if (args.size() != 2) return std::nullopt;
    const size_t number = arena.IsNumber(args[0]) ? 0 : 1;
    if (!arena.IsNumber(args[number])) return std::nullopt;
    constant = arena.number(args[number]);
    rest = args[1 - number];
  }
  Rational factor(1);
  if (arena.op(rest) == Op::kMul && arena.args(rest).size() == 2 && arena.IsNumber(arena.arg(rest, 0))) {
    factor = arena.number(arena.arg(rest, 0));
    rest = arena.arg(rest, 1);
  }
  const auto it = std::find(p.variables.begin(), p.variables.end(), rest);
  if (it == p.variables.end()) return std::nullopt;
  return Bound{static_cast<size_t>(it - p.variables.begin()), factor > Rational(0),
               (Rational(0) - constant) / factor};
}

class Shaver {
 public:
  Shaver(const Program& p, const Formula& f, interval::Box& box) : p_(p), f_(f), box_(box) {}

  void Run() {
    for (int round = 0; round < 3; ++round) {
      for (size_t i = 0; i < box_.size(); ++i) {
        if (box_[i].IsPoint()) continue;
        Unbounded(i);
        for (const double share : {0.5, 0.125}) {
          for (const bool upper : {true, false}) {
            for (int part = 0; part < 60 && Cut(i, upper, share); ++part) {
            }
          }
        }
        Fine(i, true);
        Fine(i, false);
      }
    }
  }

 private:
  bool Fails(size_t i, Interval slab) {
    const Interval side = box_[i];
    box_[i] = slab;
    const bool fails = CheckBox(p_, f_, box_) == verdict::Truth::kFalse;
    box_[i] = side;
    return fails;
  }
  void Unbounded(size_t i) {
    for (int e = 0; e < 60 && std::isinf(box_[i].hi); ++e) {
      const double from = std::max(std::ldexp(1.0, e), box_[i].lo);
      if (Fails(i, {from, box_[i].hi})) box_[i].hi = from;
    }
    for (int e = 0; e < 60 && std::isinf(box_[i].lo); ++e) {
      const double to = std::min(-std::ldexp(1.0, e), box_[i].hi);
      if (Fails(i, {box_[i].lo, to})) box_[i].lo = to;
    }
  }
  // Cuts off such a share of the side, if the formula fails there.
  bool Cut(size_t i, bool upper, double share) {
    Interval& side = box_[i];
    if (!std::isfinite(side.lo) || !std::isfinite(side.hi)) return false;
    const double w = side.Width() * share;
    const Interval slab = upper ? Interval{side.hi - w, side.hi} : Interval{side.lo, side.lo + w};
    if (!(slab.lo < slab.hi) || !Fails(i, slab)) return false;
    (upper ? side.hi : side.lo) = upper ? slab.lo : slab.hi;
    return true;
  }
  // The outermost slab that fails, by bisection of its thickness.
  void Fine(size_t i, bool upper) {
    Interval& side = box_[i];
    if (!std::isfinite(side.lo) || !std::isfinite(side.hi)) return;
    double w = side.Width() / 8;
    for (int k = 0; k < 40 && w > 1e-14 * std::max(std::fabs(side.lo), std::fabs(side.hi)); ++k, w /= 2) {
      const Interval slab = upper ? Interval{side.hi - w, side.hi} : Interval{side.lo, side.lo + w};
      if (slab.lo < slab.hi && slab.lo >= side.lo && slab.hi <= side.hi && Fails(i, slab))
        (upper ? side.hi : side.lo) = upper ? slab.lo : slab.hi;
    }
  }

  const Program& p_;
  const Formula& f_;
  interval::Box& box_;
};

}  // namespace

std::vector<TermId> Necessary(const Formula& formula) {
  std::vector<TermId> result;
  std::vector<size_t> open{formula.root};
  while (!open.empty()) {
    const Formula::Node& node = formula.nodes[open.back()];
    open.pop_back();
    if (node.kind == Formula::Kind::kAnd) open.insert(open.end(), node.parts.begin(), node.parts.end());
    if (node.kind == Formula::Kind::kAtom) result.push_back(formula.terms[node.atom]);
  }
  return result;
}

std::vector<Interval> ValuesOn(const Program& p, const interval::Box& box) {
  std::vector<Interval> v(p.code.size());
  const auto constant = [](const LinearPart& part) {
    return Interval::Point(part.factor) + Interval{-part.error, part.error};
  };
  for (size_t n = 0; n < p.code.size(); ++n) {
    const Code& c = p.code[n];
    switch (c.op) {
      case CodeOp::kVariable:
        v[n] = box[c.a];
        break;
      case CodeOp::kLinear:
        v[n] = constant(p.constants[n]);
        for (uint32_t i = c.a; i < c.a + c.b; ++i) v[n] = v[n] + constant(p.parts[i]) * v[p.parts[i].node];
        break;
      case CodeOp::kProduct:
        v[n] = c.a == c.b ? interval::Sqr(v[c.a]) : v[c.a] * v[c.b];
        break;
      case CodeOp::kReciprocal:
        v[n] = Interval::Point(1) / v[c.a];
        break;
      case CodeOp::kRoot:
        v[n] = interval::Sqrt(v[c.a]);
        break;
      case CodeOp::kSine:
        v[n] = interval::Sin(v[c.a]);
        break;
      case CodeOp::kCosine:
        v[n] = interval::Cos(v[c.a]);
        break;
      case CodeOp::kExp:
        v[n] = interval::Exp(v[c.a]);
        break;
      case CodeOp::kLog:
        v[n] = interval::Log(v[c.a]);
        break;
      case CodeOp::kAtan:
        v[n] = interval::Atan(v[c.a]);
        break;
      case CodeOp::kAtan2:
        v[n] = interval::Atan2(v[c.a], v[c.b]);
        break;
      case CodeOp::kAbs:
        v[n] = interval::Abs(v[c.a]);
        break;
      case CodeOp::kMax:
        v[n] = interval::Max(v[c.a], v[c.b]);
        break;
      case CodeOp::kChoose:
        v[n] = v[c.a].hi <= 0 ? v[c.b] : v[c.a].lo > 0 ? v[c.c] : interval::Hull(v[c.b], v[c.c]);
        break;
    }
    if (std::isnan(v[n].lo) || std::isnan(v[n].hi)) v[n] = {};
  }
  return v;
}

verdict::Truth CheckBox(const Program& terms, const Formula& formula, const interval::Box& box) {
  const std::vector<Interval> values = ValuesOn(terms, box);
  return formula.Check([&](size_t atom) { return values[terms.outputs[atom]]; });
}

std::vector<std::optional<Rational>> Pinned(const expr::Arena& arena, const Program& terms,
                                            const Formula& formula) {
  std::vector<std::optional<Rational>> least(terms.variables.size()), most(terms.variables.size());
  for (const TermId term : Necessary(formula)) {
    const auto bound = BoundOf(arena, terms, term);
    if (!bound) continue;
    auto& slot = (bound->upper ? most : least)[bound->variable];
    if (!slot || (bound->upper ? bound->value < *slot : *slot < bound->value)) slot = bound->value;
  }
  for (size_t i = 0; i < least.size(); ++i) {
    if (least[i] && (!most[i] || *least[i] != *most[i])) least[i].reset();
  }
  return least;
}

void Contract(const expr::Arena& arena, const Program& terms, const Formula& formula, interval::Box& box) {
  for (const TermId term : Necessary(formula)) {
    const auto bound = BoundOf(arena, terms, term);
    if (!bound) continue;
    const Interval value = Enclose(bound->value);
    Interval& side = box[bound->variable];
    if (bound->upper) {
      side.hi = std::min(side.hi, value.hi);
    } else {
      side.lo = std::max(side.lo, value.lo);
    }
  }
  for (const Interval& side : box) {
    if (side.IsEmpty()) return;
  }
  if (CheckBox(terms, formula, box) == verdict::Truth::kFalse) {
    box[0] = Interval::Empty();
    return;
  }
  Shaver(terms, formula, box).Run();
}

std::optional<Line> LineIn(expr::Arena& arena, TermId term, TermId variable) {
  const auto at = [&](int64_t value) {
    return expr::Substitute(arena, term, {{variable, arena.Number(arena.Real(), Rational(value))}});
  };
  const TermId rest = at(0);
  const TermId slope = arena.Sub(at(1), rest);
  if (!arena.IsNumber(slope) || arena.number(slope).IsZero()) return std::nullopt;
  const TermId line = arena.Add(arena.Mul(slope, variable), rest);
  if (arena.Sub(term, line) != arena.Number(arena.Real(), Rational(0))) return std::nullopt;
  return Line{arena.number(slope), rest};
}

bool Contract(expr::Arena& arena, TermId formula, const std::vector<TermId>& variables, interval::Box& box) {
  const auto normal = Normalise(arena, formula);
  if (!normal.ok()) return false;
  const auto terms = Compile(arena, variables, normal.value().terms);
  if (!terms.ok()) return false;
  Contract(arena, terms.value(), normal.value(), box);
  return true;
}

}  // namespace rondo::reach
