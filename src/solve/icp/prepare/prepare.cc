#include "solve/icp/prepare/prepare.h"

#include <algorithm>

#include "base/check.h"
#include "expr/substitute.h"
#include "solve/icp/prepare/polynomial.h"

namespace rondo::solve::icp {

using expr::Arena;
using expr::Elementary;
using expr::Op;

void Range::Add(Relation relation, const Rational& bound) {
  if (relation == (kLess | kGreater)) {
    if (std::find(excluded.begin(), excluded.end(), bound) == excluded.end()) excluded.push_back(bound);
    return;
  }
  const bool strict = (relation & kEqual) == 0;
  if ((relation & kGreater) == 0 && (!hi || bound < *hi || (bound == *hi && strict))) {
    hi = bound;
    hi_strict = strict;
  }
  if ((relation & kLess) == 0 && (!lo || bound > *lo || (bound == *lo && strict))) {
    lo = bound;
    lo_strict = strict;
  }
}

bool Range::IsContradiction() const {
  if (!lo || !hi) return false;
  if (*lo > *hi) return true;
  if (*lo < *hi) return false;
  return lo_strict || hi_strict || std::find(excluded.begin(), excluded.end(), *lo) != excluded.end();
}

std::optional<Rational> Range::Only() const { return lo && hi && *lo == *hi ? lo : std::nullopt; }

std::vector<Literal> Range::Literals(TermId term) const {
  std::vector<Literal> result;
  if (Only()) {
    result.push_back({term, kEqual, *lo});
  } else {
    if (lo) result.push_back({term, static_cast<Relation>(kGreater | (lo_strict ? 0 : kEqual)), *lo});
    if (hi) result.push_back({term, static_cast<Relation>(kLess | (hi_strict ? 0 : kEqual)), *hi});
  }
  for (const Rational& e : excluded) result.push_back({term, kLess | kGreater, e});
  return result;
}

namespace {

constexpr size_t kMostDigits = 1'000;

class Preparation {
 public:
  Preparation(Arena& arena, const std::unordered_map<TermId, Variable>& variables, Prepared& out,
              Proof* proof, const base::StopToken& stop)
      : arena_(arena), variables_(variables), out_(out), proof_(proof), stop_(stop) {}

  void Run(std::vector<TermId> conjuncts) {
    while (true) {
      for (TermId& c : conjuncts) c = MergeRoots(c);
      out_.ranges.clear();
      out_.disjunctions.clear();
      todo_ = std::move(conjuncts);
      while (!todo_.empty() && !out_.contradiction) {
        const TermId next = todo_.back();
        todo_.pop_back();
        Take(next);
      }
      if (out_.contradiction) return;
      if (!Eliminate(conjuncts)) return;
    }
  }

 private:
  Rational Zero() const { return Rational(0); }
  TermId Number(const Rational& value) { return arena_.Number(arena_.Real(), value); }
  bool IsRoot(TermId t) const {
    return arena_.op(t) == Op::kElementary && arena_.elementary_of(t) == Elementary::kSqrt;
  }

  // sqrt(c) * sqrt(e)  ->  sqrt(c * e), for numbers c >= 0: both are defined for e >= 0 only.
  TermId MergeRoots(TermId formula) {
    return expr::Transform(arena_, formula, [this](TermId t) {
      if (arena_.op(t) != Op::kMul) return t;
      const TermId a = arena_.arg(t, 0);
      const TermId b = arena_.arg(t, 1);
      if (!IsRoot(a) || !IsRoot(b)) return t;
      const TermId x = arena_.arg(a, 0);
      const TermId y = arena_.arg(b, 0);
      const bool constant = (arena_.IsNumber(x) && arena_.number(x) > Zero()) ||
                            (arena_.IsNumber(y) && arena_.number(y) > Zero());
      return constant ? arena_.Apply(Elementary::kSqrt, {arena_.Mul(x, y)}) : t;
    });
  }

  void Take(TermId formula) {
    switch (arena_.op(formula)) {
      case Op::kBool:
        if (formula == arena_.False()) out_.contradiction = true;
        return;
      case Op::kAnd:
        for (const TermId a : arena_.args(formula)) todo_.push_back(a);
        return;
      case Op::kOr:
        out_.disjunctions.push_back(formula);
        return;
      default:
        break;
    }
    const auto literal = AsLiteral(arena_, formula);
    CHECK(literal.has_value()) << "not in negation normal form";
    Take(*literal);
  }

  void Take(const Literal& literal) {
    if (arena_.IsNumber(literal.term)) {
      if (!Holds(arena_.number(literal.term), literal.relation, literal.bound)) out_.contradiction = true;
      return;
    }
    const TermId condensed = Condensed(literal.term);
    if (condensed != literal.term) return TakeComparison(condensed, literal.relation, literal.bound);
    if (IsRoot(literal.term) && TakeRoot(literal)) return;
    if (TakeSquares(literal)) return;
    const auto it = variables_.find(literal.term);
    if (it != variables_.end() && it->second.integral()) return TakeIntegral(literal);
    Range& range = out_.ranges[literal.term];
    range.Add(literal.relation, literal.bound);
    if (range.IsContradiction()) out_.contradiction = true;
  }

  // Bounds of integers are integers, and never strict.
  void TakeIntegral(const Literal& literal) {
    Range& range = out_.ranges[literal.term];
    const Rational& b = literal.bound;
    const Rational up = Rational(0) - (Rational(0) - b).Floor();
    if (b.IsInteger() && literal.relation == kLess) {
      range.Add(kLess | kEqual, b - Rational(1));
    } else if (b.IsInteger() && literal.relation == kGreater) {
      range.Add(kGreater | kEqual, b + Rational(1));
    } else if ((literal.relation & kGreater) == 0) {
      range.Add(kLess | kEqual, b.Floor());
      if ((literal.relation & kLess) == 0) range.Add(kGreater | kEqual, up);
    } else if ((literal.relation & kLess) == 0) {
      range.Add(kGreater | kEqual, up);
    } else {
      range.Add(literal.relation, b);
    }
    // An excluded end moves the end.
    for (bool moved = true; moved;) {
      moved = false;
      for (const Rational& e : range.excluded) {
        if (range.lo && *range.lo == e) range.lo = e + Rational(1), moved = true;
        if (range.hi && *range.hi == e) range.hi = e - Rational(1), moved = true;
      }
    }
    if (range.IsContradiction()) out_.contradiction = true;
  }

  // sqrt(e) <= c: a bound of e, wherever the root is defined.
  bool TakeRoot(const Literal& literal) {
    const TermId e = arena_.arg(literal.term, 0);
    const bool negative = literal.bound < Zero();
    // Squares of squares of squares would exhaust memory.
    if (literal.relation == (kLess | kGreater) || literal.bound.Digits() > kMostDigits) return false;
    if (negative || (literal.bound.IsZero() && literal.relation == kLess)) {
      if ((literal.relation & kGreater) == 0) {
        out_.contradiction = true;
      } else {
        todo_.push_back(arena_.Le(Number(Zero()), e));
      }
      return true;
    }
    TakeComparison(e, literal.relation, literal.bound * literal.bound);
    // What lies above a number that is not negative is not negative itself.
    if ((literal.relation & kLess) != 0) todo_.push_back(arena_.Le(Number(Zero()), e));
    return true;
  }

  TermId Condensed(TermId term) {
    if (const auto it = condensed_.find(term); it != condensed_.end()) return it->second;
    if (stop_.StopRequested()) return term;
    const TermId result = Condense(arena_, term);
    condensed_.emplace(term, result);
    // However its comparison is scaled.
    if (const auto literal = AsLiteral(arena_, arena_.Le(result, Number(Zero()))))
      condensed_.emplace(literal->term, literal->term);
    return result;
  }

  void TakeComparison(TermId term, Relation relation, const Rational& bound) {
    todo_.push_back(ToFormula(arena_, {term, relation, bound}));
  }

  // a^2 + b^2 <= 0: both vanish.
  bool TakeSquares(const Literal& literal) {
    if (literal.bound > Zero() || (literal.relation & kGreater) != 0) return false;
    std::vector<TermId> roots;
    const auto square_of = [&](TermId t) {
      if (arena_.op(t) == Op::kMul && arena_.IsNumber(arena_.arg(t, 0))) {
        if (arena_.number(arena_.arg(t, 0)) < Zero()) return false;
        t = arena_.arg(t, 1);
      }
      if (arena_.op(t) != Op::kMul || arena_.arg(t, 0) != arena_.arg(t, 1)) return false;
      roots.push_back(arena_.arg(t, 0));
      return true;
    };
    if (arena_.op(literal.term) == Op::kAdd) {
      for (const TermId t : arena_.args(literal.term)) {
        if (!square_of(t)) return false;
      }
    } else if (!square_of(literal.term)) {
      return false;
    }
    if (proof_ != nullptr) proof_->Squares(ToFormula(arena_, literal));
    if (literal.bound < Zero() || (literal.relation & kEqual) == 0) {
      out_.contradiction = true;
      return true;
    }
    for (const TermId root : roots) todo_.push_back(arena_.Eq(root, Number(Zero())));
    return true;
  }

  bool Occurs(TermId variable, TermId term) {
    std::unordered_set<TermId> seen;
    bool found = false;
    expr::VisitPostorder(arena_, term, seen, [&](TermId t) { found = found || t == variable; });
    return found;
  }

  // How many ends of the range of a variable, perhaps with a factor, are known.
  int BoundsOf(TermId part) const {
    const bool scaled = arena_.op(part) == Op::kMul && arena_.IsNumber(arena_.arg(part, 0));
    const auto it = out_.ranges.find(scaled ? arena_.arg(part, 1) : part);
    return it == out_.ranges.end() ? 0 : (it->second.lo ? 1 : 0) + (it->second.hi ? 1 : 0);
  }

  // A variable and what it equals, if `term = value` can be solved for one.
  std::optional<std::pair<TermId, TermId>> Solve(TermId term, const Rational& value) {
    const bool sum = arena_.op(term) == Op::kAdd;
    std::vector<TermId> parts;
    if (sum) {
      for (const TermId t : arena_.args(term)) parts.push_back(t);
    } else {
      parts.push_back(term);
    }
    // Bounds of variables are worth keeping: those go first that have none.
    std::stable_sort(parts.begin(), parts.end(),
                     [this](TermId a, TermId b) { return BoundsOf(a) < BoundsOf(b); });
    for (const TermId part : parts) {
      Rational coefficient(1);
      TermId variable = part;
      if (arena_.op(part) == Op::kMul && arena_.IsNumber(arena_.arg(part, 0))) {
        coefficient = arena_.number(arena_.arg(part, 0));
        variable = arena_.arg(part, 1);
      }
      const auto it = variables_.find(variable);
      if (it == variables_.end()) continue;
      if (it->second.integral() && (sum || !(value / coefficient).IsInteger())) continue;
      const TermId rest = arena_.Sub(term, part);
      if (Occurs(variable, rest)) continue;
      const TermId solved = arena_.Mul(Number(Rational(1) / coefficient), arena_.Sub(Number(value), rest));
      return std::pair(variable, solved);
    }
    return std::nullopt;
  }

  // An equation that goes takes with it that its terms are defined; what that asks of the arguments stays.
  void KeepDefined(TermId term, std::vector<TermId>& conjuncts) {
    std::vector<std::pair<Elementary, TermId>> partial;
    bool total = true;
    std::unordered_set<TermId> seen;
    expr::VisitPostorder(arena_, term, seen, [&](TermId t) {
      // Of a choice, only the branch that is taken need be defined.
      total = total && arena_.op(t) != Op::kIte;
      if (arena_.op(t) == Op::kElementary) partial.emplace_back(arena_.elementary_of(t), arena_.arg(t, 0));
    });
    if (!total) return;
    for (const auto& [function, argument] : partial) {
      if (function == Elementary::kSqrt) conjuncts.push_back(arena_.Le(Number(Zero()), argument));
      if (function == Elementary::kLog) conjuncts.push_back(arena_.Lt(Number(Zero()), argument));
      if (function != Elementary::kAsin && function != Elementary::kAcos) continue;
      conjuncts.push_back(arena_.Le(Number(Rational(-1)), argument));
      conjuncts.push_back(arena_.Le(argument, Number(Rational(1))));
    }
  }

  // Uses equations, if there are any to use: all that give numbers at once, or one other. Then `conjuncts` is
  // what remains.
  bool Eliminate(std::vector<TermId>& conjuncts) {
    expr::Substitution map;
    std::optional<std::pair<TermId, TermId>> other;
    std::unordered_set<TermId> used;  // says of itself only that it is defined, afterwards
    TermId other_equation;
    for (const auto& [term, range] : out_.ranges) {
      const auto value = range.Only();
      if (!value) continue;
      const auto solved = Solve(term, *value);
      if (!solved) continue;
      const TermId equation = ToFormula(arena_, {term, kEqual, *value});
      if (arena_.IsNumber(solved->second)) {
        if (map.insert(*solved).second) used.insert(equation);
      } else if (!other) {
        other = solved;
        other_equation = equation;
      }
    }
    if (map.empty() && other) {
      map.insert(*other);
      used.insert(other_equation);
    }
    if (map.empty()) return false;
    conjuncts = Conjuncts(arena_, out_);
    std::erase_if(conjuncts, [&](TermId c) { return used.contains(c); });
    for (const auto& [variable, definition] : map) {
      KeepDefined(definition, conjuncts);
      if (proof_ != nullptr) proof_->Substitute(variable, definition);
    }
    for (TermId& c : conjuncts) c = expr::Substitute(arena_, c, map);
    for (auto& [variable, definition] : out_.definitions)
      definition = expr::Substitute(arena_, definition, map);
    out_.definitions.insert(out_.definitions.end(), map.begin(), map.end());
    return true;
  }

  Arena& arena_;
  const std::unordered_map<TermId, Variable>& variables_;
  Prepared& out_;
  Proof* proof_;
  const base::StopToken& stop_;
  std::vector<TermId> todo_;
  std::unordered_map<TermId, TermId> condensed_;  // by Condense; its results are taken as they are
};

}  // namespace

Prepared Prepare(Arena& arena, const std::unordered_map<TermId, Variable>& variables,
                 std::vector<TermId> conjuncts, std::vector<std::pair<TermId, TermId>> definitions,
                 Proof* proof, const base::StopToken& stop) {
  Prepared result;
  result.definitions = std::move(definitions);
  Preparation(arena, variables, result, proof, stop).Run(std::move(conjuncts));
  return result;
}

bool AddRotations(Arena& arena, Prepared& prepared, bool links, const base::StopToken& stop) {
  Rotations rotations(arena, stop);
  std::map<TermId, Range> ranges;
  for (const auto& [term, range] : prepared.ranges) {
    const TermId rewritten = rotations.Rewrite(term);
    for (const Literal& literal : range.Literals(rewritten)) {
      const auto scaled = AsLiteral(arena, ToFormula(arena, literal));
      CHECK(scaled.has_value()) << "a comparison";
      ranges[scaled->term].Add(scaled->relation, scaled->bound);
    }
  }
  prepared.ranges = std::move(ranges);
  for (TermId& d : prepared.disjunctions) d = rotations.Rewrite(d);
  const std::vector<Lemma> ties = links ? rotations.Links() : std::vector<Lemma>();
  prepared.lemmas = rotations.Lemmas();
  prepared.lemmas.insert(prepared.lemmas.end(), ties.begin(), ties.end());
  return !ties.empty();
}

std::vector<TermId> Conjuncts(Arena& arena, const Prepared& prepared) {
  std::vector<TermId> result;
  for (const auto& [term, range] : prepared.ranges) {
    for (const Literal& literal : range.Literals(term)) result.push_back(ToFormula(arena, literal));
  }
  result.insert(result.end(), prepared.disjunctions.begin(), prepared.disjunctions.end());
  return result;
}

}  // namespace rondo::solve::icp
