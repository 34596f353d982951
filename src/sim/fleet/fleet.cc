#include "sim/fleet/fleet.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <cmath>
#include <set>

#include "lang/suggest.h"

namespace rondo::sim {
namespace {

using diag::Kind;
using diag::Span;
using nlohmann::json;

class Reader {
 public:
  Reader(const diag::SourceSet& sources, diag::FileId file, diag::Diagnostics& diagnostics)
      : sources_(sources), file_(file), diagnostics_(diagnostics) {}

  Fleet Run() {
    toml::table root;
    try {
      root = toml::parse(sources_.text(file_), sources_.path(file_));
    } catch (const toml::parse_error& error) {
      diagnostics_.Report(Kind::kFleetSyntax, At(error.source()),
                          fmt::format("this is not TOML: {}", error.description()));
      return fleet_;
    }
    Known(root, {"run", "world", "lidar", "map", "planner", "params", "initial", "robot"}, "a fleet file");
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
    return std::move(fleet_);
  }

 private:
  static constexpr const char* kLost = "this number is too large or too small to be read";

  Span At(const toml::source_region& region) const {
    // Lines and columns count from 1; a column is a code point.
    uint32_t line = std::max<uint32_t>(1, region.begin.line);
    const std::string_view text = sources_.text(file_);
    uint32_t begin = 0;
    for (; line > 1 && begin < text.size(); ++begin) line -= text[begin] == '\n' ? 1 : 0;
    for (uint32_t column = 1; column < region.begin.column && begin < text.size(); ++column) {
      ++begin;
      while (begin < text.size() && (static_cast<unsigned char>(text[begin]) & 0xC0U) == 0x80U) ++begin;
    }
    uint32_t end = begin;
    while (end < text.size() && text[end] != '\n' && text[end] != '#' && text[end] != ',' && end < begin + 60)
      ++end;
    while (end > begin + 1 && std::isspace(static_cast<unsigned char>(text[end - 1]))) --end;
    return {file_, begin, std::max(end, begin + 1)};
  }
  Span At(const toml::node& node) const { return At(node.source()); }

  // A number that is not zero and has become zero, or infinite.
  bool Lost(const toml::node& node) {
    if (!node.is_floating_point()) return false;
    const double value = node.value<double>().value_or(0);
    if (std::isnormal(value)) return false;
    const Span span = At(node);
    const std::string_view text =
        std::string_view(sources_.text(file_)).substr(span.begin, span.end - span.begin);
    return text.substr(0, text.find_first_of("eE")).find_first_of("123456789") != std::string_view::npos;
  }

  void Wrong(Span span, std::string message) {
    diagnostics_.Report(Kind::kFleetValue, span, std::move(message));
  }

  void Known(const toml::table& table, std::initializer_list<const char*> keys, const char* what) {
    for (const auto& [key, node] : table) {
      if (std::any_of(keys.begin(), keys.end(), [&](const char* k) { return key.str() == k; })) continue;
      auto& report = diagnostics_.Report(Kind::kFleetValue, At(key.source()),
                                         fmt::format("{} has no `{}`", what, key.str()));
      const std::vector<std::string> all(keys.begin(), keys.end());
      const std::string near = lang::Suggest(key.str(), all);
      report.Help(near.empty() ? fmt::format("it may have {}", fmt::join(all, ", "))
                               : fmt::format("did you mean `{}`?", near));
    }
  }

  const toml::table* Table(const toml::table& parent, const char* name) {
    const toml::node* node = parent.get(name);
    if (node == nullptr) return nullptr;
    if (node->as_table() == nullptr)
      Wrong(At(*node), fmt::format("`{}` must be a table: `[{}]`", name, name));
    return node->as_table();
  }

  double Number(const toml::table& table, const char* name, double usual, double low, double high) {
    const toml::node* node = table.get(name);
    if (node == nullptr) return usual;
    const auto value = node->value<double>();
    if (Lost(*node)) {
      Wrong(At(*node), kLost);
    } else if (!value || node->is_boolean() || !std::isfinite(*value)) {
      Wrong(At(*node), fmt::format("`{}` must be a number", name));
    } else if (*value < low || *value > high) {
      Wrong(At(*node), fmt::format("`{}` must lie between {} and {}", name, low, high));
    } else {
      return *value;
    }
    return usual;
  }

  size_t Whole(const toml::table& table, const char* name, size_t usual) {
    const double value = Number(table, name, static_cast<double>(usual), 1, 100'000);
    if (value != std::floor(value))
      Wrong(At(*table.get(name)), fmt::format("`{}` must be a whole number", name));
    return static_cast<size_t>(value);
  }

  std::string Word(const toml::table& table, const char* name, const std::string& usual,
                   std::initializer_list<const char*> choices) {
    const toml::node* node = table.get(name);
    if (node == nullptr) return usual;
    const auto value = node->value<std::string>();
    const bool known =
        value && std::any_of(choices.begin(), choices.end(), [&](const char* c) { return *value == c; });
    if (known) return *value;
    auto& report =
        diagnostics_.Report(Kind::kFleetValue, At(*node), fmt::format("`{}` cannot be this", name));
    report.Help(fmt::format("it can be {}", fmt::join(choices, ", ")));
    return usual;
  }

  Point ReadPoint(const toml::table& table, const char* name, const Point& usual, bool needed, Span where) {
    const toml::node* node = table.get(name);
    if (node == nullptr) {
      if (needed) Wrong(where, fmt::format("`{}` is missing", name));
      return usual;
    }
    const toml::array* array = node->as_array();
    Point point{};
    if (array == nullptr || array->size() != 3) {
      Wrong(At(*node), fmt::format("`{}` must be three numbers: `[x, y, z]`", name));
      return usual;
    }
    for (size_t i = 0; i < 3; ++i) {
      const auto value = (*array)[i].value<double>();
      if (Lost((*array)[i])) {
        Wrong(At((*array)[i]), kLost);
        return usual;
      }
      if (!value || !std::isfinite(*value) || std::fabs(*value) > 1e6) {
        Wrong(At((*array)[i]), fmt::format("`{}` needs numbers below a million", name));
        return usual;
      }
      point[i] = *value;
    }
    return point;
  }

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

  void ForEach(const toml::table& t, const char* name, const std::function<void(const toml::table&)>& visit) {
    const toml::node* node = t.get(name);
    if (node == nullptr) return;
    const toml::array* array = node->as_array();
    if (array == nullptr) return Wrong(At(*node), fmt::format("write `[[{}]]` for each", name));
    for (const toml::node& item : *array) {
      if (item.as_table() == nullptr)
        Wrong(At(item), fmt::format("write `[[{}]]` for each", name));
      else
        visit(*item.as_table());
    }
  }

  json ToJson(const toml::node& node) {
    if (const auto* table = node.as_table()) {
      json object = json::object();
      for (const auto& [key, value] : *table) object[std::string(key.str())] = ToJson(value);
      return object;
    }
    if (const auto* array = node.as_array()) {
      json list = json::array();
      for (const toml::node& value : *array) list.push_back(ToJson(value));
      return list;
    }
    if (node.is_boolean()) return node.value<bool>().value();
    if (node.is_integer()) return node.value<int64_t>().value();
    if (Lost(node)) Wrong(At(node), kLost);
    if (node.is_floating_point()) return node.value<double>().value();
    if (node.is_string()) return node.value<std::string>().value();
    return nullptr;
  }

  void Values(const toml::table& t, std::map<std::string, FleetValue>& values) {
    for (const auto& [key, node] : t) values[std::string(key.str())] = {ToJson(node), At(node)};
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

  const diag::SourceSet& sources_;
  diag::FileId file_;
  diag::Diagnostics& diagnostics_;
  Fleet fleet_;
};

}  // namespace

Fleet ReadFleet(const diag::SourceSet& sources, diag::FileId file, diag::Diagnostics& diagnostics) {
  return Reader(sources, file, diagnostics).Run();
}

}  // namespace rondo::sim
