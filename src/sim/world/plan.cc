#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/terminationconditions/IterationTerminationCondition.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <cmath>

#include "sim/world/world.h"

namespace rondo::sim {

namespace ob = ompl::base;
namespace og = ompl::geometric;

namespace {

bool Free(const World& world, const Point& p, double clearance, bool flies) {
  for (size_t i = 0; i < (flies ? 3U : 2U); ++i) {
    if (p[i] < world.low[i] || p[i] > world.high[i]) return false;
  }
  for (const Box& b : world.boxes) {
    double sum = 0;
    for (size_t i = 0; i < 3; ++i) {
      const double d = std::max(0.0, std::fabs(p[i] - b.centre[i]) - b.size[i] / 2);
      if (i < 2 || flies) sum += d * d;
    }
    if (sum < clearance * clearance) return false;
  }
  for (const Cylinder& c : world.cylinders) {
    const double flat = std::max(0.0, std::hypot(p[0] - c.centre[0], p[1] - c.centre[1]) - c.radius);
    const double high = flies ? std::max(0.0, std::fabs(p[2] - c.centre[2]) - c.height / 2) : 0;
    if (flat * flat + high * high < clearance * clearance) return false;
  }
  return true;
}

// Every few centimetres.
bool FreeLine(const World& world, const Point& a, const Point& b, double clearance, bool flies) {
  const auto steps = static_cast<size_t>(std::ceil(Distance(a, b) / 0.05)) + 1;
  for (size_t i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(steps);
    const Point p{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
    if (!Free(world, p, clearance, flies)) return false;
  }
  return true;
}

// Without the projections that other planners need: those of more than two dimensions are matrices that the library
// allocates in one way and frees in another if it is built with other options than this.
class Space : public ob::RealVectorStateSpace {
 public:
  using RealVectorStateSpace::RealVectorStateSpace;
  void registerProjections() override {}
};

}  // namespace

std::optional<std::vector<Point>> Plan(const World& world, const PlanRequest& request) {
  Point goal = request.goal;
  if (!request.flies) goal[2] = request.start[2];
  if (FreeLine(world, request.start, goal, request.clearance, request.flies))
    return std::vector<Point>{request.start, goal};
  if (!Free(world, goal, request.clearance, request.flies)) return std::nullopt;
  ompl::msg::noOutputHandler();
  ompl::RNG::setSeed(static_cast<std::uint_fast32_t>(request.seed % 0x7fffffffU + 1));
  const unsigned dimensions = request.flies ? 3 : 2;
  auto space = std::make_shared<Space>(dimensions);
  ob::RealVectorBounds bounds(dimensions);
  for (unsigned i = 0; i < dimensions; ++i) {
    bounds.setLow(i, std::min({world.low[i], request.start[i], goal[i]}));
    bounds.setHigh(i, std::max({world.high[i], request.start[i], goal[i]}));
  }
  space->setBounds(bounds);
  og::SimpleSetup setup(space);
  const auto point = [&](const ob::State* state) {
    const double* x = state->as<ob::RealVectorStateSpace::StateType>()->values;
    return Point{x[0], x[1], request.flies ? x[2] : request.start[2]};
  };
  setup.setStateValidityChecker([&](const ob::State* state) {
    const Point p = point(state);
    // Where the robot is, it may go on: it may have come a bit too near.
    return Distance(p, request.start) < 0.3 || Free(world, p, request.clearance, request.flies);
  });
  setup.getSpaceInformation()->setStateValidityCheckingResolution(0.05 / space->getMaximumExtent());
  ob::ScopedState<> start(space);
  ob::ScopedState<> end(space);
  for (unsigned i = 0; i < dimensions; ++i) {
    start[i] = request.start[i];
    end[i] = goal[i];
  }
  setup.setStartAndGoalStates(start, end, 0.05);
  auto planner = std::make_shared<og::RRTstar>(setup.getSpaceInformation());
  planner->setRange(1.5);
  planner->setGoalBias(0.1);
  setup.setPlanner(planner);
  setup.setup();
  // Counted, not timed: the same request must give the same path.
  ob::IterationTerminationCondition enough(request.iterations);
  setup.solve(ob::PlannerTerminationCondition(enough));
  if (!setup.haveExactSolutionPath()) return std::nullopt;
  std::vector<Point> path;
  for (const ob::State* state : setup.getSolutionPath().getStates()) path.push_back(point(state));
  path.front() = request.start;
  path.back() = goal;
  // Shorter, where a line is free.
  std::vector<Point> result{path.front()};
  for (size_t i = 0; i + 1 < path.size();) {
    size_t k = path.size() - 1;
    while (k > i + 1 && !FreeLine(world, path[i], path[k], request.clearance, request.flies)) --k;
    result.push_back(path[k]);
    i = k;
  }
  return result;
}

}  // namespace rondo::sim
