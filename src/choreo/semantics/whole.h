#pragma once

#include <compare>
#include <string>
#include <vector>

#include "choreo/graph/graph.h"
#include "choreo/semantics/ticks.h"

namespace rondo::choreo {

/// A choreography that runs as it is written: a mark for each thread goes from node to node. Messages of
/// disjoint robots are not exchanged: with up to three robots there are none.
class Whole {
 public:
  struct Mark {
    NodeId at;
    bool moving = false;
    int64_t clock = 0;
    friend auto operator<=>(const Mark&, const Mark&) = default;
  };
  /// One mark for each thread that is under way, sorted; threads that wait for others stand at the join.
  using State = std::vector<Mark>;
  struct Step {
    std::string label;  ///< as that of Team::Step
    State state;
  };

  explicit Whole(const Graph& graph);

  State Start() const { return {Mark{graph_.start, false, 0}}; }
  std::vector<Step> Next(const State& state) const;
  bool Ended(const State& state) const;

 private:
  Duration StepOf(const Node& motion) const;
  static State Replace(const State& state, size_t i, const std::vector<NodeId>& by);

  const Graph& graph_;
  Ticks ticks_;
};

}  // namespace rondo::choreo
