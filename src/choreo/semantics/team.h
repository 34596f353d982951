#pragma once

#include <compare>
#include <optional>
#include <string>
#include <vector>

#include "choreo/semantics/machine.h"
#include "choreo/semantics/ticks.h"

/// Executes the machines of all robots of a choreography in parallel.
namespace rondo::choreo {

/// Runs the machines of several robots together, in ticks (`Ticks`), as a transition system for the searches
/// of search.h.
class Team {
 public:
  /// Tells where one robot is. While it moves, `at` is where it will be, `from` and `edge` tell the motion
  /// that it makes, and `clock` the ticks since it began.
  struct Local {
    size_t at = 0;
    bool moving = false;
    size_t from = 0, edge = 0;
    int64_t clock = 0;
    friend auto operator<=>(const Local&, const Local&) = default;
  };
  using State = std::vector<Local>;
  /// Tells what happens, `0>1:hello` for a message of the first robot to the second one, empty for everything
  /// else, and the state behind it.
  struct Step {
    std::string label;
    State state;
  };

  explicit Team(std::vector<Machine> machines);

  /// Returns the state in which every robot is at its beginning.
  State Start() const { return State(machines_.size()); }
  /// Returns every step that is possible in the state: messages, choices, beginnings of motions, and a tick
  /// in which all robots move on.
  std::vector<Step> Next(const State& state) const;
  /// Reports whether every robot may be at its end.
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
