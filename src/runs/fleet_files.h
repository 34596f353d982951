#pragma once

#include <map>
#include <memory>
#include <string>

#include "robot/model/body.h"
#include "sim/fleet/fleet.h"
#include "sim/models/robot_code.h"
#include "workspace/module_files.h"
#include "workspace/session.h"

/// Provides what fleet files refer to: models of robots, and maps.
namespace rondo::runs {

/// Holds the bytes of files by their path, which is relative to the fleet file.
using FileContents = std::map<std::string, std::string>;

/// Reads the files that a fleet names, from the disk or from what a trace kept, and keeps them for traces.
/// Serves one session, which must outlive it.
class FleetFiles {
 public:
  /// @param fleet  the path of the fleet file.
  FleetFiles(const std::string& fleet, workspace::Session& session);
  /// Reads nothing from the disk: `kept` is all that there is.
  FleetFiles(FileContents kept, workspace::Session& session);

  /// Reads a fleet (sim/fleet) with these surroundings. Reports what is wrong.
  sim::Fleet Read(diag::FileId file);
  /// Returns the files that were read.
  const FileContents& contents() const { return contents_; }

 private:
  base::Result<std::string> Bytes(const std::string& path);
  workspace::LoadedModule* Module(const std::string& from, diag::Span span);
  const robot::RobotDef* TypeOf(const workspace::LoadedModule& module, const sim::FleetRobot& robot);
  bool Divide(const robot::RobotDef& type, const sim::FleetRobot& robot, expr::Arena& arena,
              robot::Arguments& of_type, std::map<std::string, double>& of_all);
  bool Knows(const sim::RobotCode& code, const sim::FleetRobot& robot);
  diag::Diagnostic& Wrong(const sim::FleetRobot& robot, std::string message);
  bool StartsInRange(const sim::RobotCode& code, const sim::FleetRobot& robot);
  sim::BodyFactory Model(const sim::FleetRobot& robot);

  workspace::Session& session_;
  std::string folder_;
  bool from_disk_;
  FileContents contents_;
  std::map<std::string, std::unique_ptr<workspace::LoadedModule>> modules_;
  std::map<std::string, sim::BodyFactory> made_;  ///< by model and parameters: a fleet has many of one kind
};

/// Return files as JSON for traces: texts as they are, other bytes in base 64; and read them again. Nothing if
/// the JSON is damaged.
nlohmann::json ToJson(const FileContents& files);
std::optional<FileContents> FilesFromJson(const nlohmann::json& json);

}  // namespace rondo::runs
