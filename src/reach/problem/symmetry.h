#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "expr/arena.h"
#include "expr/rational.h"

/// Symmetries of dynamics and contracts: which parameters of a motion cannot matter.
namespace rondo::reach {

using expr::TermId;

/// States what a change of coordinates has to leave as it is.
struct Structure {
  expr::Arena* arena = nullptr;
  /// Is a state or parameter that the change may move; whatever else occurs stays where it is.
  struct Coordinate {
    TermId term;
    size_t kind = 0;         ///< only coordinates of one kind mix: what they measure
    bool parameter = false;  ///< a constant: mixes with parameters only
    bool stays = false;      ///< of a parameter: others may be moved around it, but it is not
  };
  std::vector<Coordinate> coordinates;
  std::vector<std::pair<TermId, TermId>> rates;  ///< (variable, its derivative): must be equivariant
  std::vector<std::pair<TermId, TermId>> jumps;  ///< (variable, its value after an update): equivariant
  std::vector<TermId> invariant;                 ///< terms whose values must not change
};

/// Holds parameters that do not matter, and what moves with them.
struct Removable {
  std::vector<size_t> parameters;  ///< coordinates that may be given any value
  std::vector<size_t> moved;       ///< all coordinates that are moved by that
};

/// Returns the parameters that affine changes of coordinates take to any value while they leave the structure
/// as it is: whatever is shown for one value of them (all at once) holds for each. Translations and turns
/// (yaw) are such changes; which variables they move is found, not told.
///
/// The infinitesimal symmetries g(s) = A s + b satisfy linear equations with rational coefficients: [f, g] =
/// 0 for rates f, g(F(s)) = DF(s) g(s) for updates F, Dh(s) g(s) = 0 for invariant terms h, as polynomials in
/// atoms (sines and cosines are differentiated; arguments of all other functions must be invariant, which is
/// sufficient). Affine fields have flows for all times, so a symmetry with rate 1 of one parameter takes it
/// everywhere. Nothing is rounded.
///
/// @source Olver, Applications of Lie Groups to Differential Equations, Section 2.2-2.4; Sibai et al., TACAS
/// 2020 (reachability up to symmetry).
Removable RemovableParameters(const Structure& structure);

}  // namespace rondo::reach
