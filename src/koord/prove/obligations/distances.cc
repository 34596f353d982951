#include "koord/prove/obligations/distances.h"

#include <algorithm>
#include <functional>
#include <unordered_set>

#include "expr/substitute.h"

namespace rondo::koord {

using expr::Op;
using expr::Rational;

namespace {

// Calls `visit` once for each distance in the formulas, open or not. It must make no terms.
void EachDistance(Vocabulary& vocabulary, const std::vector<TermId>& formulas,
                  const std::function<void(TermId)>& visit) {
  const expr::Arena& arena = vocabulary.arena();
  const expr::SymbolId dist = vocabulary.Dist();
  std::unordered_set<TermId> seen;
  for (const TermId formula : formulas) {
    expr::VisitPostorder(arena, formula, seen, [&](TermId t) {
      if (arena.op(t) == Op::kApply && arena.symbol_of(t) == dist) visit(t);
    });
  }
}

}  // namespace

TermId Distances::Distance(TermId p, TermId q) { return arena_.Apply(vocabulary_.Dist(), {p, q}); }

// One term for both directions.
TermId Distances::Side(TermId p, TermId q) { return q < p ? Distance(q, p) : Distance(p, q); }

std::vector<TermId> Distances::Axioms(const std::vector<TermId>& formulas) {
  std::vector<TermId> axioms;
  std::vector<TermId> distances;
  EachDistance(vocabulary_, formulas, [&](TermId t) {
    if (!arena_.IsOpen(t)) distances.push_back(t);
  });
  const auto learn = [&](TermId p) {
    if (std::find(points_.begin(), points_.end(), p) == points_.end()) points_.push_back(p);
  };
  for (const TermId t : distances) {
    const TermId p = arena_.arg(t, 0);
    const TermId q = arena_.arg(t, 1);
    learn(p);
    learn(q);
    pairs_.insert({std::min(p, q), std::max(p, q)});
    if (q < p && mirrored_.insert({p, q}).second) axioms.push_back(arena_.Eq(t, Distance(q, p)));
  }
  const auto known = [&](TermId p, TermId q) { return pairs_.contains({std::min(p, q), std::max(p, q)}); };
  // Of a triangle, two sides are enough to speak of the third.
  for (size_t i = 0; detail_ == Detail::kAll && i < points_.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      for (size_t k = 0; k < j && triangles_.size() < kMostTriangles; ++k) {
        const int sides =
            known(points_[i], points_[j]) + known(points_[i], points_[k]) + known(points_[j], points_[k]);
        if (sides < 2 || !triangles_.insert({points_[k], points_[j], points_[i]}).second) continue;
        OfTriangle(points_[k], points_[j], points_[i], axioms);
      }
    }
  }
  for (const auto& [p, q] : pairs_) {
    if (said_.insert({p, q}).second) OfPair(p, q, axioms);
  }
  return axioms;
}

void Distances::OfPair(TermId p, TermId q, std::vector<TermId>& axioms) {
  const TermId d = Distance(p, q);
  const TermId zero = arena_.Number(arena_.Real(), Rational(0));
  axioms.push_back(arena_.Le(zero, d));
  axioms.push_back(arena_.Eq(arena_.Eq(d, zero), arena_.Eq(p, q)));
  if (detail_ == Detail::kDistance) return;
  std::vector<TermId> size;
  std::vector<TermId> same;
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const TermId a = arena_.Field(p, axis);
    const TermId b = arena_.Field(q, axis);
    axioms.push_back(arena_.Le(arena_.Sub(a, b), d));
    axioms.push_back(arena_.Le(arena_.Sub(b, a), d));
    size.push_back(arena_.Ite(arena_.Le(a, b), arena_.Sub(b, a), arena_.Sub(a, b)));
    same.push_back(arena_.Eq(a, b));
  }
  axioms.push_back(arena_.Le(d, arena_.Add(size)));
  // On a line along an axis the distance is known.
  for (uint32_t axis = 0; axis < 3; ++axis) {
    axioms.push_back(
        arena_.Implies(arena_.And(same[(axis + 1) % 3], same[(axis + 2) % 3]), arena_.Eq(d, size[axis])));
  }
}

TermId AlongAxes(Vocabulary& vocabulary, const std::vector<TermId>& formulas) {
  expr::Arena& arena = vocabulary.arena();
  std::vector<TermId> distances;
  EachDistance(vocabulary, formulas, [&](TermId t) {
    if (!arena.IsOpen(t)) distances.push_back(t);
  });
  std::vector<TermId> all;
  for (const TermId t : distances) {
    std::vector<TermId> same;
    for (uint32_t axis = 0; axis < 3; ++axis)
      same.push_back(arena.Eq(arena.Field(arena.arg(t, 0), axis), arena.Field(arena.arg(t, 1), axis)));
    std::vector<TermId> either;
    for (size_t axis = 0; axis < 3; ++axis)
      either.push_back(arena.And(same[(axis + 1) % 3], same[(axis + 2) % 3]));
    all.push_back(arena.Or(either));
  }
  return arena.And(all);
}

bool HasDistanceOfAnyPoints(Vocabulary& vocabulary, const std::vector<TermId>& formulas) {
  bool found = false;
  EachDistance(vocabulary, formulas, [&](TermId t) { found = found || vocabulary.arena().IsOpen(t); });
  return found;
}

bool Distances::IsMiddle(TermId m, TermId p, TermId q) {
  const TermId half = arena_.Number(arena_.Real(), Rational(1) / Rational(2));
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const TermId middle = arena_.Mul(half, arena_.Add(arena_.Field(p, axis), arena_.Field(q, axis)));
    if (arena_.Field(m, axis) != middle) return false;
  }
  return true;
}

void Distances::OfTriangle(TermId p, TermId q, TermId r, std::vector<TermId>& axioms) {
  const std::array<TermId, 3> points{p, q, r};
  for (size_t i = 0; i < 3; ++i) {
    const TermId a = points[i];
    const TermId b = points[(i + 1) % 3];
    const TermId c = points[(i + 2) % 3];
    pairs_.insert({std::min(a, b), std::max(a, b)});
    axioms.push_back(arena_.Le(Side(a, b), arena_.Add(Side(b, c), Side(a, c))));
    if (!IsMiddle(a, b, c)) continue;
    const TermId half = arena_.Number(arena_.Real(), Rational(1) / Rational(2));
    axioms.push_back(arena_.Eq(Side(a, b), arena_.Mul(half, Side(b, c))));
    axioms.push_back(arena_.Eq(Side(a, c), arena_.Mul(half, Side(b, c))));
  }
}

}  // namespace rondo::koord
