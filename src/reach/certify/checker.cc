#include "reach/certify/checker.h"

#include <algorithm>

#include "base/parallel.h"
#include "reach/certify/cells.h"
#include "reach/certify/follower.h"
#include "reach/certify/invariance.h"

namespace rondo::reach::certify {

namespace {

constexpr size_t kMostCuts = 4000;  // one inside the other
constexpr size_t kLowDegree = 2;
constexpr size_t kHighDegree = 3;
constexpr size_t kMostDegree = 20;
constexpr size_t kMostSplits = 6;  // of a part, one inside the other

// Which half of a box; copies of a state have its bounds.
interval::Box Half(System& system, interval::Box box, size_t side, bool upper) {
  const double middle = box[side].Middle();
  (upper ? box[side].lo : box[side].hi) = middle;
  const auto& copies = system.problem().copy_of;
  for (size_t i = 0; i < copies.size(); ++i) {
    if (copies[i] == side) box[i] = box[side];
  }
  return box;
}

struct Part {
  interval::Box box;
  interval::Box recorded;  ///< what the steps are about: itself, or what it is a piece of
  const std::vector<PartRecord::Step>* steps;
};

// The parts with their boxes. They must be the leaves of one binary tree: then they are all of the box.
bool Divide(System& system, const interval::Box& box, std::span<const PartRecord* const> records,
            size_t depth, std::vector<Part>& parts) {
  if (records.empty() || depth > kMostCuts) return false;
  if (records.size() == 1 && records[0]->path.size() == depth) {
    parts.push_back({box, box, &records[0]->steps});
    return true;
  }
  const auto& copies = system.problem().copy_of;
  std::vector<const PartRecord*> halves[2];
  std::optional<size_t> side;
  for (const PartRecord* r : records) {
    if (r->path.size() <= depth) return false;
    const PartRecord::Cut& cut = r->path[depth];
    if (side.value_or(cut.side) != cut.side || cut.side >= box.size()) return false;
    if (cut.side < copies.size() && copies[cut.side]) return false;
    side = cut.side;
    halves[cut.upper ? 1 : 0].push_back(r);
  }
  return Divide(system, Half(system, box, *side, false), halves[0], depth + 1, parts) &&
         Divide(system, Half(system, box, *side, true), halves[1], depth + 1, parts);
}

// A part that is too wide to be followed here is cut in two.
std::string CheckPart(System& system, Bases& bases, const Part& part, size_t depth,
                      const base::StopToken& stop, size_t& steps) {
  // Polynomials of a low degree are many times cheaper, and often enough.
  const bool high =
      std::ranges::any_of(*part.steps, [](const PartRecord::Step& s) { return s.degree > kHighDegree; });
  if (high && depth == 0) {
    Follower cheap(system, bases, kLowDegree, stop);
    std::string reason = cheap.Run(part.box, part.recorded, *part.steps);
    steps += cheap.steps();
    if (reason.empty() || stop.StopRequested()) return reason;
  }
  Follower follower(system, bases, kMostDegree, stop);
  std::string reason = follower.Run(part.box, part.recorded, *part.steps);
  steps += follower.steps();
  if (reason.empty() || depth == kMostSplits || stop.StopRequested()) return reason;
  const auto side = follower.WorstSide();
  if (!side) return reason;
  for (const bool upper : {false, true}) {
    std::string own =
        CheckPart(system, bases, {Half(system, part.box, *side, upper), part.recorded, part.steps}, depth + 1,
                  stop, steps);
    if (!own.empty()) return own;
  }
  return "";
}

// What no invariant shows, by following every part of the initial set.
void CheckParts(const Problem& problem, const std::vector<PartRecord>& recorded, unsigned jobs,
                const base::StopToken& stop, Acceptance& verdict) {
  auto made = System::Of(problem);
  if (!made.ok()) {
    verdict.reason = made.error().message;
    return;
  }
  System& system = *made.value();
  std::vector<const PartRecord*> records;
  for (const PartRecord& r : recorded) records.push_back(&r);
  std::vector<Part> parts;
  if (!Divide(system, problem.initial, records, 0, parts)) {
    verdict.reason = "its parts are not the whole initial set";
    return;
  }
  Bases bases;
  std::vector<std::string> reasons(parts.size());
  std::vector<size_t> steps(parts.size());
  base::ParallelFor(parts.size(), jobs,
                    [&](size_t i) { reasons[i] = CheckPart(system, bases, parts[i], 0, stop, steps[i]); });
  for (size_t i = 0; i < reasons.size(); ++i) {
    verdict.steps += steps[i];
    if (!reasons[i].empty() && verdict.reason.empty()) verdict.reason = reasons[i];
  }
  verdict.accepted = verdict.reason.empty();
}

}  // namespace

Acceptance Check(const Problem& problem, const Certificate& certificate, unsigned jobs,
                 const base::StopToken& stop) {
  Acceptance verdict;
  if (certificate.paving) {
    const auto shown = CheckPaving(problem, *certificate.paving, jobs, stop);
    verdict.accepted = shown.ok();
    if (shown.ok()) verdict.steps = shown.value();
    if (!shown.ok()) verdict.reason = shown.error().message;
    return verdict;
  }
  Problem rest = problem;
  if (certificate.invariant) {
    auto shown = CheckInvariant(problem, *certificate.invariant, stop);
    if (!shown.ok()) {
      verdict.reason = shown.error().message;
      return verdict;
    }
    verdict.boxes = shown.value().boxes;
    const std::vector<size_t>& claims = shown.value().claims;
    for (size_t i = claims.size(); i-- > 0;)
      rest.claims.erase(rest.claims.begin() + static_cast<ptrdiff_t>(claims[i]));
    verdict.accepted = rest.claims.empty();
    if (verdict.accepted) return verdict;
  }
  CheckParts(rest, certificate.parts, jobs, stop, verdict);
  return verdict;
}

}  // namespace rondo::reach::certify
