#include "runs/robot_files.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "deploy/keystore.h"
#include "runtime/codec/messages.h"
#include "sim/draw/history.h"

namespace rondo::runs {

namespace fs = std::filesystem;

std::optional<RobotProgram> LoadRobotProgram(const SimulationFiles& files, std::optional<uint64_t> seed,
                                             workspace::Session& session) {
  RobotProgram p;
  p.files = files;
  p.loaded = workspace::LoadKoord({files.program, files.spec, true}, session);
  if (p.loaded == nullptr) return std::nullopt;
  const auto file = workspace::ReadSource(files.fleet, workspace::Wanted::kToml, session);
  if (!file) return std::nullopt;
  p.surroundings = std::make_unique<FleetFiles>(files.fleet, session);
  p.fleet = p.surroundings->Read(*file);
  if (session.diagnostics.has_errors()) return std::nullopt;
  if (p.fleet.robots.size() > runtime::codec::kMostRobots) {
    session.diagnostics.Report(diag::Kind::kFleetValue, {*file, 0, 1},
                               fmt::format("{} robots are more than can agree over a network ({})",
                                           p.fleet.robots.size(), runtime::codec::kMostRobots));
    return std::nullopt;
  }
  sim::SimulationOptions texts;
  KeepTexts(files, session, p.surroundings->contents(), texts);
  p.texts.program_name = texts.program_name;
  p.texts.program = texts.program;
  p.texts.spec = texts.spec;
  p.texts.fleet = texts.fleet;
  p.texts.files = texts.files;
  p.texts.seed = seed.value_or(p.fleet.seed.value_or(1));
  p.texts.network = p.fleet.ros.network;
  for (const sim::FleetRobot& robot : p.fleet.robots) {
    if (!robot.address.empty()) p.texts.network.peers.push_back(robot.address);
  }
  // What a fleet file names lies beside it; libraries that are not there, the loader looks for.
  const fs::path folder = fs::absolute(files.fleet).parent_path();
  if (!p.fleet.ros.keys.empty()) p.keys = (folder / p.fleet.ros.keys).string();
  for (auto& [name, port] : p.fleet.ros.ports) {
    if (port.via == sim::PortVia::kAdapter && fs::exists(folder / port.topic))
      port.topic = (folder / port.topic).string();
  }
  return p;
}

base::Result<dds::Network> NetworkOf(const RobotProgram& program, const std::string& enclave) {
  auto network = dds::WithEnvironment(program.texts.network);
  if (!network.ok()) return network;
  std::string folder = program.keys;
  const char* wanted = std::getenv("ROS_SECURITY_ENABLE");
  if (wanted != nullptr && std::string_view(wanted) == "true") {
    const char* store = std::getenv("ROS_SECURITY_KEYSTORE");
    if (store == nullptr || *store == '\0')
      return base::Error{
          "ROS_SECURITY_ENABLE is `true`, and ROS_SECURITY_KEYSTORE does not say where the keys are"};
    folder = store;
  }
  if (folder.empty()) return network;
  if (network.value().domain > 230)
    return base::Error{fmt::format("domain {} has no security: use one up to 230", network.value().domain)};
  const auto keys = deploy::KeysFor(folder, enclave, program.texts);
  if (!keys.ok()) return keys.error();
  dds::Network with = std::move(network).value();
  with.keys = keys.value();
  return with;
}

std::optional<RobotProgram> LoadRobotProgram(const nlohmann::json& run, workspace::Session& session) {
  RobotProgram p;
  const auto kept = FilesFromJson(run.value("files", nlohmann::json::object()));
  if (!kept) return std::nullopt;
  p.loaded = workspace::LoadKoordTexts(sim::TextOf(run, "program_name"), sim::TextOf(run, "program"),
                                       sim::TextOf(run, "spec"), session);
  if (p.loaded == nullptr) return std::nullopt;
  p.surroundings = std::make_unique<FleetFiles>(*kept, session);
  p.fleet = p.surroundings->Read(session.sources.Add("fleet", sim::TextOf(run, "fleet")));
  if (session.diagnostics.has_errors()) return std::nullopt;
  return p;
}

}  // namespace rondo::runs
