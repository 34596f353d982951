#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "dds/network.h"
#include "deploy/robot.h"
#include "koord/check/model.h"
#include "security/rules.h"
#include "sim/fleet/fleet.h"

/// Keys of a fleet, in a folder as `ros2 security` (sros2) makes them: `public`, `private`, and one folder for each enclave.
namespace rondo::deploy {

/// Name the enclaves of what is no robot: the simulated bodies, and who looks after the fleet.
inline constexpr const char* kBodiesEnclave = "/rondo/bodies";
inline constexpr const char* kDoctorEnclave = "/rondo/doctor";
/// Names the enclave of a robot.
std::string EnclaveOf(const sim::FleetRobot& robot);

/// Returns who may say and hear what when this program runs: nobody more than what it needs. Reports what is wrong with the
/// ports.
std::vector<security::Enclave> EnclavesOf(const koord::Model& model, const sim::Fleet& fleet,
                                          const std::string& program_name, diag::Diagnostics& diagnostics);

/// Tells what was made.
struct Keystore {
  bool fresh = false;              ///< nobody had keys in this folder before
  std::vector<std::string> named;  ///< the enclaves that got a key now
};

/// Makes keys for all who have none, and signs what each may do, and the files that they run. The authority is made if there
/// is none. @param texts  of the program, the specification and the fleet.
/// @error if a file cannot be read or written.
base::Result<Keystore> MakeKeystore(const std::string& folder, const std::vector<security::Enclave>& enclaves,
                                    const RobotOptions& texts);

/// Returns the keys of an enclave. @error if there are none, or the owner of the fleet has signed other files than these.
base::Result<dds::Keys> KeysFor(const std::string& folder, const std::string& enclave,
                                const RobotOptions& texts);

}  // namespace rondo::deploy
