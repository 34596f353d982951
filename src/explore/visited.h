#pragma once

#include <functional>
#include <span>
#include <vector>

#include "base/crew.h"
#include "explore/candidates.h"
#include "explore/state_table.h"

namespace rondo::explore {

/// Keeps the states that a search has visited, in shares, so that threads add to it at the same time. What it
/// says does not depend on how many there are.
class Visited {
 public:
  /// `compact`: see `StateTable`.
  explicit Visited(bool compact);

  /// Tells of a candidate that had not been visited.
  struct Fresh {
    uint32_t order = 0;  ///< the number of candidates before it, in all lists
    uint32_t source = 0;
    StateId id = kNoState;
    int property = -1;  ///< what `check` said of it
    State state;        ///< in the list
  };
  /// Visits all states of the lists, as if one after the other, and returns those that had not been visited, in
  /// order.
  /// @param parents  the states that they were met from, by the numbers of the sources.
  /// @param check  is called by a member of the crew with each new state.
  std::span<const Fresh> Visit(std::span<const Candidates> lists, std::span<const StateId> parents,
                               const std::function<int(size_t member, State)>& check, base::Crew& crew);

  /// Returns the parent of a state, and whether a state has an id: see `StateTable`.
  StateId Parent(StateId id) const { return tables_[Share(id)].Parent(id); }
  bool Is(State state, StateId id) const { return tables_[Share(id)].Is(state, id); }
  /// Reports whether no more states fit into it.
  bool full() const;
  /// Returns the memory that everything occupies, as allocated.
  size_t bytes() const;
  /// Returns the most memory that everything occupies while the lists are visited.
  size_t BytesAfter(std::span<const Candidates> lists) const;

 private:
  static size_t Share(StateId id) { return id >> 32; }
  void VisitShare(size_t share, size_t member, std::span<const Candidates> lists,
                  std::span<const StateId> parents, const std::function<int(size_t, State)>& check);

  std::vector<StateTable> tables_;         // by share
  std::vector<std::vector<Fresh>> fresh_;  // by share, in order
  std::vector<uint32_t> firsts_;           // by list: the number of candidates in the lists before it
  std::vector<uint32_t> places_;           // by order: 0, or where in `fresh_`: the place, the share, and one
  std::vector<Fresh> in_order_;
};

}  // namespace rondo::explore
