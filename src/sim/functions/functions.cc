#include "sim/functions/functions.h"

#include <algorithm>
#include <cmath>

namespace rondo::sim {

using koord::semantics::FromFloat;
using koord::semantics::FromInt;
using koord::semantics::ToFloat;
using koord::semantics::ToInt;
using lang::TypeKind;

namespace {

Point ReadPoint(const Word* w) { return {ToFloat(w[0]), ToFloat(w[1]), ToFloat(w[2])}; }
void WritePoint(const Point& p, Word* w) {
  for (size_t i = 0; i < 3; ++i) w[i] = FromFloat(p[i] + 0.0);
}

}  // namespace

Word EncodeMap(Heap& heap, const GridMap& map) {
  std::vector<Word> words{FromFloat(map.cell), FromInt(map.columns), FromInt(map.rows), FromFloat(map.x0),
                          FromFloat(map.y0)};
  for (size_t i = 0; i < map.cells.size(); i += 8) {
    Word w = 0;
    for (size_t k = i; k < std::min(i + 8, map.cells.size()); ++k)
      w |= static_cast<Word>(static_cast<uint8_t>(map.cells[k])) << (8 * (k - i));
    words.push_back(w);
  }
  return heap.Intern(words);
}

std::optional<GridMap> DecodeMap(const Heap& heap, Word handle) {
  const auto words = heap[handle];
  if (words.size() < 5) return std::nullopt;
  GridMap map{ToFloat(words[0]),
              static_cast<int>(ToInt(words[1])),
              static_cast<int>(ToInt(words[2])),
              ToFloat(words[3]),
              ToFloat(words[4]),
              {}};
  const size_t count = static_cast<size_t>(map.columns) * static_cast<size_t>(map.rows);
  for (size_t i = 0; i < count; ++i)
    map.cells.push_back(static_cast<int8_t>(static_cast<uint8_t>(words[5 + i / 8] >> (8 * (i % 8)))));
  return map;
}

Word EncodeRays(Heap& heap, const Rays& rays) {
  std::vector<Word> words{FromFloat(rays.first), FromFloat(rays.step), FromFloat(rays.range)};
  for (const double d : rays.distances) words.push_back(FromFloat(d));
  return heap.Intern(words);
}

Rays DecodeRays(const Heap& heap, Word handle) {
  const auto words = heap[handle];
  if (words.size() < 3) return {};
  Rays rays{ToFloat(words[0]), ToFloat(words[1]), ToFloat(words[2]), {}};
  for (size_t i = 3; i < words.size(); ++i) rays.distances.push_back(ToFloat(words[i]));
  return rays;
}

Word EncodePath(Heap& heap, const std::vector<Point>& path) {
  std::vector<Word> words(path.size() * 3);
  for (size_t i = 0; i < path.size(); ++i) WritePoint(path[i], words.data() + 3 * i);
  return heap.Intern(words);
}

std::vector<Point> DecodePath(const Heap& heap, Word handle) {
  const auto words = heap[handle];
  std::vector<Point> path;
  for (size_t i = 0; i + 3 <= words.size(); i += 3) path.push_back(ReadPoint(words.data() + i));
  return path;
}

Functions::Functions(const koord::Model& model, const Fleet& fleet, uint64_t seed)
    : model_(model), fleet_(fleet), seed_(seed), path_clearance_(fleet.path_clearance) {
  for (const koord::Function& f : model.functions) known_.push_back(Recognise(f));
}

Functions::Known Functions::Recognise(const koord::Function& f) const {
  const auto& types = model_.types;
  if (!f.external() || !f.declared) return Known::kNone;
  const auto is = [&](TypeKind result, std::initializer_list<TypeKind> parameters) {
    if (!types.Is(f.result, result) || f.parameters.size() != parameters.size()) return false;
    size_t i = 0;
    for (const TypeKind kind : parameters) {
      if (!types.Is(f.parameters[i++], kind)) return false;
    }
    return true;
  };
  const auto point = [&](lang::TypeId t) { return types.Resolve(t) == types.pos(); };
  const auto path = [&](lang::TypeId t) { return types.Is(t, TypeKind::kList) && point(types[t].parts[0]); };
  if (f.port >= 0) {
    if (!path(f.result) || f.parameters.empty() || !point(f.parameters[0])) return Known::kNone;
    if (f.parameters.size() == 1) return Known::kPlanner;
    const bool cells = f.parameters.size() == 2 && types.Is(f.parameters[1], TypeKind::kList) &&
                       types.Is(types[f.parameters[1]].parts[0], TypeKind::kOpaque);
    return cells ? Known::kPlannerWithObstacles : Known::kNone;
  }
  using enum TypeKind;
  if (f.name == "pathIsClear" && f.parameters.size() == 3 && types.Is(f.result, kBool) &&
      path(f.parameters[1]) && types.Is(f.parameters[2], kInt))
    return Known::kPathIsClear;
  if (f.name == "apart" && is(kFloat, {kList, kList}) && path(f.parameters[0]) && path(f.parameters[1]))
    return Known::kApart;
  if (f.name == "away" && is(kFloat, {kRecord, kList}) && point(f.parameters[0]) && path(f.parameters[1]))
    return Known::kAway;
  if (f.name == "merge" && is(kOpaque, {kOpaque, kOpaque})) return Known::kMerge;
  if (f.name == "scanToMap" && is(kOpaque, {kRecord, kOpaque}) && point(f.parameters[0]))
    return Known::kScanToMap;
  if (f.name == "pickFrontierPos" && is(kRecord, {kOpaque, kRecord}) && point(f.result) &&
      point(f.parameters[1]))
    return Known::kPickFrontier;
  if (f.name == "findObs" && is(kList, {kOpaque}) && types.Is(types[f.result].parts[0], kOpaque))
    return Known::kFindObs;
  if (f.name == "right" && is(kBool, {kOpaque})) return Known::kRight;
  if (f.name == "true_scan" && is(kBool, {kRecord, kOpaque}) && point(f.parameters[0]))
    return Known::kTrueScan;
  return Known::kNone;
}

void Functions::Attach(koord::semantics::Team& team, const std::vector<std::unique_ptr<Body>>& bodies) {
  team_ = &team;
  bodies_ = &bodies;
  // A program that has a parameter for it says how far a clear path must be.
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    const koord::Variable& variable = model_.variables[v];
    if (variable.kind == koord::VariableKind::kParam && variable.name == "rho" &&
        model_.types.Is(variable.type, TypeKind::kFloat))
      path_clearance_ = ToFloat(team.machine().params()[team.layout()[v].at]);
  }
}

void Functions::Log(size_t robot, size_t type, std::span<const Word> value) {
  log_.emplace_back(robot, team_->ShowLogged(type, value));
}

bool Functions::Planner(size_t robot, const Point& target, const World& world, std::span<Word> result) {
  const Body& body = *(*bodies_)[robot];
  PlanRequest request;
  request.start = body.position();
  request.goal = target;
  request.clearance = fleet_.clearance;
  request.flies = body.flies();
  request.seed = seed_ * 1'000'003 + plans_++;
  // No way: an empty path, which programs test for.
  const auto path = Plan(world, request);
  result[0] = path ? EncodePath(team_->heap(), *path) : 0;
  return true;
}

bool Functions::Call(size_t f, size_t robot, std::span<const Word> a, std::span<Word> result) {
  if (team_ == nullptr) return false;
  Heap& heap = team_->heap();
  // What was never drawn: nothing is known.
  const auto map = [&](Word handle) {
    auto known = DecodeMap(heap, handle);
    return known ? std::move(*known) : EmptyMap(fleet_.world, fleet_.cell);
  };
  switch (known_[f]) {
    case Known::kNone:
      return false;
    case Known::kPathIsClear: {
      const std::vector<Word> paths(heap[a[0]].begin(), heap[a[0]].end());
      const std::vector<Point> candidate = DecodePath(heap, a[1]);
      bool clear = true;
      for (size_t j = 0; j < paths.size(); ++j) {
        if (ToInt(a[2]) != static_cast<int64_t>(j))
          clear = clear && PathDistance(DecodePath(heap, paths[j]), candidate) > path_clearance_;
      }
      result[0] = clear;
      return true;
    }
    case Known::kApart:
      result[0] = FromFloat(std::min(1e9, PathDistance(DecodePath(heap, a[0]), DecodePath(heap, a[1]))));
      return true;
    case Known::kAway:
      result[0] = FromFloat(std::min(1e9, PathDistance({ReadPoint(a.data())}, DecodePath(heap, a[3]))));
      return true;
    case Known::kMerge:
      if (a[0] == 0 || a[1] == 0) {
        result[0] = a[0] == 0 ? a[1] : a[0];
        return true;
      }
      result[0] = EncodeMap(heap, Merge(map(a[0]), map(a[1])));
      return true;
    case Known::kScanToMap: {
      GridMap drawn = EmptyMap(fleet_.world, fleet_.cell);
      const double range = fleet_.map_range > 0 ? fleet_.map_range : fleet_.lidar.range;
      Draw(drawn, ReadPoint(a.data()), DecodeRays(heap, a[3]), range);
      result[0] = EncodeMap(heap, drawn);
      return true;
    }
    case Known::kPickFrontier: {
      Point target = ReadPoint(a.data() + 1);
      Frontier(map(a[0]), target, target);
      target[2] = ToFloat(a[3]);
      WritePoint(target, result.data());
      return true;
    }
    case Known::kFindObs: {
      // Cells that are not known to be empty, beside cells that are.
      const GridMap grid = map(a[0]);
      std::vector<Word> cells;
      for (int r = 0; r < grid.rows; ++r) {
        for (int c = 0; c < grid.columns; ++c) {
          if (grid.At(c, r) == GridMap::kEmpty) continue;
          bool edge = false;
          for (int dr = -1; dr <= 1; ++dr) {
            for (int dc = -1; dc <= 1; ++dc)
              edge = edge || (grid.Inside(c + dc, r + dr) && grid.At(c + dc, r + dr) == GridMap::kEmpty);
          }
          if (!edge) continue;
          const Point centre = grid.Centre(c, r);
          const Word cell[3] = {FromFloat(centre[0]), FromFloat(centre[1]), FromFloat(grid.cell)};
          cells.push_back(heap.Intern(cell));
        }
      }
      result[0] = heap.Intern(cells);
      return true;
    }
    case Known::kRight: {
      const GridMap grid = map(a[0]);
      bool right = true;
      for (int r = 0; r < grid.rows; ++r) {
        for (int c = 0; c < grid.columns; ++c)
          right = right && (grid.At(c, r) != GridMap::kOccupied || TrulyOccupied(grid, fleet_.world, c, r));
      }
      result[0] = right;
      return true;
    }
    case Known::kTrueScan: {
      // Every ray that ends, ends on an obstacle, within what the scanner may be wrong.
      const Point from = ReadPoint(a.data());
      const Rays rays = DecodeRays(heap, a[3]);
      const double margin = 1e-6 + 5 * fleet_.lidar.noise + fleet_.lidar.resolution;
      bool good = true;
      for (size_t i = 0; i < rays.distances.size(); ++i) {
        if (!std::isfinite(rays.distances[i])) continue;
        const double angle = rays.first + static_cast<double>(i) * rays.step;
        good = good &&
               fleet_.world.DistanceTo({from[0] + rays.distances[i] * std::cos(angle),
                                        from[1] + rays.distances[i] * std::sin(angle), from[2]}) <= margin;
      }
      result[0] = good;
      return true;
    }
    case Known::kPlanner:
      return Planner(robot, ReadPoint(a.data()), fleet_.world, result);
    case Known::kPlannerWithObstacles: {
      World world;
      world.low = fleet_.world.low;
      world.high = fleet_.world.high;
      for (const Word cell : heap[a[3]]) {
        const auto words = heap[cell];
        if (words.size() != 3) continue;
        const double size = ToFloat(words[2]);
        world.boxes.push_back({{ToFloat(words[0]), ToFloat(words[1]), 0}, {size, size, 10}});
      }
      return Planner(robot, ReadPoint(a.data()), world, result);
    }
  }
  return false;
}

}  // namespace rondo::sim
