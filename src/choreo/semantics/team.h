#pragma once

#include <compare>
#include <optional>
#include <string>
#include <vector>

#include "choreo/semantics/machine.h"
#include "choreo/semantics/ticks.h"

namespace rondo::choreo {

/// Robots that run their machines together.
class Team {
 public:
  /// Where one robot is. While it moves, `at` is where it will be, `move` the edge that it came by and
  /// `clock` the ticks since it began.
  struct Local {
    size_t at = 0;
    bool moving = false;
    size_t from = 0, edge = 0;
    int64_t clock = 0;
    friend auto operator<=>(const Local&, const Local&) = default;
  };
  using State = std::vector<Local>;
  /// What happens, `0>1:hello` for a message of the first robot to the second one, empty for everything else.
  struct Step {
    std::string label;
    State state;
  };

  explicit Team(std::vector<Machine> machines);

  State Start() const { return State(machines_.size()); }
  std::vector<Step> Next(const State& state) const;
  /// Has every robot come to an end?
  bool Ended(const State& state) const;

 private:
  const MachineState& At(const Local& l, size_t robot) const { return machines_[robot].states[l.at]; }
  const MachineEdge& MotionOf(const Local& l, size_t robot) const;
  bool MayAct(const Local& l, size_t robot) const;
  static const MachineEdge* FindMove(const MachineState& state);
  static Local Begin(const Local& l, const MachineState& state, const MachineEdge& edge);
  std::optional<size_t> Hear(size_t robot, size_t at, size_t sender, const std::string& label) const;
  void Alone(const State& state, std::vector<Step>& steps) const;
  void BeginTogether(const State& state, std::vector<Step>& steps) const;
  void Messages(const State& state, std::vector<Step>& steps) const;
  void Wait(const State& state, std::vector<Step>& steps) const;

  std::vector<Machine> machines_;
  Ticks ticks_;
};

}  // namespace rondo::choreo
