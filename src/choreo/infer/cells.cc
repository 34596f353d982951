#include "choreo/infer/cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace rondo::choreo {
namespace {

constexpr double kLeastGap = 2e-4;  // metres
constexpr int kDeepest = 60;

class Separating {
 public:
  explicit Separating(size_t threads) { cells_.by_thread.resize(threads); }

  Cells Run(std::vector<Extent> items) {
    Split(std::move(items), {}, 0);
    return std::move(cells_);
  }

 private:
  struct Plane {
    size_t direction = 0;
    double offset = 0, gap = 0;
    double score = 0;
  };

  void Split(std::vector<Extent> items, const Cell& cell, int depth) {
    if (cells_.conflict || items.empty()) return;
    const size_t first = items[0].thread;
    if (std::ranges::all_of(items, [&](const Extent& i) { return i.thread == first; })) {
      cells_.by_thread[first].push_back(cell);
      return;
    }
    for (; depth < kDeepest; ++depth) {
      if (const auto plane = Best(items)) {
        const size_t d = plane->direction;
        std::vector<Extent> low, high;
        for (const Extent& i : items) {
          const double least = i.Least(d), most = i.Most(d);
          if (least < plane->offset) low.push_back(i), low.back().to[d] = std::min(most, plane->offset);
          if (most > plane->offset) high.push_back(i), high.back().from[d] = std::max(least, plane->offset);
        }
        for (const bool below : {true, false}) {
          Cell part = cell;
          part.push_back({d, plane->offset, below});
          Split(std::move(below ? low : high), part, depth + 1);
        }
        return;
      }
      if (!Slice(items)) break;
    }
    if (!cells_.conflict) cells_.conflict = Closest(items);
  }

  // The plane that separates most pairs and cuts through few extents; of equal ones, the one with the widest
  // gap. Each side has fewer pairs, so that this comes to an end.
  static std::optional<Plane> Best(const std::vector<Extent>& items) {
    std::optional<Plane> best;
    for (size_t d = 0; d < kDirections.size(); ++d) {
      std::vector<double> ends;
      for (const Extent& i : items) ends.insert(ends.end(), {i.Least(d), i.Most(d)});
      std::ranges::sort(ends);
      const double length = std::hypot(kDirections[d][0], kDirections[d][1], kDirections[d][2]);
      for (size_t k = 0; k + 1 < ends.size(); ++k) {
        const double gap = (ends[k + 1] - ends[k]) / length * (d < 3 ? 4 : 1);  // axes are easier to read
        if (!(gap > kLeastGap)) continue;
        Plane plane{d, Round(ends[k], ends[k + 1]), gap, 0};
        plane.score = Score(items, plane);
        if (!(plane.score > 0)) continue;
        if (!best || plane.score > best->score || (plane.score == best->score && gap > best->gap))
          best = plane;
      }
    }
    return best;
  }

  // Pairs of different threads that the plane separates, by how many extents it cuts.
  static double Score(const std::vector<Extent>& items, const Plane& plane) {
    std::map<size_t, std::pair<double, double>> sides;  // by thread: below, above
    double below = 0, above = 0, cut = 0;
    for (const Extent& i : items) {
      if (i.Most(plane.direction) < plane.offset) {
        ++below, ++sides[i.thread].first;
      } else if (i.Least(plane.direction) > plane.offset) {
        ++above, ++sides[i.thread].second;
      } else {
        ++cut;
      }
    }
    double pairs = below * above;
    for (const auto& [thread, side] : sides) pairs -= side.first * side.second;
    return pairs / (1 + 2 * cut);
  }

  // A number with few digits in the middle of a gap.
  static double Round(double low, double high) {
    const double third = (high - low) / 3;
    for (const double unit : {1.0, 0.1, 0.05, 0.01, 0.005, 0.001, 0.0001}) {
      const double value = std::round((low + high) / 2 / unit) * unit;
      if (low + third <= value && value <= high - third) return value;
    }
    return (low + high) / 2;
  }

  // Divides the states of an extent that overlaps one of another thread: of the one that spreads most, along
  // the direction in which it does. False if there is none.
  static bool Slice(std::vector<Extent>& items) {
    size_t widest = items.size(), along = 0;
    double spread = 1e-3;
    for (size_t i = 0; i < items.size(); ++i) {
      if (items[i].moments.size() < 6) continue;
      const bool overlaps = std::ranges::any_of(
          items, [&](const Extent& j) { return j.thread != items[i].thread && Overlap(items[i], j); });
      if (!overlaps) continue;
      for (size_t d = 0; d < kDirections.size(); ++d) {
        const auto middle = [&](const Extent::Moment& m) { return m.least[d] + m.most[d]; };
        const auto [low, high] = std::ranges::minmax(items[i].moments, {}, middle);
        if (middle(high) - middle(low) <= spread) continue;
        spread = middle(high) - middle(low);
        widest = i;
        along = d;
      }
    }
    if (widest == items.size()) return false;
    Extent low = items[widest], high = items[widest];
    auto& moments = items[widest].moments;
    std::ranges::sort(moments, {}, [&](const auto& m) { return m.least[along] + m.most[along]; });
    // The states at the cut belong to both.
    const auto half = static_cast<std::ptrdiff_t>(moments.size() / 2);
    low.moments.assign(moments.begin(), moments.begin() + half + 1);
    high.moments.assign(moments.begin() + half - 1, moments.end());
    items[widest] = std::move(low);
    items.push_back(std::move(high));
    return true;
  }

  static bool Overlap(const Extent& a, const Extent& b) {
    for (size_t d = 0; d < kDirections.size(); ++d) {
      if (a.Most(d) + kLeastGap < b.Least(d) || b.Most(d) + kLeastGap < a.Least(d)) return false;
    }
    return true;
  }

  static std::pair<Extent, Extent> Closest(const std::vector<Extent>& items) {
    for (const Extent& a : items) {
      for (const Extent& b : items) {
        if (a.thread != b.thread && Overlap(a, b)) return {a, b};
      }
    }
    return {items.front(), items.back()};
  }

  Cells cells_;
};

}  // namespace

Extent::Extent() {
  from.fill(-std::numeric_limits<double>::infinity());
  to.fill(std::numeric_limits<double>::infinity());
}

double Extent::Least(size_t direction) const {
  double least = std::numeric_limits<double>::infinity();
  for (const Moment& m : moments) least = std::min(least, m.least[direction]);
  return std::max(least, from[direction]);
}

double Extent::Most(size_t direction) const {
  double most = -std::numeric_limits<double>::infinity();
  for (const Moment& m : moments) most = std::max(most, m.most[direction]);
  return std::min(most, to[direction]);
}

Cells Separate(std::vector<Extent> items, size_t threads) {
  return Separating(threads).Run(std::move(items));
}

std::string Offset(double offset) {
  std::string text = fmt::format("{:.4f}", offset);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string ToText(const std::vector<Cell>& cells) {
  static constexpr std::array<const char*, kDirections.size()> kNames{
      "x", "y", "z", "x + y", "x - y", "x + z", "x - z", "y + z", "y - z"};
  std::string text;
  for (const Cell& cell : cells) {
    std::string part;
    // Of the planes in one direction only the nearest ones matter.
    for (size_t d = 0; d < kDirections.size(); ++d) {
      for (const bool below : {false, true}) {
        std::optional<double> offset;
        for (const Side& s : cell) {
          if (s.direction != d || s.below != below) continue;
          offset = !offset ? s.offset : below ? std::min(*offset, s.offset) : std::max(*offset, s.offset);
        }
        if (!offset) continue;
        part += fmt::format("{}{} {} {} m", part.empty() ? "" : " and ", kNames[d], below ? "<" : ">",
                            Offset(*offset));
      }
    }
    text += (text.empty() ? "" : " or ") + (part.empty() ? "true" : part);
  }
  return text.empty() ? "false" : text;
}

}  // namespace rondo::choreo
