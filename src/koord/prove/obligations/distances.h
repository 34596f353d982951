#pragma once

#include <array>
#include <set>
#include <utility>
#include <vector>

#include "koord/prove/execution/vocabulary.h"

/// Tells the solver what it has to know about `dist`.
namespace rondo::koord {

/// States what Euclid knows of the distances of points that occur in formulas, which solvers take as an
/// uninterpreted function: distances are not negative, symmetric, and zero for equal points alone; no two
/// sides of a triangle are shorter together than the third; coordinates differ by no more than the distance,
/// which is no more than the sum of these differences; the middle of two points is half as far from either.
/// The axioms are quantifier-free and linear and name no new points, so that this ends; a model may still
/// take a distance that is none.
/// Cost: cubic in the number of points, up to a limit of triangles.
class Distances {
 public:
  /// Says how much is stated: kDistance only that distances are not negative, symmetric, and zero for equal
  /// points alone; kAll everything.
  enum class Detail : uint8_t { kDistance, kAll };
  Distances(Vocabulary& vocabulary, Detail detail)
      : vocabulary_(vocabulary), arena_(vocabulary.arena()), detail_(detail) {}
  /// Returns the axioms for the distances in `formulas` that earlier calls have not returned.
  std::vector<TermId> Axioms(const std::vector<TermId>& formulas);

 private:
  static constexpr size_t kMostTriangles = 600;

  TermId Distance(TermId p, TermId q);
  TermId Side(TermId p, TermId q);
  void OfPair(TermId p, TermId q, std::vector<TermId>& axioms);
  void OfTriangle(TermId p, TermId q, TermId r, std::vector<TermId>& axioms);
  bool IsMiddle(TermId m, TermId p, TermId q);

  Vocabulary& vocabulary_;
  expr::Arena& arena_;
  Detail detail_;
  std::vector<TermId> points_;
  std::set<std::pair<TermId, TermId>> pairs_;  // with a known distance, the smaller id first
  std::set<std::pair<TermId, TermId>> said_;
  std::set<std::array<TermId, 3>> triangles_;
  std::set<std::pair<TermId, TermId>> mirrored_;
};

/// Returns the formula that the points of each ground distance in `formulas` differ along one axis only. With
/// it, `Axioms` leave each distance one value, the true one, so that a model is a counterexample in space.
TermId AlongAxes(Vocabulary& vocabulary, const std::vector<TermId>& formulas);

/// Reports whether a quantifier in `formulas` speaks of the distances of points that have no name. A model
/// may take any function for those, and nothing says that the true one would do.
bool HasDistanceOfAnyPoints(Vocabulary& vocabulary, const std::vector<TermId>& formulas);

}  // namespace rondo::koord
