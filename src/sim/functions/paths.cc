#include <algorithm>
#include <bit>

#include "base/mixed.h"
#include "sim/functions/functions.h"

namespace rondo::sim {

using koord::semantics::FromFloat;
using koord::semantics::ToFloat;
using koord::semantics::ToInt;

namespace {

/// What nothing is near to: metres.
constexpr double kFar = 1e9;

World With(World world, const World& others) {
  world.cylinders.insert(world.cylinders.end(), others.cylinders.begin(), others.cylinders.end());
  return world;
}

}  // namespace

void Functions::PathIsClear(size_t, Arguments a, std::span<Word> result) {
  const std::vector<Word> paths(heap()[a[0]].begin(), heap()[a[0]].end());
  const std::vector<Point> candidate = DecodePath(heap(), a[1]);
  bool clear = true;
  for (size_t j = 0; j < paths.size(); ++j) {
    if (ToInt(a[2]) != static_cast<int64_t>(j))
      clear = clear && PathDistance(DecodePath(heap(), paths[j]), candidate) > path_clearance_;
  }
  result[0] = clear;
}

void Functions::Apart(size_t, Arguments a, std::span<Word> result) {
  result[0] = FromFloat(std::min(kFar, PathDistance(DecodePath(heap(), a[0]), DecodePath(heap(), a[1]))));
}

void Functions::Away(size_t, Arguments a, std::span<Word> result) {
  result[0] = FromFloat(std::min(kFar, PathDistance({ReadPoint(a.data())}, DecodePath(heap(), a[3]))));
}

void Functions::PlanTo(size_t robot, const Point& target, const World& world, std::span<Word> result) {
  const Body& body = *(*bodies_)[robot];
  PlanRequest request;
  request.start = body.position();
  request.goal = target;
  request.clearance = fleet_.clearance;
  request.flies = body.flies();
  // The same question in the same place has the same answer, until there was none.
  uint64_t seed = seed_ * 1'000'003 + robot;
  for (const Point& p : {request.start, request.goal}) {
    for (const double x : p) seed = base::Mixed(seed ^ std::bit_cast<uint64_t>(x + 0.0));
  }
  request.seed = seed + failures_;
  const World around = fleet_.around_robots ? With(world, Others(*bodies_, robot)) : world;
  const Planned planned = planner_ ? planner_(around, request) : Planned{true, Plan(around, request)};
  later_ = !planned.ready;
  if (later_) return;
  ++plans_;
  // No way: an empty path, which programs test for.
  if (!planned.path) ++failures_;
  result[0] = planned.path ? EncodePath(heap(), *planned.path) : 0;
}

void Functions::PlanPath(size_t robot, Arguments a, std::span<Word> result) {
  PlanTo(robot, ReadPoint(a.data()), fleet_.world, result);
}

void Functions::PlanAround(size_t robot, Arguments a, std::span<Word> result) {
  World world;
  world.low = fleet_.world.low;
  world.high = fleet_.world.high;
  for (const Word cell : heap()[a[3]]) {
    const auto words = heap()[cell];
    if (words.size() != 3) continue;
    const double size = ToFloat(words[2]);
    world.boxes.push_back({{ToFloat(words[0]), ToFloat(words[1]), 0}, {size, size, 10}});
  }
  PlanTo(robot, ReadPoint(a.data()), world, result);
}

}  // namespace rondo::sim
