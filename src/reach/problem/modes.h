#pragma once

#include <vector>

#include "reach/problem/problem.h"

namespace rondo::reach {

/// The values of the discrete states of a problem, as numbers of its arena, in the order of `Modes::states`.
using Mode = std::vector<TermId>;

/// The discrete part of a problem: which states events set, and what the problem is while they have certain
/// values. Changes the arena: one thread at a time.
class Modes {
 public:
  /// @error names a state that events set but that is not discrete.
  static base::Result<Modes> Of(const Problem& problem);

  /// The discrete states, ascending: indices.
  const std::vector<size_t>& states() const { return states_; }
  const Mode& start() const { return start_; }
  /// The term while the discrete states have these values.
  TermId In(const Mode& mode, TermId term) const;
  /// The values after event `e`.
  ///
  /// @error if they are no numbers.
  base::Result<Mode> After(const Mode& mode, size_t e) const;
  /// For people: `phase = 1`.
  std::string ToText(const Mode& mode) const;

 private:
  const Problem* problem_ = nullptr;
  std::vector<size_t> states_;
  Mode start_;
};

}  // namespace rondo::reach
