#include "reach/invariants/nowhere.h"

#include <cmath>

#include "reach/problem/bounds.h"
#include "verdict/truth.h"

namespace rondo::reach::invariants {

namespace {

// The side that is widest as a share of what it was; none if none can be halved.
std::optional<size_t> SideToHalve(const interval::Box& box, const interval::Box& whole) {
  std::optional<size_t> widest;
  double most = 1e-9;
  for (size_t i = 0; i < box.size(); ++i) {
    const double width = whole[i].Width();
    if (!std::isfinite(width) || !(width > 0)) continue;
    const double share = box[i].Width() / width;
    if (share <= most) continue;
    most = share;
    widest = i;
  }
  return widest;
}

}  // namespace

bool HoldsNowhere(expr::Arena& arena, TermId formula, const std::vector<TermId>& variables,
                  const interval::Box& box, size_t most_boxes, const base::StopToken& stop) {
  if (formula == arena.False()) return true;
  const auto normal = Normalise(arena, formula);
  if (!normal.ok()) return false;
  const auto terms = Compile(arena, variables, normal.value().terms);
  if (!terms.ok()) return false;
  const auto check = [&](const interval::Box& part) { return CheckBox(terms.value(), normal.value(), part); };
  std::vector<interval::Box> open{box};
  interval::Box middle(box.size());
  for (size_t boxes = 0; !open.empty(); ++boxes) {
    if (boxes == most_boxes || stop.StopRequested()) return false;
    interval::Box part = std::move(open.back());
    open.pop_back();
    if (check(part) == verdict::Truth::kFalse) continue;
    for (size_t i = 0; i < part.size(); ++i) middle[i] = Interval::Point(part[i].Middle());
    if (check(middle) == verdict::Truth::kTrue) return false;
    const auto side = SideToHalve(part, box);
    if (!side) return false;
    const double cut = part[*side].Middle();
    open.push_back(part);
    open.back()[*side].hi = cut;
    part[*side].lo = cut;
    open.push_back(std::move(part));
  }
  return true;
}

}  // namespace rondo::reach::invariants
