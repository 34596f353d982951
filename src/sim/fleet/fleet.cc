#include "sim/fleet/fleet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "lang/suggest.h"
#include "ros/names.h"
#include "sim/fleet/round_words.h"
#include "sim/fleet/tables.h"
#include "sim/world/occupancy_map.h"

namespace rondo::sim {
namespace {

using diag::Kind;

class Reader : Tables {
 public:
  Reader(const diag::SourceSet& sources, diag::FileId file, diag::Diagnostics& diagnostics,
         const FleetSurroundings& surroundings)
      : Tables(sources, file, diagnostics),
        file_(file),
        diagnostics_(diagnostics),
        surroundings_(surroundings) {}

  Fleet Run() {
    const size_t before = diagnostics_.errors();
    const toml::table root = Root();
    if (diagnostics_.errors() != before) return std::move(fleet_);
    Known(root,
          {"run", "world", "lidar", "map", "planner", "params", "initial", "rounds", "robot", "ros", "ports",
           "capacities"},
          "a fleet file");
    if (const auto* run = Table(root, "run")) Run(*run);
    if (const auto* world = Table(root, "world")) ReadWorld(*world);
    if (const auto* lidar = Table(root, "lidar")) ReadLidar(*lidar);
    if (const auto* map = Table(root, "map")) {
      Known(*map, {"cell", "range"}, "`map`");
      fleet_.cell = Number(*map, "cell", fleet_.cell, 0.01, 1000);
      fleet_.map_range = Number(*map, "range", fleet_.map_range, 0, 1e4);
    }
    if (const auto* planner = Table(root, "planner")) {
      Known(*planner, {"clearance", "path_clearance", "robots"}, "`planner`");
      fleet_.around_robots = Flag(*planner, "robots", false);
      fleet_.clearance = Number(*planner, "clearance", fleet_.clearance, 0, 100);
      fleet_.path_clearance = Number(*planner, "path_clearance", fleet_.path_clearance, 0, 1e4);
    }
    if (const auto* params = Table(root, "params")) Values(*params, fleet_.params);
    if (const auto* initial = Table(root, "initial")) Values(*initial, fleet_.initial);
    if (const auto* capacities = Table(root, "capacities")) {
      for (const auto& [type, _] : *capacities)
        fleet_.capacities[std::string(type.str())] =
            Whole(*capacities, std::string(type.str()).c_str(), 64, 1, 1e6);
    }
    fleet_.ros = ReadRos(*this, root);
    Robots(root);
    ReadRounds(Table(root, "rounds"));
    return std::move(fleet_);
  }

 private:
  void Run(const toml::table& t) {
    Known(t,
          {"delta", "duration", "step", "monitor", "pose_rate", "skip", "integrator", "policy", "seed",
           "until"},
          "`run`");
    fleet_.delta = Number(t, "delta", fleet_.delta, 1e-4, 1e4);
    fleet_.duration = Number(t, "duration", fleet_.duration, 1e-4, 1e7);
    fleet_.step = Number(t, "step", fleet_.step, 1e-5, 1);
    fleet_.monitor = Number(t, "monitor", fleet_.monitor, 1e-5, 1e4);
    fleet_.pose_rate = Number(t, "pose_rate", fleet_.pose_rate, 0.001, 1000);
    fleet_.skip = Number(t, "skip", fleet_.skip, 0, 1);
    const std::string until = Word(t, "until", "", {"mapped", "stopped"});
    if (until == "mapped") fleet_.until = Until::kMapped;
    if (until == "stopped") fleet_.until = Until::kStopped;
    if (const toml::node* node = t.get("until")) fleet_.until_span = At(*node);
    if (Word(t, "integrator", "rk4", {"rk4", "adaptive"}) == "adaptive")
      fleet_.integrator = Integrator::kAdaptive;
    const std::string policy = Word(t, "policy", "first", {"first", "random", "round_robin"});
    fleet_.policy = policy == "random"        ? Policy::kRandom
                    : policy == "round_robin" ? Policy::kRoundRobin
                                              : Policy::kFirst;
    if (t.contains("seed")) fleet_.seed = static_cast<uint64_t>(Number(t, "seed", 1, 0, 9e15));
  }

  void ReadWorld(const toml::table& t) {
    Known(t, {"low", "high", "box", "cylinder", "map"}, "`world`");
    if (const toml::node* map = t.get("map")) ReadMap(*map);
    fleet_.world.low = ReadPoint(t, "low", fleet_.world.low, false, {});
    fleet_.world.high = ReadPoint(t, "high", fleet_.world.high, false, {});
    for (size_t i = 0; i < 3; ++i) {
      if (fleet_.world.low[i] > fleet_.world.high[i] && t.get("high") != nullptr)
        Wrong(At(*t.get("high")), "`high` must not be below `low`");
    }
    for (const Rectangle& r : walls_) {
      const double floor = fleet_.world.low[2];
      const double ceiling = fleet_.world.high[2];
      fleet_.world.boxes.push_back(
          {{(r.low[0] + r.high[0]) / 2, (r.low[1] + r.high[1]) / 2, (floor + ceiling) / 2},
           {r.high[0] - r.low[0], r.high[1] - r.low[1], ceiling - floor}});
    }
    ForEach(t, "box", [&](const toml::table& box) {
      Known(box, {"centre", "size"}, "a box");
      Box b{ReadPoint(box, "centre", {}, true, At(box)), ReadPoint(box, "size", {}, true, At(box))};
      for (const double x : b.size) {
        if (!(x > 0)) Wrong(At(box), "a box needs a positive size in every direction");
      }
      fleet_.world.boxes.push_back(b);
    });
    ForEach(t, "cylinder", [&](const toml::table& c) {
      Known(c, {"centre", "radius", "height"}, "a cylinder");
      fleet_.world.cylinders.push_back({ReadPoint(c, "centre", {}, true, At(c)),
                                        Number(c, "radius", 0.5, 1e-3, 1e4),
                                        Number(c, "height", 2, 1e-3, 1e4)});
    });
  }

  // Its occupied and unknown cells are obstacles from the floor to the ceiling.
  void ReadMap(const toml::node& node) {
    const auto path = node.value<std::string>();
    if (!path) return Wrong(At(node), "`map` must be the path of a file, as in \"map.yaml\"");
    const auto map = ReadOccupancyMap(*path, surroundings_.read);
    if (!map.ok()) return Wrong(At(node), map.error().message);
    World& world = fleet_.world;
    world.low = {map.value().low[0], map.value().low[1], world.low[2]};
    world.high = {map.value().high[0], map.value().high[1], world.high[2]};
    walls_ = map.value().walls;
  }

  void ReadLidar(const toml::table& t) {
    Known(t, {"range", "beams", "rate", "noise", "resolution", "robots"}, "`lidar`");
    fleet_.lidar.robots = Flag(t, "robots", false);
    fleet_.lidar.range = Number(t, "range", fleet_.lidar.range, 0.01, 1e4);
    fleet_.lidar.beams = static_cast<int>(Number(t, "beams", fleet_.lidar.beams, 1, 100'000));
    fleet_.lidar.rate = Number(t, "rate", fleet_.lidar.rate, 0.01, 1000);
    fleet_.lidar.noise = Number(t, "noise", 0, 0, 100);
    fleet_.lidar.resolution = Number(t, "resolution", 0, 0, 100);
  }

  void Values(const toml::table& t, std::map<std::string, FleetValue>& values) {
    for (const auto& [key, node] : t) values[std::string(key.str())] = {ToJson(node), At(node)};
  }

  // What is not said follows from the length of a round.
  void ReadRounds(const toml::table* t) {
    FleetRounds& rounds = fleet_.rounds;
    rounds.lease = rounds.patience = 5 * fleet_.delta;
    rounds.stop_time = fleet_.delta;
    if (t == nullptr) return;
    Known(*t, {"on_loss", "exchange", "disks", "lease", "stop_time", "patience"}, "`rounds`");
    rounds.on_loss = ReadOnLoss(*this, *t, rounds.on_loss, fleet_.robots.size());
    rounds.exchange = ReadExchange(*this, *t, rounds.exchange);
    rounds.disks = Flag(*t, "disks", false);
    rounds.lease = Number(*t, "lease", rounds.lease, 1e-3, 1e4);
    rounds.stop_time = Number(*t, "stop_time", rounds.stop_time, 0, 1e4);
    rounds.patience = Number(*t, "patience", rounds.patience, 1e-3, 1e4);
    // A frame is answered within its round, and the next one is sent a round later.
    if (rounds.lease < 2 * fleet_.delta)
      Wrong(At(*t),
            fmt::format("`lease` must be at least two rounds ({:.6g} s): it ends within each otherwise",
                        2 * fleet_.delta));
    if (rounds.patience < 2 * fleet_.delta)
      Wrong(At(*t),
            fmt::format("`patience` must be at least two rounds ({:.6g} s): robots are silent between rounds",
                        2 * fleet_.delta));
  }

  // What kind of body it has, where it is put, and its parameters.
  bool ReadModel(const toml::table& t, FleetRobot& robot) {
    const toml::node* model = t.get("model");
    robot.model = model == nullptr ? "" : model->value<std::string>().value_or("");
    const toml::node* from = t.get("from");
    if (from != nullptr) robot.from = from->value<std::string>().value_or("");
    if (from != nullptr && robot.from.empty()) {
      Wrong(At(*from), "`from` must be the path of a file with robot types, as in \"robots.rondo\"");
      return false;
    }
    robot.position = ReadPoint(t, "position", {}, from == nullptr, robot.span);
    robot.yaw = Number(t, "yaw", 0, -1000, 1000);
    if (from != nullptr) {
      if (model == nullptr || robot.model.empty()) {
        Wrong(robot.span, "the robot has no `model`: the name of a robot type in the file");
        return false;
      }
      robot.span = At(*model);
      Numbers(t, "parameters", robot.parameters);
      Numbers(t, "initial", robot.initial);
      if (!surroundings_.model) {
        Wrong(At(*from), "robot types of files cannot be used here");
        return false;
      }
      robot.make = surroundings_.model(robot);
      return static_cast<bool>(robot.make);
    }
    if (const toml::node* initial = t.get("initial"))
      Wrong(At(*initial), "built-in models have no states that can be given: `initial` goes with `from`");
    return ReadBuiltIn(t, model, robot);
  }

  bool ReadBuiltIn(const toml::table& t, const toml::node* model, FleetRobot& robot) {
    const std::vector<std::string> models = BodyModels();
    if (MakeBody(robot.model) == nullptr) {
      auto& report =
          diagnostics_.Report(Kind::kFleetValue, model == nullptr ? robot.span : At(*model),
                              model == nullptr ? std::string("the robot has no `model`")
                                               : fmt::format("there is no model `{}`", robot.model));
      const std::string near = lang::Suggest(robot.model, models);
      report.Help(near.empty() ? fmt::format("there are {}; others need `from = \"FILE.rondo\"`",
                                             fmt::join(models, ", "))
                               : fmt::format("did you mean `{}`?", near));
      return false;
    }
    if (const auto* parameters = Table(t, "parameters")) {
      const auto known = MakeBody(robot.model)->Parameters();
      for (const auto& [key, node] : *parameters) {
        const std::string name(key.str());
        const bool exists =
            std::any_of(known.begin(), known.end(), [&](const auto& p) { return p.name == name; });
        if (!exists) {
          std::vector<std::string> all;
          for (const BodyParameter& p : known) all.emplace_back(p.name);
          diagnostics_
              .Report(Kind::kFleetValue, At(key.source()),
                      fmt::format("model `{}` has no parameter `{}`", robot.model, name))
              .Help(fmt::format("it has {}", fmt::join(all, ", ")));
          continue;
        }
        const bool zero = name == "gains" || name == "dwell";
        robot.parameters[name] = Number(*parameters, name.c_str(), 0, zero ? 0 : 1e-6, 1e6);
      }
    }
    robot.make = [name = robot.model, parameters = robot.parameters] {
      auto body = MakeBody(name);
      for (const auto& [parameter, value] : parameters) body->Set(parameter, value);
      return body;
    };
    return true;
  }

  // Where it is on the network.
  void ReadPlace(const toml::table& t, FleetRobot& robot) {
    for (const auto& [key, text] :
         {std::pair("address", &robot.address), {"namespace", &robot.node_namespace}}) {
      const toml::node* node = t.get(key);
      if (node == nullptr) continue;
      *text = node->value<std::string>().value_or("");
      if (text->empty()) Wrong(At(*node), fmt::format("`{}` must be a text", key));
      if (t.contains("count"))
        Wrong(At(*node), fmt::format("`{}` is of one robot: it does not go with `count`", key));
    }
    std::string& space = robot.node_namespace;
    if (space.starts_with('/')) space.erase(0, 1);
    if (!space.empty() && !ros::IsName(space))
      Wrong(At(*t.get("namespace")), "a namespace has letters, digits, `_` and `/`");
    if (space == "rondo" || space.starts_with("rondo/"))
      Wrong(At(*t.get("namespace")), "the namespace `rondo` is taken: robots agree on rounds there");
  }

  // Where its own odometry begins: where it starts, or at a point.
  std::optional<Origin> ReadOrigin(const toml::table& t, const FleetRobot& robot) {
    const toml::node* node = t.get("origin");
    if (node == nullptr) return std::nullopt;
    if (node->value<std::string>() == "start") return Origin{robot.position, robot.yaw};
    if (!node->is_string()) return Origin{ReadPoint(t, "origin", {}, false, {}), 0};
    Wrong(At(*node), "`origin` must be a point, `[x, y, z]`, or \"start\"");
    return std::nullopt;
  }

  void Numbers(const toml::table& t, const char* table, std::map<std::string, double>& values) {
    const auto* numbers = Table(t, table);
    if (numbers == nullptr) return;
    for (const auto& [key, node] : *numbers) {
      const std::string name(key.str());
      values[name] = Number(*numbers, name.c_str(), 0, -1e9, 1e9);
    }
  }

  void Robots(const toml::table& root) {
    std::set<std::string> names;
    ForEach(root, "robot", [&](const toml::table& t) {
      Known(t,
            {"name", "model", "from", "position", "yaw", "parameters", "initial", "count", "columns", "step",
             "row_step", "address", "namespace", "origin"},
            "a robot");
      FleetRobot robot;
      robot.span = At(t);
      if (!ReadModel(t, robot)) return;
      const toml::node* name = t.get("name");
      robot.name = name != nullptr       ? name->value<std::string>().value_or("")
                   : t.contains("count") ? std::string("robot")
                                         : fmt::format("robot{}", fleet_.robots.size());
      const bool good =
          !robot.name.empty() && std::all_of(robot.name.begin(), robot.name.end(),
                                             [](unsigned char c) { return std::isalnum(c) || c == '_'; });
      if (!good) Wrong(name == nullptr ? robot.span : At(*name), "a name has letters, digits and `_`");
      ReadPlace(t, robot);
      const size_t count = Whole(t, "count", 1);
      const size_t columns = Whole(t, "columns", count);
      const Point step = ReadPoint(t, "step", {1, 0, 0}, false, {});
      const Point row_step = ReadPoint(t, "row_step", {0, 1, 0}, false, {});
      const FleetRobot first = robot;
      for (size_t i = 0; i < count; ++i) {
        robot = first;
        if (t.contains("count")) robot.name = fmt::format("{}{}", first.name, i);
        if (robot.node_namespace.empty()) robot.node_namespace = robot.name;
        const size_t column = i % columns;
        const size_t row = i / columns;
        for (size_t k = 0; k < 3; ++k)
          robot.position[k] += static_cast<double>(column) * step[k] + static_cast<double>(row) * row_step[k];
        robot.origin = ReadOrigin(t, robot);
        if (!names.insert(robot.name).second)
          Wrong(robot.span, fmt::format("there are two robots `{}`", robot.name));
        fleet_.robots.push_back(robot);
      }
    });
    if (fleet_.robots.empty() && !diagnostics_.has_errors())
      diagnostics_.Report(Kind::kFleetValue, {file_, 0, 1}, "the fleet has no robot")
          .Help("add one: `[[robot]]`");
  }

  diag::FileId file_;
  diag::Diagnostics& diagnostics_;
  const FleetSurroundings& surroundings_;
  std::vector<Rectangle> walls_;
  Fleet fleet_;
};

}  // namespace

runtime::rounds::Settings SettingsOf(const Fleet& fleet) {
  const auto nanoseconds = [](double seconds) {
    return static_cast<runtime::rounds::Time>(std::llround(seconds * 1e9));
  };
  runtime::rounds::Settings settings;
  settings.robots = static_cast<uint32_t>(fleet.robots.size());
  settings.on_loss = fleet.rounds.on_loss;
  settings.parts = runtime::rounds::PartsOf(fleet.rounds.exchange);
  settings.delta = nanoseconds(fleet.delta);
  settings.lease = nanoseconds(fleet.rounds.lease);
  settings.stop_time = nanoseconds(fleet.rounds.stop_time);
  settings.patience = nanoseconds(fleet.rounds.patience);
  return settings;
}

Fleet ReadFleet(const diag::SourceSet& sources, diag::FileId file, diag::Diagnostics& diagnostics,
                const FleetSurroundings& surroundings) {
  return Reader(sources, file, diagnostics, surroundings).Run();
}

}  // namespace rondo::sim
