#include "robot/separation/cuts.h"

#include <cmath>

#include "robot/separation/numeric_set.h"

namespace rondo::robot {
namespace {

using Eigen::Vector3d;
using expr::Rational;

Rational Rounded(double value, int64_t parts) {
  return Rational(static_cast<int64_t>(std::llround(value * static_cast<double>(parts)))) / Rational(parts);
}

/// How the directions of solids and balls follow the configuration.
enum class Follow : uint8_t {
  kWorld,    ///< fixed
  kFirst,    ///< fixed in the frame of the first solid
  kSecond,   ///< in the frame of the set itself
  kAzimuth,  ///< up, and horizontally from the centre of the set to the first solid
};

class Search {
 public:
  Search(Arena& arena, const Piece& piece, expr::Numeric& numeric)
      : arena_(arena), piece_(piece), numeric_(numeric) {
    for (const Set& s : piece) sets_.push_back(Evaluate(arena, s, numeric));
  }

  Cut Run() {
    Cut cut;
    cut.apart = -1e300;
    for (size_t i = 0; i < piece_.size(); ++i) {
      if (piece_[i].kind == SetKind::kSolid) Single(i, cut);
    }
    for (size_t i = 0; i < piece_.size(); ++i) {
      if (piece_[i].kind != SetKind::kSolid) continue;
      Mixed(i, cut);
      break;
    }
    return cut;
  }

 private:
  // One half-space and one solid.
  void Single(size_t solid, Cut& cut) {
    std::optional<size_t> best;
    double most = 1e-9;
    for (size_t j = 0; j < piece_.size(); ++j) {
      if (piece_[j].kind != SetKind::kBelow) continue;
      const Vector3d& n = sets_[j].normal;
      const double gap = (n.dot(sets_[solid].FarthestAlong(-n)) - sets_[j].bound) / n.norm();
      if (!(gap > most)) continue;
      most = gap;
      best = j;
    }
    if (!best) return;
    const Set& below = piece_[*best];
    const TermId support = Support(arena_, piece_[solid], Opposite(arena_, Along(arena_, below.normal)));
    Add(arena_.Add(support, below.bound), below.open, cut);
    cut.apart = std::max(cut.apart, most);
  }

  void Mixed(size_t first, Cut& cut) {
    const Separation best = Separate(sets_, first);
    cut.apart = std::max(cut.apart, -best.sum);
    if (!(best.sum < -1e-9)) return;
    bool free = false;
    for (size_t i = 0; i < piece_.size(); ++i)
      free = free || (i != first && best.directions[i].norm() > 1e-9 && piece_[i].kind != SetKind::kBelow);
    Mix(first, best, Follow::kWorld, cut);
    if (!free) return;
    Mix(first, best, Follow::kFirst, cut);
    Mix(first, best, Follow::kSecond, cut);
    Mix(first, best, Follow::kAzimuth, cut);
  }

  void Mix(size_t first, const Separation& best, Follow follow, Cut& cut) {
    for (const int64_t parts : {int64_t{100}, int64_t{10'000}, int64_t{100'000'000}}) {
      if (Mix(first, best, follow, parts, cut)) return;
    }
  }

  // The condition for rounded directions, if it separates here.
  bool Mix(size_t first, const Separation& best, Follow follow, int64_t parts, Cut& cut) {
    double scale = 0;
    for (size_t i = 0; i < piece_.size(); ++i) {
      if (i != first)
        scale = std::max({scale, best.factors[i], best.directions[i].lpNorm<Eigen::Infinity>()});
    }
    if (!(scale > 0) || !std::isfinite(scale)) return false;
    const TermId zero = arena_.Number(arena_.Real(), Rational(0));
    std::vector<TermId> sum;
    Vector rest{zero, zero, zero};
    bool open = false;
    size_t used = 0;
    Direction only;
    for (size_t i = 0; i < piece_.size(); ++i) {
      const Set& set = piece_[i];
      if (i == first || set.kind == SetKind::kOutside) continue;
      Direction d;
      if (set.kind == SetKind::kBelow) {
        const Rational factor = Rounded(best.factors[i] / scale, parts);
        if (!(Rational(0) < factor)) continue;
        const TermId f = arena_.Number(arena_.Real(), factor);
        for (size_t k = 0; k < 3; ++k) d.vector[k] = arena_.Mul(f, set.normal[k]);
        d = Along(arena_, d.vector);
        sum.push_back(arena_.Mul(f, set.bound));
      } else {
        const auto direction = Following(first, i, best.directions[i] / scale, follow, parts);
        if (!direction) continue;
        d = *direction;
        sum.push_back(Support(arena_, set, d));
      }
      open = open || set.open;
      rest = Minus(arena_, rest, d.vector);
      only = d;
      ++used;
    }
    if (used == 0) return false;
    Direction balance = Along(arena_, rest);
    if (used == 1) balance.squared = only.squared;
    sum.push_back(Support(arena_, piece_[first], balance));
    const TermId total = arena_.Add(sum);
    if (!(numeric_(total) < -1e-12)) return false;
    Add(total, open, cut);
    return true;
  }

  std::optional<Direction> Following(size_t first, size_t i, const Vector3d& d, Follow follow,
                                     int64_t parts) {
    const Set& set = piece_[i];
    const auto rounded = [&](const Vector3d& v) {
      return std::array<Rational, 3>{Rounded(v[0], parts), Rounded(v[1], parts), Rounded(v[2], parts)};
    };
    const auto in = [&](const Pose& frame, const Vector3d& v) -> std::optional<Direction> {
      const auto c = rounded(v);
      if (c[0] == Rational(0) && c[1] == Rational(0) && c[2] == Rational(0)) return std::nullopt;
      return DirectionIn(arena_, frame, c);
    };
    const bool whole = set.kind == SetKind::kSolid || (set.axes[0] && set.axes[1] && set.axes[2]);
    switch (follow) {
      case Follow::kWorld:
        return in(Identity(arena_), d);
      case Follow::kFirst:
        if (!whole) return std::nullopt;
        return in(piece_[first].solid.frame, sets_[first].rotation.transpose() * d);
      case Follow::kSecond:
        if (set.kind != SetKind::kSolid) return std::nullopt;
        return in(set.solid.frame, sets_[i].rotation.transpose() * d);
      case Follow::kAzimuth:
        break;
    }
    if (!set.axes[0] || !set.axes[1]) return std::nullopt;
    const Vector& centre = set.kind == SetKind::kSolid ? set.solid.frame.origin : set.centre;
    const Vector away = Minus(arena_, piece_[first].solid.frame.origin, centre);
    Vector3d flat = sets_[first].origin - sets_[i].origin;
    flat.z() = 0;
    if (flat.norm() < 1e-6) return std::nullopt;
    const TermId u = arena_.Number(arena_.Real(), Rounded(d.dot(flat) / flat.squaredNorm(), parts));
    const TermId w = arena_.Number(arena_.Real(), Rounded(set.axes[2] ? d.z() : 0, parts));
    return Along(arena_, {arena_.Mul(u, away[0]), arena_.Mul(u, away[1]), w});
  }

  void Add(TermId sum, bool open, Cut& cut) {
    const TermId zero = arena_.Number(arena_.Real(), Rational(0));
    cut.conditions.push_back(open ? arena_.Lt(zero, sum) : arena_.Le(zero, sum));
  }

  Arena& arena_;
  const Piece& piece_;
  expr::Numeric& numeric_;
  std::vector<NumericSet> sets_;
};

}  // namespace

Cuts::Cuts(Arena& arena, Piece piece) : arena_(arena), piece_(std::move(piece)) {
  bool changed = false;
  round_ = piece_;
  for (Set& set : round_) {
    if (set.kind != SetKind::kSolid) continue;
    const auto around = Around(arena, set.solid);
    if (!around) continue;
    set.solid = *around;
    changed = true;
  }
  if (!changed) round_.clear();
}

std::vector<TermId> Cuts::Common() {
  std::vector<TermId> conditions;
  Piece solids = piece_;
  solids.insert(solids.end(), round_.begin(), round_.end());
  for (const Set& outside : piece_) {
    if (outside.kind != SetKind::kOutside) continue;
    for (const Set& solid : solids) {
      if (solid.kind != SetKind::kSolid) continue;
      const TermId reach = Farthest(arena_, solid.solid, outside.centre, outside.axes);
      const TermId zero = arena_.Number(arena_.Real(), Rational(0));
      // reach >= sqrt(bound), for reach >= 0 and a bound that may be negative
      const TermId squared = Square(arena_, arena_.Apply(expr::Elementary::kMax, {reach, zero}));
      conditions.push_back(outside.open ? arena_.Lt(outside.bound, squared)
                                        : arena_.Le(outside.bound, squared));
    }
  }
  return conditions;
}

Cut Cuts::At(const expr::Numeric::Point& configuration) {
  expr::Numeric numeric(arena_, configuration);
  Cut cut = Search(arena_, piece_, numeric).Run();
  if (round_.empty() || cut.conditions.empty()) return cut;
  const Cut rounder = Search(arena_, round_, numeric).Run();
  cut.conditions.insert(cut.conditions.end(), rounder.conditions.begin(), rounder.conditions.end());
  return cut;
}

}  // namespace rondo::robot
