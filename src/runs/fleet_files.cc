#include "runs/fleet_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "lang/suggest.h"
#include "robot/dynamics/motion_problem.h"
#include "runs/base64.h"
#include "sim/models/modelled_body.h"

namespace rondo::runs {

namespace fs = std::filesystem;
using diag::Kind;

FleetFiles::FleetFiles(const std::string& fleet, workspace::Session& session)
    : session_(session), folder_(fs::path(fleet).parent_path().string()), from_disk_(true) {}

FleetFiles::FleetFiles(FileContents kept, workspace::Session& session)
    : session_(session), from_disk_(false), contents_(std::move(kept)) {}

sim::Fleet FleetFiles::Read(diag::FileId file) {
  sim::FleetSurroundings surroundings;
  surroundings.read = [this](const std::string& path) { return Bytes(path); };
  surroundings.model = [this](const sim::FleetRobot& robot) { return Model(robot); };
  return sim::ReadFleet(session_.sources, file, session_.diagnostics, surroundings);
}

base::Result<std::string> FleetFiles::Bytes(const std::string& path) {
  const std::string key = fs::path(path).lexically_normal().string();
  if (const auto it = contents_.find(key); it != contents_.end()) return it->second;
  if (!from_disk_) return base::Error{"the trace does not keep it"};
  auto bytes = base::ReadFile((fs::path(folder_) / path).lexically_normal().string());
  if (bytes.ok()) contents_[key] = bytes.value();
  return bytes;
}

// The robot types of a file; nullptr after a report.
workspace::LoadedModule* FleetFiles::Module(const std::string& from, diag::Span span) {
  const std::string path = (fs::path(folder_) / from).lexically_normal().string();
  if (const auto it = modules_.find(path); it != modules_.end()) return it->second.get();
  std::unique_ptr<workspace::LoadedModule>& module = modules_[path];
  if (!workspace::IsModuleFile(path)) {
    session_.diagnostics.Report(
        Kind::kFleetValue, span,
        fmt::format("`{}` is no file with robot types: their names end with `.rondo`", from));
    return nullptr;
  }
  if (const auto bytes = Bytes(from); !bytes.ok()) {
    session_.diagnostics
        .Report(Kind::kFleetValue, span, fmt::format("cannot read `{}`: {}", path, bytes.error().message))
        .Help("paths are relative to the fleet file");
    return nullptr;
  }
  const size_t before = session_.diagnostics.errors();
  const auto disk = std::exchange(session_.read, [this](const std::string& file) {
    return Bytes(folder_.empty() ? file : fs::path(file).lexically_relative(folder_).string());
  });
  auto loaded = workspace::LoadModule({path}, {}, session_);
  session_.read = disk;
  if (loaded->declarations == nullptr || session_.diagnostics.errors() != before) return nullptr;
  module = std::move(loaded);
  return module.get();
}

// Does everything that the fleet decides start where its model says that it is?
bool FleetFiles::StartsInRange(const sim::RobotCode& code, const sim::FleetRobot& robot) {
  for (size_t v = 0; v < code.states + code.memory + code.inputs; ++v) {
    const bool placed = std::ranges::find(code.position, v) != code.position.end() || v == code.heading;
    const bool disturbs = std::ranges::find(code.disturbances, v) != code.disturbances.end();
    const sim::RobotVariable& variable = code.variables[v];
    const auto given = robot.initial.find(variable.name);
    if (given == robot.initial.end() && (placed || disturbs)) continue;
    const double value = given == robot.initial.end() ? 0 : given->second;
    if (value >= variable.low && value <= variable.high) continue;
    session_.diagnostics
        .Report(Kind::kFleetValue, robot.span,
                fmt::format("`{}` starts with {:.6g}, and it is in [{:.6g}, {:.6g}]", variable.name, value,
                            variable.low, variable.high))
        .Help(fmt::format("say with what: `initial = {{ {} = ... }}`, in SI units", variable.name));
    return false;
  }
  return true;
}

// The robot type of a module; nullptr after a report.
const robot::RobotDef* FleetFiles::TypeOf(const workspace::LoadedModule& module,
                                          const sim::FleetRobot& robot) {
  std::vector<std::string> names;
  for (const choreo::Item& item : module.module.items) {
    const auto* def = std::get_if<robot::RobotDef>(&item);
    if (def == nullptr) continue;
    if (def->name.text == robot.model) return def;
    names.push_back(def->name.text);
  }
  const std::string near = lang::Suggest(robot.model, names);
  Wrong(robot, fmt::format("there is no robot type `{}` in `{}`", robot.model, robot.from))
      .Help(near.empty() ? fmt::format("it has {}", fmt::join(names, ", "))
                         : fmt::format("did you mean `{}`?", near));
  return nullptr;
}

// Divides parameters into those of the type, and those that every body has. False after a report.
bool FleetFiles::Divide(const robot::RobotDef& type, const sim::FleetRobot& robot, expr::Arena& arena,
                        robot::Arguments& of_type, std::map<std::string, double>& of_all) {
  const auto common = sim::ModelledBody(std::make_shared<sim::RobotCode>(), {}).Parameters();
  for (const auto& [name, value] : robot.parameters) {
    if (robot::HasParameter(type, name)) {
      robot::Value number =
          robot::Quantity(arena.Number(arena.Real(), expr::Rational::FromDouble(value)), {});
      number.any_dimension = true;
      of_type.emplace(name, std::pair(std::move(number), robot.span));
      continue;
    }
    if (std::ranges::find(common, name, &sim::BodyParameter::name) == common.end()) {
      Wrong(robot, fmt::format("`{}` has no parameter `{}`", robot.model, name));
      return false;
    }
    const double least = name == "dwell" ? 0 : 1e-6;
    if (!(value >= least && value <= 1e6)) {
      Wrong(robot, fmt::format("`{}` must lie between {:g} and 1000000", name, least));
      return false;
    }
    of_all.emplace(name, value);
  }
  return true;
}

// Is everything that the robot is to start with something that its type has?
bool FleetFiles::Knows(const sim::RobotCode& code, const sim::FleetRobot& robot) {
  for (const auto& [name, value] : robot.initial) {
    if (code.Find(name) < code.variables.size()) continue;
    std::vector<std::string> all;
    for (const sim::RobotVariable& v : code.variables) all.push_back(v.name);
    Wrong(robot, fmt::format("`{}` has no state `{}`", robot.model, name))
        .Help(fmt::format("it has {}", fmt::join(all, ", ")));
    return false;
  }
  return true;
}

diag::Diagnostic& FleetFiles::Wrong(const sim::FleetRobot& robot, std::string message) {
  return session_.diagnostics.Report(Kind::kFleetValue, robot.span, std::move(message));
}

sim::BodyFactory FleetFiles::Model(const sim::FleetRobot& robot) {
  std::string key = robot.from + "\n" + robot.model;
  for (const auto* values : {&robot.parameters, &robot.initial}) {
    for (const auto& [name, value] : *values) key += fmt::format("\n{} = {}", name, value);
    key += "\n";
  }
  if (const auto it = made_.find(key); it != made_.end()) return it->second;
  workspace::LoadedModule* module = Module(robot.from, robot.span);
  const robot::RobotDef* type = module == nullptr ? nullptr : TypeOf(*module, robot);
  robot::Arguments of_type;
  std::map<std::string, double> of_all;
  if (type == nullptr || !Divide(*type, robot, module->arena, of_type, of_all)) return {};
  robot::World world;
  const size_t before = session_.diagnostics.errors();
  if (!robot::StandAlone(*type, module->declarations->evaluator(), world, of_type)) {
    Wrong(robot, fmt::format("`{}` has parameters without a value", robot.model))
        .Help("give them in `parameters`");
    return {};
  }
  if (session_.diagnostics.errors() != before) return {};
  auto code = sim::CodeOf(world, world.bodies[0], module->arena);
  if (!code.ok()) {
    Wrong(robot, fmt::format("`{}` cannot be a body: {}", robot.model, code.error().message));
    return {};
  }
  const auto shared = std::make_shared<const sim::RobotCode>(std::move(code).value());
  if (!Knows(*shared, robot) || !StartsInRange(*shared, robot)) return {};
  return made_[key] = [shared, initial = robot.initial, of_all]() -> std::unique_ptr<sim::Body> {
    auto body = std::make_unique<sim::ModelledBody>(shared, initial);
    for (const auto& [name, value] : of_all) body->Set(name, value);
    return body;
  };
}

namespace {

// JSON holds texts that are UTF-8 only.
bool IsText(const std::string& bytes) {
  try {
    static_cast<void>(nlohmann::json(bytes).dump());
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

}  // namespace

nlohmann::json ToJson(const FileContents& files) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [path, bytes] : files) {
    const fs::path extension = fs::path(path).extension();
    const bool text = (extension == ".rondo" || extension == ".yaml") && IsText(bytes);
    json[path] = text ? nlohmann::json{{"text", bytes}} : nlohmann::json{{"base64", ToBase64(bytes)}};
  }
  return json;
}

std::optional<FileContents> FilesFromJson(const nlohmann::json& json) {
  FileContents files;
  if (!json.is_object()) return std::nullopt;
  for (const auto& [path, value] : json.items()) {
    const auto text = value.is_object() ? value.find("text") : value.end();
    const auto coded = value.is_object() ? value.find("base64") : value.end();
    if (value.is_object() && text != value.end() && text->is_string()) {
      files[path] = text->get<std::string>();
    } else if (value.is_object() && coded != value.end() && coded->is_string()) {
      auto bytes = FromBase64(coded->get<std::string>());
      if (!bytes) return std::nullopt;
      files[path] = std::move(*bytes);
    } else {
      return std::nullopt;
    }
  }
  return files;
}

}  // namespace rondo::runs
