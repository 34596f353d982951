#pragma once

#include <compare>
#include <string>
#include <vector>

#include "choreo/graph/graph.h"
#include "choreo/semantics/ticks.h"

/// Executes choreographies as a whole, to compare with their projections.
namespace rondo::choreo {

/// Runs a choreography as it is written: a mark for each thread goes from node to node. Messages of disjoint
/// robots are not exchanged in order, so that with more than three robots there are runs that it does not
/// have.
class Whole {
 public:
  /// Tells where one thread is, whether it moves, and for how many ticks.
  struct Mark {
    NodeId at;
    bool moving = false;
    int64_t clock = 0;
    friend auto operator<=>(const Mark&, const Mark&) = default;
  };
  /// Holds one mark for each thread that is under way, sorted; threads that wait for others stand at the
  /// join.
  using State = std::vector<Mark>;
  struct Step {
    std::string label;  ///< as that of Team::Step
    State state;
  };

  explicit Whole(const Graph& graph);

  State Start() const { return {Mark{graph_.start, false, 0}}; }
  /// Returns every step that is possible in the state.
  std::vector<Step> Next(const State& state) const;
  /// Reports whether the choreography is at its end.
  bool Ended(const State& state) const;

 private:
  Duration StepOf(const Node& motion) const;
  static State Replace(const State& state, size_t i, const std::vector<NodeId>& by);

  const Graph& graph_;
  Ticks ticks_;
};

}  // namespace rondo::choreo
