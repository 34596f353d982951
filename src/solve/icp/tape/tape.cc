#include "solve/icp/tape/tape.h"

#include <array>
#include <cmath>
#include <map>

#include "base/check.h"
#include "expr/substitute.h"

namespace rondo::solve::icp {

using expr::Arena;
using expr::Elementary;
using expr::Op;
using interval::Interval;

Interval Enclose(const Rational& value) {
  const double d = value.ToDouble();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  constexpr double kMax = std::numeric_limits<double>::max();
  if (!std::isfinite(d) || std::fabs(d) >= kMax)
    return value > Rational(0) ? Interval{kMax, kInf} : Interval{-kInf, -kMax};
  const Rational exact = Rational::FromDouble(d);
  if (exact == value) return {d, d};
  if (exact < value) return {d, std::nextafter(d, kInf)};
  return {std::nextafter(d, -kInf), d};
}

namespace {

class Builder {
 public:
  Builder(Arena& arena, const std::unordered_map<TermId, Variable>& variables, Tape& tape)
      : arena_(arena), variables_(variables), tape_(tape) {}

  void Run(const Prepared& prepared) {
    std::vector<uint32_t> parts;
    for (const auto& [term, range] : prepared.ranges) {
      for (const Literal& literal : range.Literals(term)) parts.push_back(Atom(literal));
    }
    for (const TermId d : prepared.disjunctions) parts.push_back(Formula(d));
    const size_t own = tape_.thresholds.size();
    for (const Lemma& l : prepared.lemmas) parts.push_back(Identity(l));
    for (size_t t = own; t < tape_.thresholds.size(); ++t) tape_.thresholds[t].lemma = true;
    tape_.root = Junction(NodeOp::kAnd, parts);
    MarkSingle(tape_);
    for (TapeVariable& v : tape_.variables) {
      const auto it = prepared.ranges.find(v.term);
      if (it == prepared.ranges.end()) continue;
      if (it->second.lo) v.root.lo = Enclose(*it->second.lo).lo;
      if (it->second.hi) v.root.hi = Enclose(*it->second.hi).hi;
    }
  }

 private:
  uint32_t Push(NodeOp op, uint32_t a = 0, uint32_t b = 0, uint32_t n = 0) {
    const std::array<uint32_t, 4> key{static_cast<uint32_t>(op), a, b, n};
    const bool shared = op != NodeOp::kVariable && op != NodeOp::kConstant && op != NodeOp::kThreshold &&
                        op != NodeOp::kAnd && op != NodeOp::kOr;
    if (shared) {
      if (const auto it = interned_.find(key); it != interned_.end()) return it->second;
    }
    const auto id = static_cast<uint32_t>(tape_.nodes.size());
    tape_.nodes.push_back({op, a, b, n});
    tape_.constants.emplace_back();
    if (shared) interned_.emplace(key, id);
    return id;
  }

  uint32_t Constant(const Rational& value) {
    const std::string key = value.ToString();
    if (const auto it = numbers_.find(key); it != numbers_.end()) return it->second;
    const uint32_t id = Push(NodeOp::kConstant);
    tape_.constants[id] = Enclose(value);
    numbers_.emplace(key, id);
    return id;
  }

  uint32_t Number(TermId t) {
    if (const auto it = terms_.find(t); it != terms_.end()) return it->second;
    const uint32_t id = NewNumber(t);
    terms_.emplace(t, id);
    return id;
  }

  // A copy: building more terms moves the arena's.
  std::vector<TermId> Args(TermId t) const {
    const auto args = arena_.args(t);
    return {args.begin(), args.end()};
  }

  uint32_t NewNumber(TermId t) {
    const std::vector<TermId> args = Args(t);
    switch (arena_.op(t)) {
      case Op::kNumber:
        return Constant(arena_.number(t));
      case Op::kVariable: {
        const uint32_t id = Push(NodeOp::kVariable, static_cast<uint32_t>(tape_.variables.size()));
        tape_.variables.push_back({t, id, variables_.at(t).integral(), false, {}});
        return id;
      }
      case Op::kAdd:
        return Sum(args);
      case Op::kMul:
        return Product(t);
      case Op::kDivide: {
        const uint32_t a = Number(args[0]);
        return Push(NodeOp::kDiv, a, Number(args[1]));
      }
      case Op::kIte: {
        const uint32_t a = Number(args[1]);
        return Choose(args[0], a, Number(args[2]));
      }
      case Op::kElementary:
        return Function(arena_.elementary_of(t), args);
      default:
        CHECK(false) << "no number: " << Name(arena_.op(t));
    }
    return 0;
  }

  uint32_t Choose(TermId condition, uint32_t a, uint32_t b) {
    const uint32_t yes = Formula(condition);
    const uint32_t no = Formula(Negate(arena_, condition));
    tape_.conditions.emplace_back(yes, no);
    return Push(NodeOp::kChoose, a, b, static_cast<uint32_t>(tape_.conditions.size() - 1));
  }

  // x^y by cases (docs/adr/0017-powers.md). Of a base that is not positive, only 0^y for y > 0 is told: the
  // rest may be any number.
  uint32_t Power(TermId x, TermId y) {
    const TermId zero = arena_.Number(arena_.Real(), Rational(0));
    tape_.partial = true;
    const uint32_t logarithm = Push(NodeOp::kLog, Number(x));
    const uint32_t positive = Push(NodeOp::kExp, Push(NodeOp::kMul, Number(y), logarithm));
    const uint32_t anything = Push(NodeOp::kConstant);
    const TermId vanishes = arena_.And(arena_.Eq(x, zero), arena_.Lt(zero, y));
    const uint32_t rest = Choose(vanishes, Constant(Rational(0)), anything);
    return Choose(arena_.Eq(y, zero), Constant(Rational(1)), Choose(arena_.Lt(zero, x), positive, rest));
  }

  uint32_t Sum(const std::vector<TermId>& parts) {
    // The constant last, so that differences of terms come first.
    std::optional<uint32_t> sum;
    for (const TermId part : parts) {
      if (arena_.IsNumber(part)) continue;
      const bool scaled = arena_.op(part) == Op::kMul && arena_.IsNumber(arena_.arg(part, 0));
      const bool negative = scaled && arena_.number(arena_.arg(part, 0)) == Rational(-1);
      const uint32_t id = Number(negative ? arena_.arg(part, 1) : part);
      if (!sum) {
        sum = negative ? Push(NodeOp::kNeg, id) : id;
      } else {
        sum = Push(negative ? NodeOp::kSub : NodeOp::kAdd, *sum, id);
      }
    }
    for (const TermId part : parts) {
      if (arena_.IsNumber(part)) sum = Push(NodeOp::kAdd, *sum, Number(part));
    }
    return *sum;
  }

  // A product as a number and powers of what else it multiplies.
  void Factors(TermId t, Rational& coefficient, std::map<TermId, uint32_t>& powers) {
    if (arena_.op(t) == Op::kMul) {
      Factors(arena_.arg(t, 0), coefficient, powers);
      Factors(arena_.arg(t, 1), coefficient, powers);
    } else if (arena_.IsNumber(t)) {
      coefficient = coefficient * arena_.number(t);
    } else {
      ++powers[t];
    }
  }

  uint32_t Product(TermId t) {
    Rational coefficient(1);
    std::map<TermId, uint32_t> powers;
    Factors(t, coefficient, powers);
    std::optional<uint32_t> product;
    for (const auto& [factor, power] : powers) {
      uint32_t id = Number(factor);
      if (power == 2) id = Push(NodeOp::kSqr, id);
      if (power > 2) id = Push(NodeOp::kPow, id, 0, power);
      product = product ? Push(NodeOp::kMul, *product, id) : id;
    }
    if (!product) return Constant(coefficient);
    return coefficient == Rational(1) ? *product : Push(NodeOp::kMul, Constant(coefficient), *product);
  }

  uint32_t Function(Elementary function, const std::vector<TermId>& args) {
    if (function == Elementary::kPower) return Power(args[0], args[1]);
    const uint32_t a = Number(args[0]);
    const uint32_t b = args.size() > 1 ? Number(args[1]) : 0;
    const auto partial = [&](NodeOp op) {
      tape_.partial = true;
      return Push(op, a);
    };
    switch (function) {
      case Elementary::kSqrt:
        return partial(NodeOp::kSqrt);
      case Elementary::kAsin:
        return partial(NodeOp::kAsin);
      case Elementary::kAcos:
        return partial(NodeOp::kAcos);
      case Elementary::kLog:
        return partial(NodeOp::kLog);
      case Elementary::kTan:
        return partial(NodeOp::kTan);
      case Elementary::kAtan2:
        return Push(NodeOp::kAtan2, a, b);
      case Elementary::kAbs:
        return Push(NodeOp::kAbs, a);
      case Elementary::kMin:
        return Push(NodeOp::kMin, a, b);
      case Elementary::kMax:
        return Push(NodeOp::kMax, a, b);
      case Elementary::kSin:
        return Push(NodeOp::kSin, a);
      case Elementary::kCos:
        return Push(NodeOp::kCos, a);
      case Elementary::kAtan:
        return Push(NodeOp::kAtan, a);
      case Elementary::kExp:
        return Push(NodeOp::kExp, a);
      case Elementary::kPower:
      case Elementary::kCount_:
        break;
    }
    CHECK(false);
    return 0;
  }

  uint32_t Atom(const Literal& literal) {
    return Compare(Number(literal.term), literal.relation, literal.bound);
  }

  uint32_t Compare(uint32_t node, Relation relation, const Rational& bound) {
    const auto key = std::pair(node, bound.ToString());
    auto it = threshold_of_.find(key);
    if (it == threshold_of_.end()) {
      const auto index = static_cast<uint32_t>(tape_.thresholds.size());
      const uint32_t id = Push(NodeOp::kThreshold, node, 0, index);
      const Interval enclosure = Enclose(bound);
      tape_.thresholds.push_back({id, bound, enclosure.lo, enclosure.hi, false});
      it = threshold_of_.emplace(key, id).first;
    }
    return Push(NodeOp::kAtom, it->second, 0, relation);
  }

  uint32_t Formula(TermId t) {
    if (const auto it = formulas_.find(t); it != formulas_.end()) return it->second;
    const Op op = arena_.op(t);
    uint32_t id = 0;
    if (op == Op::kAnd || op == Op::kOr) {
      std::vector<uint32_t> parts;
      for (const TermId a : Args(t)) parts.push_back(Formula(a));
      id = Junction(op == Op::kAnd ? NodeOp::kAnd : NodeOp::kOr, parts);
    } else if (op == Op::kBool) {
      id = Junction(t == arena_.True() ? NodeOp::kAnd : NodeOp::kOr, {});
    } else {
      const auto literal = AsLiteral(arena_, t);
      CHECK(literal.has_value()) << "not in negation normal form";
      if (arena_.IsNumber(literal->term)) {
        const bool holds = Holds(arena_.number(literal->term), literal->relation, literal->bound);
        id = Junction(holds ? NodeOp::kAnd : NodeOp::kOr, {});
      } else {
        id = Atom(*literal);
      }
    }
    formulas_.emplace(t, id);
    return id;
  }

  uint32_t Identity(const Lemma& lemma) {
    std::optional<uint32_t> sum;
    for (const auto& [coefficient, term] : lemma.parts) {
      uint32_t id = Number(term);
      const bool negative = sum && coefficient == Rational(-1);
      if (!negative && coefficient != Rational(1)) id = Push(NodeOp::kMul, Constant(coefficient), id);
      sum = sum ? Push(negative ? NodeOp::kSub : NodeOp::kAdd, *sum, id) : id;
    }
    return Compare(*sum, kEqual, Rational(0) - lemma.constant);
  }

  uint32_t Junction(NodeOp op, const std::vector<uint32_t>& parts) {
    const auto first = static_cast<uint32_t>(tape_.children.size());
    tape_.children.insert(tape_.children.end(), parts.begin(), parts.end());
    return Push(op, first, 0, static_cast<uint32_t>(parts.size()));
  }

  Arena& arena_;
  const std::unordered_map<TermId, Variable>& variables_;
  Tape& tape_;
  std::map<std::array<uint32_t, 4>, uint32_t> interned_;
  std::unordered_map<std::string, uint32_t> numbers_;
  std::unordered_map<TermId, uint32_t> terms_, formulas_;
  std::map<std::pair<uint32_t, std::string>, uint32_t> threshold_of_;
};

}  // namespace

Tape BuildTape(Arena& arena, const std::unordered_map<TermId, Variable>& variables,
               const Prepared& prepared) {
  Tape tape;
  Builder(arena, variables, tape).Run(prepared);
  return tape;
}

}  // namespace rondo::solve::icp
