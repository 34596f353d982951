#include "sim/motions/promises.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "expr/numeric.h"
#include "expr/substitute.h"

namespace rondo::sim::motions {

using choreo::Node;
using choreo::NodeId;
using robot::ShapeKind;

namespace {

using Point = std::array<double, 3>;

// One of the ends of a range, or between them.
double Edge(std::mt19937_64& random, double low, double high) {
  const uint64_t how = random() % 3;
  return how == 0 ? low : how == 1 ? high : Between(random, low, high);
}

// A point of a disc, often of its edge.
std::array<double, 2> OfDisc(std::mt19937_64& random, double radius) {
  const double angle = Between(random, 0, 2 * std::numbers::pi);
  const double r = random() % 2 == 0 ? radius : radius * std::sqrt(Between(random, 0, 1));
  return {r * std::cos(angle), r * std::sin(angle)};
}

Point OfBall(std::mt19937_64& random, double radius) {
  const double z = Between(random, -1, 1), angle = Between(random, 0, 2 * std::numbers::pi);
  const double across = radius * std::sqrt(1 - z * z);
  return {across * std::cos(angle), across * std::sin(angle), radius * z};
}

// A point of the part in its own frame, most likely of its surface; nothing for what has no end.
std::optional<Point> SomePoint(const robot::SolidPart& part, std::mt19937_64& random) {
  const std::vector<double>& n = part.sizes;
  switch (part.kind) {
    case ShapeKind::kSphere:
      return OfBall(random, n[0]);
    case ShapeKind::kCylinder: {
      const auto [x, y] = OfDisc(random, n[0]);
      return Point{x, y, Edge(random, n[1], n[2])};
    }
    case ShapeKind::kCapsule: {
      const auto [x, y, z] = OfBall(random, n[0]);
      return Point{x, y, z + Edge(random, n[1], n[2])};
    }
    case ShapeKind::kBox:
      return Point{Edge(random, n[0], n[1]), Edge(random, n[2], n[3]), Edge(random, n[4], n[5])};
    case ShapeKind::kPrism: {
      const size_t corners = (n.size() - 2) / 2, i = random() % corners, j = random() % corners;
      const double share = random() % 2 == 0 ? 0 : Between(random, 0, 1);
      return Point{n[2 + 2 * i] + share * (n[2 + 2 * j] - n[2 + 2 * i]),
                   n[3 + 2 * i] + share * (n[3 + 2 * j] - n[3 + 2 * i]), Edge(random, n[0], n[1])};
    }
    case ShapeKind::kHalfSpace:
    case ShapeKind::kHalfSphere:
    case ShapeKind::kUnion:
    case ShapeKind::kIntersection:
      break;
  }
  return std::nullopt;
}

}  // namespace

Promises::Promises(const choreo::Cast& cast, const SceneState& scene, std::mt19937_64& random)
    : cast_(cast), random_(random), variables_(scene.variables()) {}

Promises::Thread& Promises::ThreadOf(NodeId fork, size_t branch) {
  const auto [it, fresh] = threads_.try_emplace({fork, branch});
  if (!fresh) return it->second;
  expr::Arena& arena = cast_.declarations->evaluator().arena();
  const choreo::ThreadFacts& facts = (*cast_.graph)[fork].facts[branch];
  if (facts.region) {
    std::vector<expr::TermId> variables = variables_;
    for (const expr::TermId t : cast_.graph->world->point) variables.push_back(t);
    auto region = Condition::Of(arena, *facts.region, variables);
    if (region.ok()) it->second.region = std::move(region).value();
  }
  auto guarantee = Condition::Of(arena, facts.guarantee, variables_);
  if (guarantee.ok()) it->second.guarantee = std::move(guarantee).value();
  return it->second;
}

// Points of the footprint, behind which stand the values of the scene.
std::vector<std::vector<double>> Promises::PointsOf(const robot::Solid& footprint, const SceneState& scene) {
  constexpr int kPoints = 8;  // of each part, each time
  std::vector<std::vector<double>> points;
  for (const robot::SolidPart& part : footprint.Standing()) {
    for (int i = 0; i < kPoints; ++i) {
      const auto p = SomePoint(part, random_);
      if (!p) break;
      std::vector<double>& values = points.emplace_back(scene.values());
      for (size_t row = 0; row < 3; ++row) {
        values.push_back(part.frame[9 + row]);
        for (size_t k = 0; k < 3; ++k) values.back() += part.frame[3 * row + k] * (*p)[k];
      }
      if (!std::isfinite(values.back())) points.pop_back();
    }
  }
  return points;
}

// What is wrong if the motion belongs to this thread.
std::set<Wrong> Promises::Broken(NodeId fork, size_t branch, const SceneState& scene,
                                 const std::vector<std::vector<double>>& points) {
  std::set<Wrong> wrong;
  Thread& own = ThreadOf(fork, branch);
  if (own.guarantee && !own.guarantee->Holds(scene.values())) wrong.insert(Wrong::kGuarantee);
  for (size_t other = 0; other < (*cast_.graph)[fork].facts.size(); ++other) {
    auto& region = ThreadOf(fork, other).region;
    if (!region) continue;
    const auto inside = [&](const std::vector<double>& p) {
      return region->Miss(p) < -Condition::kTolerance;
    };
    if (other == branch && !std::ranges::all_of(points, [&](const auto& p) { return region->Holds(p); }))
      wrong.insert(Wrong::kRegion);
    if (other != branch && own.region && std::ranges::any_of(points, inside)) wrong.insert(Wrong::kFork);
  }
  return wrong;
}

void Promises::Look(SceneState& scene, const MotionRun& motion, const Places& places, const Tell& tell) {
  const std::vector<NodeId>& steps = places.StepsOf(choreo::RobotId(motion.code().robot));
  scene.SetClock(motion.time());
  std::vector<std::vector<double>> points;
  if (motion.code().footprint) points = PointsOf(*motion.code().footprint, scene);
  // Something is wrong only if it is, whichever of the steps it is.
  std::optional<std::set<Wrong>> always;
  for (const NodeId step : steps) {
    std::set<Wrong> wrong;
    for (const auto& [fork, branch] : places.ThreadsAround(step))
      wrong.merge(Broken(fork, branch, scene, points));
    if (!always) always = wrong;
    std::erase_if(*always, [&](Wrong w) { return !wrong.contains(w); });
  }
  for (const Wrong w : always.value_or(std::set<Wrong>{})) {
    tell(w, w == Wrong::kRegion
                ? fmt::format("the footprint of `{}` leaves the region of its thread", motion.code().text)
            : w == Wrong::kFork
                ? fmt::format("the footprint of `{}` is in the region of another thread", motion.code().text)
                : fmt::format("while `{}`, its thread does not keep what it guarantees", motion.code().text));
  }
}

void Promises::Look(SceneState& scene, const std::vector<NodeId>& nodes, const std::vector<double>& values,
                    const Tell& tell) {
  const choreo::Graph& graph = *cast_.graph;
  expr::Arena& arena = cast_.declarations->evaluator().arena();
  const expr::Numeric::Point now = scene.Point();
  double when = std::numeric_limits<double>::infinity(), carries = when;
  for (const NodeId id : nodes) {
    const Node& node = graph[id];
    expr::Numeric::Point point = now;
    expr::Substitution bools;
    double other = 0;  // by how much known values are others
    size_t at = 0;
    for (size_t i = 0; i < node.payload.size(); ++i) {
      const auto expected = choreo::ValuesOf(arena, {node.payload[i]}, now);
      for (size_t k = 0; k < node.payload[i].terms.size() && at < values.size(); ++k, ++at) {
        const expr::TermId t = node.payload[i].terms[k];
        if (node.names[i].empty()) {
          if (expected) other = std::max(other, std::abs((*expected)[k] - values[at]));
        } else if (arena.sort_of(t) == arena.Bool()) {
          bools.emplace(t, arena.Constant(values[at] != 0));
        } else {
          point.insert_or_assign(t, values[at]);
        }
      }
    }
    expr::Numeric numeric(arena, point);
    when = std::min(when, numeric.Violation(node.when));
    carries = std::min(carries,
                       std::max(other, numeric.Violation(expr::Substitute(arena, node.refinement, bools))));
  }
  if (nodes.empty()) return;
  const Node& node = graph[nodes[0]];
  const std::string message =
      fmt::format("`{}` from `{}` to `{}`", node.label, graph.NameOf(node.from), graph.NameOf(node.to));
  if (when > Condition::kTolerance)
    tell(Wrong::kMessage, fmt::format("the guard of {} does not hold", message));
  if (carries > Condition::kTolerance || expr::Numeric::OnEdge(carries))
    tell(Wrong::kMessage, fmt::format("{} does not carry what the choreography says", message));
}

}  // namespace rondo::sim::motions
