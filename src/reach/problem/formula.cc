#include "reach/problem/formula.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "expr/defined.h"
#include "verdict/truth.h"

namespace rondo::reach {

using expr::Elementary;
using expr::Op;

namespace {

class Normaliser {
 public:
  Normaliser(expr::Arena& arena, Formula& out) : arena_(arena), out_(out) {}

  size_t Visit(TermId f, bool positive) {
    const auto args = std::vector<TermId>(arena_.args(f).begin(), arena_.args(f).end());
    switch (arena_.op(f)) {
      case Op::kBool:
        return Junction((f == arena_.True()) == positive, {});
      case Op::kNot:
        return Visit(args[0], !positive);
      case Op::kAnd:
      case Op::kOr: {
        std::vector<size_t> parts;
        for (const TermId a : args) parts.push_back(Visit(a, positive));
        return Junction((arena_.op(f) == Op::kAnd) == positive, std::move(parts));
      }
      case Op::kIte: {
        const size_t then = Junction(false, {Visit(args[0], false), Visit(args[1], positive)});
        const size_t otherwise = Junction(false, {Visit(args[0], true), Visit(args[2], positive)});
        return Junction(true, {then, otherwise});
      }
      case Op::kLe:
      case Op::kLt: {
        const bool strict = (arena_.op(f) == Op::kLt) == positive;
        return Defined(args,
                       Atom(positive ? arena_.Sub(args[0], args[1]) : arena_.Sub(args[1], args[0]), strict));
      }
      case Op::kEq:
        if (arena_.sort_of(args[0]) == arena_.Bool()) {
          const size_t both = Junction(true, {Visit(args[0], true), Visit(args[1], positive)});
          const size_t neither = Junction(true, {Visit(args[0], false), Visit(args[1], !positive)});
          return Junction(false, {both, neither});
        }
        if (arena_.sort_of(args[0]) != arena_.Real()) break;
        return Defined(args, Junction(positive, {Atom(arena_.Sub(args[0], args[1]), !positive),
                                                 Atom(arena_.Sub(args[1], args[0]), !positive)}));
      default:
        break;
    }
    if (problem.empty()) problem = fmt::format("`{}` is no comparison of numbers", expr::Name(arena_.op(f)));
    return Junction(true, {});
  }

  std::string problem;

 private:
  // An atomic formula, negated or not, holds only where its terms have values
  // (docs/adr/0005-undefined-terms.md).
  size_t Defined(const std::vector<TermId>& args, size_t atom) {
    const TermId undefined = arena_.Or(expr::Undefined(arena_, args[0]), expr::Undefined(arena_, args[1]));
    if (undefined == arena_.False()) return atom;
    return Junction(true, {Visit(expr::Complement(arena_, undefined), true), atom});
  }
  size_t Junction(bool conjunction, std::vector<size_t> parts) {
    if (parts.size() == 1) return parts[0];
    out_.nodes.push_back(
        {conjunction ? Formula::Kind::kAnd : Formula::Kind::kOr, 0, false, std::move(parts)});
    return out_.nodes.size() - 1;
  }
  // gap <= 0 or gap < 0. Of |a|, max and min with a sign that allows it: for both of their values.
  size_t Atom(TermId gap, bool strict) {
    const auto parts = arena_.op(gap) == Op::kAdd
                           ? std::vector<TermId>(arena_.args(gap).begin(), arena_.args(gap).end())
                           : std::vector<TermId>{gap};
    for (size_t i = 0; i < parts.size(); ++i) {
      TermId inner = parts[i];
      Rational factor(1);
      if (arena_.op(inner) == Op::kMul && arena_.args(inner).size() == 2 &&
          arena_.IsNumber(arena_.arg(inner, 0))) {
        factor = arena_.number(arena_.arg(inner, 0));
        inner = arena_.arg(inner, 1);
      }
      const auto with = [&](TermId value) {
        std::vector<TermId> sum = parts;
        sum[i] = arena_.Mul(arena_.Number(arena_.Real(), factor), value);
        return Atom(arena_.Add(sum), strict);
      };
      if (arena_.op(inner) == Op::kIte) {
        const TermId condition = arena_.arg(inner, 0);
        const TermId then = arena_.arg(inner, 1);
        const TermId otherwise = arena_.arg(inner, 2);
        const bool compares = arena_.op(condition) == Op::kLe || arena_.op(condition) == Op::kLt;
        const TermId low = compares ? arena_.arg(condition, 0) : condition;
        const TermId high = compares ? arena_.arg(condition, 1) : condition;
        if (compares && ((then == high && otherwise == low) || (then == low && otherwise == high))) {
          // if a <= b then b else a: the larger of the two
          const bool both = (factor > Rational(0)) == (then == high);
          return Junction(both, {with(then), with(otherwise)});
        }
        const size_t first = Junction(false, {Visit(condition, false), with(then)});
        return Junction(true, {first, Junction(false, {Visit(condition, true), with(otherwise)})});
      }
      if (arena_.op(inner) != Op::kElementary) continue;
      const Elementary e = arena_.elementary_of(inner);
      if (e != Elementary::kAbs && e != Elementary::kMin && e != Elementary::kMax) continue;
      const TermId first = arena_.arg(inner, 0);
      const TermId second = e == Elementary::kAbs ? arena_.Neg(first) : arena_.arg(inner, 1);
      // A maximum is at most something if both values are, at least something if one is.
      const bool both = (factor > Rational(0)) == (e != Elementary::kMin);
      return Junction(both, {with(first), with(second)});
    }
    const auto [it, fresh] = known_.emplace(gap, out_.terms.size());
    if (fresh) out_.terms.push_back(gap);
    out_.nodes.push_back({Formula::Kind::kAtom, it->second, strict, {}});
    return out_.nodes.size() - 1;
  }

  expr::Arena& arena_;
  Formula& out_;
  std::unordered_map<TermId, size_t> known_;
};

verdict::Truth CheckNode(const Formula& f, size_t n, const std::function<Interval(size_t)>& range) {
  const Formula::Node& node = f.nodes[n];
  if (node.kind == Formula::Kind::kAtom) {
    const Interval r = range(node.atom);
    if (node.strict ? r.hi < 0 : r.hi <= 0) return verdict::Truth::kTrue;
    if (node.strict ? r.lo >= 0 : r.lo > 0) return verdict::Truth::kFalse;
    return verdict::Truth::kOpen;
  }
  const bool conjunction = node.kind == Formula::Kind::kAnd;
  const verdict::Truth end = conjunction ? verdict::Truth::kFalse : verdict::Truth::kTrue;
  verdict::Truth result = conjunction ? verdict::Truth::kTrue : verdict::Truth::kFalse;
  for (const size_t p : node.parts) {
    const verdict::Truth t = CheckNode(f, p, range);
    if (t == end) return end;
    if (t == verdict::Truth::kOpen) result = verdict::Truth::kOpen;
  }
  return result;
}

double MissOf(const Formula& f, size_t n, const std::function<double(size_t)>& value) {
  const Formula::Node& node = f.nodes[n];
  if (node.kind == Formula::Kind::kAtom) {
    const double v = value(node.atom);
    return node.strict && v == 0 ? 1 : v;
  }
  const bool conjunction = node.kind == Formula::Kind::kAnd;
  double result = conjunction ? -1e300 : 1e300;
  for (const size_t p : node.parts) {
    const double m = MissOf(f, p, value);
    result = conjunction ? std::max(result, m) : std::min(result, m);
  }
  return result;
}

}  // namespace

verdict::Truth Formula::Check(const std::function<Interval(size_t)>& range) const {
  return CheckNode(*this, root, range);
}
bool Formula::ComesDownTo(size_t term, const std::function<Interval(size_t)>& range) const {
  const auto with = [&](double value) {
    return Check([&](size_t atom) { return atom == term ? Interval::Point(value) : range(atom); });
  };
  return with(-1) == verdict::Truth::kTrue && with(1) == verdict::Truth::kFalse;
}
std::optional<size_t> Formula::Deciding(const std::function<Interval(size_t)>& range) const {
  for (size_t term = 0; term < terms.size(); ++term) {
    if (range(term).lo <= 0 && ComesDownTo(term, range)) return term;
  }
  return std::nullopt;
}
double Formula::Miss(const std::function<double(size_t)>& value) const { return MissOf(*this, root, value); }

base::Result<Formula> Normalise(expr::Arena& arena, TermId formula) {
  Formula out;
  Normaliser normaliser(arena, out);
  out.root = normaliser.Visit(formula, true);
  if (!normaliser.problem.empty()) return base::Error{normaliser.problem};
  return out;
}

}  // namespace rondo::reach
