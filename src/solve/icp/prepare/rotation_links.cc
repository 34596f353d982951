#include <algorithm>
#include <iterator>
#include <optional>
#include <unordered_set>
#include <utility>

#include "expr/substitute.h"
#include "solve/icp/prepare/rotation.h"

// Sums over the coordinates of frames.

namespace rondo::solve::icp {

using expr::Elementary;
using expr::Monomial;
using expr::Op;
using expr::Polynomial;
using expr::Rational;
using expr::TermId;

namespace {

constexpr size_t kMostTurns = 8;  // of one sum

size_t SumFactors(const expr::Arena& arena, TermId t) {
  if (arena.op(t) == Op::kMul) return SumFactors(arena, arena.arg(t, 0)) + SumFactors(arena, arena.arg(t, 1));
  return arena.op(t) == Op::kAdd ? 1 : 0;
}

}  // namespace

// What only waves make up is an angle that is a sum: nothing that frames would turn.
bool Rotations::IsPlace(const Monomial& m) const {
  return std::ranges::any_of(m, [this](TermId t) { return !IsWave(t); });
}

// The term multiplied out, over coordinates as far as possible: these are atoms.
std::optional<Polynomial> Rotations::Over(TermId term) {
  if (stop_.StopRequested()) return std::nullopt;
  if (const auto known = over_.find(term); known != over_.end()) return known->second;
  auto polynomial = NewOver(term);
  return over_[term] = std::move(polynomial);
}

std::optional<Polynomial> Rotations::NewOver(TermId term) {
  if (arena_.op(term) == Op::kMul) {
    const auto a = Over(arena_.arg(term, 0));
    const auto b = a ? Over(arena_.arg(term, 1)) : std::nullopt;
    return b ? expr::Product(*a, *b, kMostMonomials) : std::nullopt;
  }
  if (arena_.op(term) != Op::kAdd) return expr::Expand(arena_, term, kMostMonomials);
  Polynomial sum;
  const auto args = arena_.args(term);
  for (const TermId a : std::vector<TermId>(args.begin(), args.end())) {
    // Parts of one vector may be spread over the sum: what is turned in one factor alone would not meet the rest.
    auto part = SumFactors(arena_, a) < 2 ? Expanded(a) : std::nullopt;
    if (!part) part = Over(a);
    if (!part) return std::nullopt;
    for (const auto& [m, c] : *part) AddTo(sum, m, c);
    if (sum.size() > kMostMonomials) return std::nullopt;
  }
  Turn(sum);
  Shorten(sum);
  return sum;
}

std::optional<Polynomial> Rotations::Expanded(TermId term) {
  const auto [it, fresh] = expanded_.try_emplace(term);
  if (fresh) it->second = expr::Expand(arena_, term, kMostMonomials);
  return it->second;
}

void Rotations::Turn(Polynomial& sum) {
  for (size_t turns = 0; turns < kMostTurns; ++turns) {
    auto split = Outermost(sum);
    if (!split && TurnTwice(sum)) continue;
    if (!split) return;
    // The vector itself, over the frames further in.
    auto [a, b] = PartsOf(split->vector);
    Turn(a);
    Turn(b);
    split->vector.clear();
    for (const auto& [m, c] : a) split->vector[m].first = c;
    for (const auto& [m, c] : b) split->vector[m].second = c;
    sum = Turned(std::move(*split));
  }
}

// A (cos^2 u - sin^2 u) + 2 B sin u cos u + rest, a vector that is turned by u twice, becomes p cos u + q sin u + rest, with the
// coordinates p and q that it has once it is turned. Returns false if there is none.
bool Rotations::TurnTwice(Polynomial& sum) {
  for (const TermId angle : AnglesOf(sum)) {
    const TermId cosine = arena_.Apply(Elementary::kCos, {angle});
    const TermId sine = arena_.Apply(Elementary::kSin, {angle});
    Split split;
    split.angle = angle;
    Polynomial cosines, sines;  // the coefficients of cos^2 and sin^2
    bool fits = true, place = false;
    for (const auto& [m, c] : sum) {
      const auto cos = std::ranges::count(m, cosine), sin = std::ranges::count(m, sine);
      fits = fits && (cos + sin == 0 || cos + sin == 2);
      if (cos + sin != 2) {
        split.rest.emplace(m, c);
        continue;
      }
      Monomial other;
      std::ranges::copy_if(m, std::back_inserter(other), [&](TermId t) { return t != cosine && t != sine; });
      place = place || IsPlace(other);
      if (cos == 1) split.vector[other].second = c / Rational(2);
      if (cos == 2) split.vector[other].first = c;
      if (cos == 2) cosines.emplace(other, c);
      if (sin == 2) sines.emplace(other, Rational(0) - c);
    }
    if (!fits || !place || cosines.empty() || cosines != sines || split.vector.size() < 2) continue;
    Complex ratio;
    const Frame& frame = FrameOf(angle, split.vector, ratio);
    const auto [p_lead, p] = Monic(arena_, frame.p);
    const auto [q_lead, q] = Monic(arena_, frame.q);
    // ratio * (p + i q): the vector, turned once.
    sum = std::move(split.rest);
    AddTo(sum, expr::Product({p}, {cosine}), ratio.first * p_lead);
    AddTo(sum, expr::Product({q}, {cosine}), Rational(0) - ratio.second * q_lead);
    AddTo(sum, expr::Product({p}, {sine}), ratio.second * p_lead);
    AddTo(sum, expr::Product({q}, {sine}), ratio.first * q_lead);
    return true;
  }
  return false;
}

std::pair<Polynomial, Polynomial> Rotations::PartsOf(const Vector& vector) {
  Polynomial a, b;
  for (const auto& [m, z] : vector) {
    if (!z.first.IsZero()) AddTo(a, m, z.first);
    if (!z.second.IsZero()) AddTo(b, m, z.second);
  }
  return {a, b};
}

// Of the angles by which vectors are turned in the sum, the one that leaves the least apart: in a chain of
// frames, the last one.
std::optional<Rotations::Split> Rotations::Outermost(const Polynomial& polynomial) {
  std::optional<Split> best;
  for (const TermId angle : AnglesOf(polynomial)) {
    auto split = SplitBy(polynomial, angle);
    if (split && (!best || split->rest.size() < best->rest.size())) best = std::move(split);
  }
  return best;
}

// polynomial = common * (A cos u + B sin u) + rest, with neither cos u nor sin u in A, B and the rest.
std::optional<Rotations::Split> Rotations::SplitBy(const Polynomial& polynomial, TermId angle) {
  const TermId cosine = arena_.Apply(Elementary::kCos, {angle});
  const TermId sine = arena_.Apply(Elementary::kSin, {angle});
  Split split;
  split.angle = angle;
  Vector scaled;
  bool cosines = false, sines = false;
  for (const auto& [m, c] : polynomial) {
    const auto waves = std::ranges::count_if(m, [&](TermId t) { return t == cosine || t == sine; });
    if (waves > 1) return std::nullopt;
    if (waves == 0) {
      split.rest.emplace(m, c);
      continue;
    }
    Monomial other = m;
    const auto wave = std::ranges::find_if(other, [&](TermId t) { return t == cosine || t == sine; });
    const bool first = *wave == cosine;
    other.erase(wave);
    (first ? scaled[other].first : scaled[other].second) = c;
    (first ? cosines : sines) = true;
  }
  if (!cosines || !sines || scaled.size() < 2) return std::nullopt;
  split.common = scaled.begin()->first;
  for (const auto& [m, z] : scaled) {
    Monomial both;
    std::ranges::set_intersection(split.common, m, std::back_inserter(both));
    split.common = std::move(both);
  }
  bool place = false;
  for (const auto& [m, z] : scaled) {
    Monomial other;
    std::ranges::set_difference(m, split.common, std::back_inserter(other));
    place = place || IsPlace(other);
    split.vector.emplace(std::move(other), z);
  }
  if (!place) return std::nullopt;
  return split;
}

Polynomial Rotations::Turned(Split split) {
  Complex ratio;
  const Frame& frame = FrameOf(split.angle, split.vector, ratio);
  Polynomial result = std::move(split.rest);
  for (const auto& [coordinate, factor] :
       {std::pair(frame.p, ratio.first), std::pair(frame.q, Rational(0) - ratio.second)}) {
    if (factor.IsZero()) continue;
    const auto [lead, monic] = Monic(arena_, coordinate);
    AddTo(result, expr::Product(split.common, Monomial{monic}), factor * lead);
  }
  return result;
}

// The square of the length of its vector; nothing if that is too long to be of use.
const Polynomial& Rotations::LengthOf(const Frame& frame) {
  if (frame.length) return *frame.length;
  frame.length.emplace();
  const auto [a, b] = PartsOf(frame.vector);
  const auto first = expr::Product(a, a, kMostMonomials);
  const auto second = expr::Product(b, b, kMostMonomials);
  if (!first || !second) return *frame.length;
  frame.length = *first;
  for (const auto& [m, c] : *second) AddTo(*frame.length, m, c);
  return *frame.length;
}

// How often the squares of `length` occur in a polynomial, all of them equally often; nothing if they do not.
std::optional<Rational> Rotations::TimesIn(const Polynomial& polynomial, const Polynomial& length) {
  std::optional<Rational> times;
  for (const auto& [m, c] : length) {
    if (m.size() < 2 || m.front() != m.back()) continue;
    const auto it = polynomial.find(m);
    if (it == polynomial.end() || (times && it->second != *times * c)) return std::nullopt;
    times = it->second / c;
  }
  return times;
}

// Lengths of vectors that are turned become lengths of what they are turned into, if that is shorter.
void Rotations::Shorten(Polynomial& polynomial) {
  Polynomial longer = polynomial;
  std::set<const Frame*> used;
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [angle, frames] : frames_) {
      for (const Frame& f : frames) {
        if (used.contains(&f)) continue;
        const auto times = TimesIn(longer, LengthOf(f));
        if (!times) continue;
        for (const auto& [m, c] : LengthOf(f)) AddTo(longer, m, Rational(0) - *times * c);
        for (const TermId coordinate : {f.p, f.q}) {
          const auto [lead, monic] = Monic(arena_, coordinate);
          AddTo(longer, {monic, monic}, *times * lead * lead);
        }
        used.insert(&f);
        changed = true;
        if (longer.size() < polynomial.size()) polynomial = longer;
      }
    }
  }
}

Lemma Rotations::Link(TermId sum, const Polynomial& polynomial) {
  Lemma link{{{Rational(-1), sum}}, Rational(0)};
  for (const auto& [m, c] : polynomial) {
    if (m.empty()) {
      link.constant = c;
      continue;
    }
    TermId product = m[0];
    for (size_t i = 1; i < m.size(); ++i) product = arena_.Mul(product, m[i]);
    link.parts.emplace_back(c, product);
  }
  return link;
}

std::vector<Lemma> Rotations::Links() {
  std::vector<TermId> sums;
  std::unordered_set<TermId> seen;
  for (const TermId formula : rewritten_) {
    expr::VisitPostorder(arena_, formula, seen, [&](TermId t) {
      if (arena_.op(t) == Op::kAdd && IsTotal(t)) sums.push_back(t);
    });
  }
  std::vector<Lemma> links;
  for (const TermId sum : sums) {
    const auto over = Over(sum);
    if (!over || over->size() >= arena_.args(sum).size()) continue;
    const Lemma link = Link(sum, *over);
    // A coordinate itself is the sum.
    if (link.parts.size() != 2 || link.parts[1].second != sum) links.push_back(link);
  }
  if (links.empty()) return links;
  // The vectors of the frames, over the frames further in.
  for (auto& [angle, frames] : frames_) {
    for (Frame& f : frames) {
      f.both = true;
      const auto [a, b] = PartsOf(f.vector);
      for (const auto& [term, over] : {std::pair(f.a, a), std::pair(f.b, b)}) {
        const bool further = std::ranges::any_of(over, [&](const auto& summand) {
          return std::ranges::any_of(summand.first, [&](TermId t) { return arena_.op(t) == Op::kAdd; });
        });
        if (further && over.size() > 1) links.push_back(Link(term, over));
      }
    }
  }
  return links;
}

}  // namespace rondo::solve::icp
