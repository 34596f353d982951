#pragma once

#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "sim/functions/functions.h"
#include "sim/ports.h"

/// How runs begin, in simulations and on robots.
namespace rondo::sim {

/// Compiles a program for the robots of a fleet, with its parameters. Reports what is wrong, and returns nullptr then.
std::unique_ptr<koord::semantics::Team> TeamOf(const koord::Model& model, const Fleet& fleet,
                                               Functions& functions, diag::Diagnostics& diagnostics);

/// Holds what the state of a team begins with.
struct Beginning {
  const koord::Model& model;
  const Fleet& fleet;
  koord::semantics::Team& team;
  const std::vector<Port>& ports;
  const std::vector<std::unique_ptr<Body>>& bodies;  ///< by robot, where they start
};

/// Returns the state before `init`: what sensors read, what is declared, what the fleet says, what follows from
/// `assume initially`; actuators hold the bodies where they are. Reports what is wrong.
/// @param random  decides where the program allows several values; the team may ask it later, too.
std::optional<std::vector<Word>> StateBeforeInit(const Beginning& from, std::mt19937_64& random,
                                                 diag::Diagnostics& diagnostics);

}  // namespace rondo::sim
