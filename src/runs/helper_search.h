#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "koord/prove/prove.h"

/// Looks for helper invariants: reasons why an invariant holds that a proof by induction needs.
namespace rondo::runs {

/// Says which program is meant, and how it is proved.
struct HelperRequest {
  std::string name, program, spec;  ///< texts; the specification may be empty
  koord::ProveOptions prove;
  std::chrono::milliseconds budget{30'000};
};

/// Holds what was found.
struct Helpers {
  std::vector<std::string> invariants;  ///< lines for the specification
  bool proved = false;                  ///< with them, every invariant is proved
  std::string why;                      ///< why not, for people
};

/// Looks for invariants that make every invariant of the program provable: clauses of up to three of the program's own
/// predicates (`LiteralsOf`), of one robot or of two, that exclude the counterexample to induction and that are inductive
/// together (Houdini). Every line that it returns is proved with the others, and needed.
///
/// @source Flanagan, Leino: Houdini, an annotation assistant for ESC/Java (FME 2001).
Helpers FindHelpers(const HelperRequest& request, const koord::Report& report);

}  // namespace rondo::runs
