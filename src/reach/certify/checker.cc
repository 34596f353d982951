#include "reach/certify/checker.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/parallel.h"
#include "reach/certify/follower.h"
#include "reach/system/bounds.h"

namespace rondo::reach::certify {

namespace {

constexpr size_t kMostDepth = 400;  // of cuts, one inside the other
constexpr size_t kMostSplits = 6;   // of a part, one inside the other

// Do parts cover a box? By cuts that no part straddles: proofs split boxes in two.
class Cover {
 public:
  Cover(const System& system, const std::vector<PartRecord>& parts) : system_(system), parts_(parts) {}

  bool Run(const interval::Box& box) {
    std::vector<size_t> all(parts_.size());
    for (size_t i = 0; i < all.size(); ++i) all[i] = i;
    return Covers(box, all, 0);
  }

 private:
  bool IsCopy(size_t i) const {
    const auto& copies = system_.problem->copy_of;
    return i < copies.size() && copies[i].has_value();
  }
  // Sides of copies are those of the originals.
  void Set(interval::Box& box, size_t side, interval::Interval value) const {
    box[side] = value;
    const auto& copies = system_.problem->copy_of;
    for (size_t i = 0; i < copies.size(); ++i) {
      if (copies[i] == side) box[i] = value;
    }
  }

  bool Covers(const interval::Box& box, const std::vector<size_t>& inside, size_t depth) const {
    for (const size_t p : inside) {
      bool holds = true;
      for (size_t i = 0; i < box.size(); ++i) holds = holds && parts_[p].initial[i].Contains(box[i]);
      if (holds) return true;
    }
    if (inside.empty() || depth > kMostDepth)
      return CheckBox(system_.assumed_terms, system_.assumed, box) == Truth::kFalse;
    for (size_t i = 0; i < box.size(); ++i) {
      if (IsCopy(i)) continue;
      for (const size_t p : inside) {
        for (const double at : {parts_[p].initial[i].lo, parts_[p].initial[i].hi}) {
          if (!(box[i].lo < at && at < box[i].hi)) continue;
          std::vector<size_t> below;
          std::vector<size_t> above;
          bool straddles = false;
          for (const size_t q : inside) {
            const interval::Interval side = parts_[q].initial[i];
            if (side.hi <= at) {
              below.push_back(q);
            } else if (side.lo >= at) {
              above.push_back(q);
            } else {
              straddles = true;
              break;
            }
          }
          if (straddles) continue;
          interval::Box half = box;
          Set(half, i, {box[i].lo, at});
          if (!Covers(half, below, depth + 1)) return false;
          Set(half, i, {at, box[i].hi});
          return Covers(half, above, depth + 1);
        }
      }
    }
    return CheckBox(system_.assumed_terms, system_.assumed, box) == Truth::kFalse;
  }

  const System& system_;
  const std::vector<PartRecord>& parts_;
};

// A part that is too wide to be followed here is cut in two.
std::string CheckPart(const System& system, Bases& bases, const PartRecord& part, size_t depth,
                      const base::StopToken& stop, size_t& steps) {
  Follower follower(system, bases, stop);
  std::string reason = follower.Run(part);
  steps += follower.steps();
  if (reason.empty() || depth == kMostSplits || stop.StopRequested()) return reason;
  const auto side = follower.WorstSide();
  if (!side) return reason;
  const interval::Interval whole = part.initial[*side];
  const double middle = whole.Middle();
  const auto& copies = system.problem->copy_of;
  for (const interval::Interval half : {interval::Interval{whole.lo, middle}, {middle, whole.hi}}) {
    PartRecord smaller = part;
    smaller.initial[*side] = half;
    for (size_t i = 0; i < copies.size(); ++i) {
      if (copies[i] == *side) smaller.initial[i] = half;
    }
    std::string own = CheckPart(system, bases, smaller, depth + 1, stop, steps);
    if (!own.empty()) return own;
  }
  return "";
}

}  // namespace

Verdict Check(const Problem& problem, const Certificate& certificate, unsigned jobs,
              const base::StopToken& stop) {
  Verdict verdict;
  const auto system = System::Of(problem);
  if (!system.ok()) {
    verdict.reason = system.error().message;
    return verdict;
  }
  for (const PartRecord& part : certificate.parts) {
    if (part.initial.size() == problem.states.size()) continue;
    verdict.reason = "it is about another number of states";
    return verdict;
  }
  if (!Cover(system.value(), certificate.parts).Run(problem.initial)) {
    verdict.reason = "its parts do not cover the initial set";
    return verdict;
  }
  Bases bases;
  std::vector<std::string> reasons(certificate.parts.size());
  std::vector<size_t> steps(certificate.parts.size());
  base::ParallelFor(certificate.parts.size(), jobs, [&](size_t i) {
    reasons[i] = CheckPart(system.value(), bases, certificate.parts[i], 0, stop, steps[i]);
  });
  for (size_t i = 0; i < reasons.size(); ++i) {
    verdict.steps += steps[i];
    if (!reasons[i].empty() && verdict.reason.empty()) verdict.reason = reasons[i];
  }
  verdict.accepted = verdict.reason.empty();
  return verdict;
}

}  // namespace rondo::reach::certify
