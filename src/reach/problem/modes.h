#pragma once

#include <vector>

#include "reach/problem/problem.h"

/// The discrete part of a problem: what events change.
namespace rondo::reach {

/// Holds the values of the discrete states of a problem, as numbers of its arena, in the order of
/// `Modes::states`.
using Mode = std::vector<TermId>;

/// Knows which states events set, and what the problem is while they have certain values. Changes the arena:
/// one thread at a time.
class Modes {
 public:
  /// Finds the discrete states. @error names a state that events set but that is not discrete.
  static base::Result<Modes> Of(const Problem& problem);

  /// Returns the indices of the discrete states, ascending.
  const std::vector<size_t>& states() const { return states_; }
  /// Returns the values at the start.
  const Mode& start() const { return start_; }
  /// Returns the term while the discrete states have these values: they are substituted.
  TermId In(const Mode& mode, TermId term) const;
  /// Returns the values after event `e`.
  ///
  /// @error if they are no numbers.
  base::Result<Mode> After(const Mode& mode, size_t e) const;
  /// Returns the values for people: `phase = 1`.
  std::string ToText(const Mode& mode) const;

 private:
  const Problem* problem_ = nullptr;
  std::vector<size_t> states_;
  Mode start_;
};

}  // namespace rondo::reach
