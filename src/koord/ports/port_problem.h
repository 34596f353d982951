#pragma once

#include <string>
#include <vector>

#include "koord/check/model.h"
#include "robot/dynamics/motion_problem.h"

/// States the controller assumptions of Koord programs as problems of reachability.
namespace rondo::koord {

/// Holds one assumption about the ports of a module (the (P, Q) of the paper, Section 4) as a problem, for
/// the robots that the platform of the module names.
struct PortProblem {
  const AssumeDef* assumption = nullptr;
  std::string name;  ///< as reports call it
  robot::MotionProblem made;
  std::string impossible;  ///< why there is no problem to decide; empty if there is one
  /// Says for which parameters and states a proof counts: `drift = 0.5, 60 <= temperature <= 80`.
  std::vector<std::string> domain;
};

/// Returns a problem for each assumption: for every state of the robot in its declared ranges whose ports
/// satisfy P, every value that the program may have given to actuators, every input and every t in [0,
/// period] (seconds), Q holds, with old(...) at the start of the environment transition. States that no port
/// shows must stay in their declared ranges, since the next round starts there. Parameters have the values
/// that `explore` gives them; without, any that the general assumptions allow, and so has the parameter
/// `loose`, within its bounds.
///
/// @param body  the robot of the platform, in `world`; its terms are in `arena`.
/// @source Koord, Section 4.2 (AAsm), with the hidden state made explicit.
std::vector<PortProblem> PortProblems(const Model& model, const PlatformDef& platform,
                                      const robot::World& world, const robot::Body& body, expr::Arena& arena,
                                      diag::Diagnostics& diagnostics, const robot::Loose* loose = nullptr);

}  // namespace rondo::koord
