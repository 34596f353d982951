#include "sim/fleet/fleet.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "lang/suggest.h"
#include "sim/fleet/round_words.h"
#include "sim/fleet/tables.h"

namespace rondo::sim {
namespace {

using diag::Kind;

class Reader : Tables {
 public:
  Reader(const diag::SourceSet& sources, diag::FileId file, diag::Diagnostics& diagnostics)
      : Tables(sources, file, diagnostics), file_(file), diagnostics_(diagnostics) {}

  Fleet Run() {
    const size_t before = diagnostics_.errors();
    const toml::table root = Root();
    if (diagnostics_.errors() != before) return std::move(fleet_);
    Known(root, {"run", "world", "lidar", "map", "planner", "params", "initial", "rounds", "robot"},
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
      Known(*planner, {"clearance", "path_clearance"}, "`planner`");
      fleet_.clearance = Number(*planner, "clearance", fleet_.clearance, 0, 100);
      fleet_.path_clearance = Number(*planner, "path_clearance", fleet_.path_clearance, 0, 1e4);
    }
    if (const auto* params = Table(root, "params")) Values(*params, fleet_.params);
    if (const auto* initial = Table(root, "initial")) Values(*initial, fleet_.initial);
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
    Known(t, {"low", "high", "box", "cylinder"}, "`world`");
    fleet_.world.low = ReadPoint(t, "low", fleet_.world.low, false, {});
    fleet_.world.high = ReadPoint(t, "high", fleet_.world.high, false, {});
    for (size_t i = 0; i < 3; ++i) {
      if (fleet_.world.low[i] > fleet_.world.high[i] && t.get("high") != nullptr)
        Wrong(At(*t.get("high")), "`high` must not be below `low`");
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

  void ReadLidar(const toml::table& t) {
    Known(t, {"range", "beams", "rate", "noise", "resolution"}, "`lidar`");
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

  void Robots(const toml::table& root) {
    std::set<std::string> names;
    ForEach(root, "robot", [&](const toml::table& t) {
      Known(t, {"name", "model", "position", "yaw", "parameters", "count", "columns", "step", "row_step"},
            "a robot");
      FleetRobot robot;
      robot.span = At(t);
      const toml::node* model = t.get("model");
      robot.model = model == nullptr ? "" : model->value<std::string>().value_or("");
      const std::vector<std::string> models = BodyModels();
      if (MakeBody(robot.model) == nullptr) {
        auto& report =
            diagnostics_.Report(Kind::kFleetValue, model == nullptr ? robot.span : At(*model),
                                model == nullptr ? std::string("the robot has no `model`")
                                                 : fmt::format("there is no model `{}`", robot.model));
        const std::string near = lang::Suggest(robot.model, models);
        report.Help(near.empty() ? fmt::format("there are {}", fmt::join(models, ", "))
                                 : fmt::format("did you mean `{}`?", near));
        return;
      }
      robot.position = ReadPoint(t, "position", {}, true, robot.span);
      robot.yaw = Number(t, "yaw", 0, -1000, 1000);
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
      const toml::node* name = t.get("name");
      robot.name = name != nullptr       ? name->value<std::string>().value_or("")
                   : t.contains("count") ? std::string("robot")
                                         : fmt::format("robot{}", fleet_.robots.size());
      const bool good =
          !robot.name.empty() && std::all_of(robot.name.begin(), robot.name.end(),
                                             [](unsigned char c) { return std::isalnum(c) || c == '_'; });
      if (!good) Wrong(name == nullptr ? robot.span : At(*name), "a name has letters, digits and `_`");
      const size_t count = Whole(t, "count", 1);
      const size_t columns = Whole(t, "columns", count);
      const Point step = ReadPoint(t, "step", {1, 0, 0}, false, {});
      const Point row_step = ReadPoint(t, "row_step", {0, 1, 0}, false, {});
      const FleetRobot first = robot;
      for (size_t i = 0; i < count; ++i) {
        robot = first;
        if (t.contains("count")) robot.name = fmt::format("{}{}", first.name, i);
        const size_t column = i % columns;
        const size_t row = i / columns;
        for (size_t k = 0; k < 3; ++k)
          robot.position[k] += static_cast<double>(column) * step[k] + static_cast<double>(row) * row_step[k];
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
  Fleet fleet_;
};

}  // namespace

Fleet ReadFleet(const diag::SourceSet& sources, diag::FileId file, diag::Diagnostics& diagnostics) {
  return Reader(sources, file, diagnostics).Run();
}

}  // namespace rondo::sim
