#pragma once

#include <algorithm>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "runtime/sessions/session.h"
#include "sim/motions/motion_code.h"

namespace rondo::sim::motions {

/// Says how motions are chosen among those that a contract allows.
enum class Manner : uint8_t {
  kAny,    ///< at random: to find what goes wrong
  kPlain,  ///< straight, from rest to rest, no faster than it has to be: as robots are told to move
};

/// Moves a robot as the contract of a motion allows: by the dynamics and the controller of its model, if it has them;
/// else along some curve that keeps the contract, chosen at random among what it allows: where it ends, how long it takes, by
/// which way. Nothing here is rigorous: what a contract allows and no run shows is not excluded.
class MotionRun {
 public:
  /// Begins a motion in the present state of the scene. Everything must outlive it.
  MotionRun(MotionCode& code, SceneState& scene, std::mt19937_64& random, Manner manner);

  /// Lets time pass until this many seconds after it began, and moves the robot; others stand where they are in the scene.
  void To(double seconds);
  /// Says how long the joint motion that it belongs to lasts at least: before, the robot does not go on by itself.
  void LastAtLeast(double seconds) { ready_ = std::min(over_, std::max(ready_, seconds)); }
  /// Lets the robot be content to go on from now on: somebody of its joint motion has come to an end, so that it may not last.
  void Urge() { ready_ = std::min(ready_, std::max(time_, code_.least)); }
  /// Tells how far it is now.
  runtime::sessions::Progress progress() const;
  /// Returns the next moment, in seconds after it began, at which something of it changes of itself; infinite if none.
  double next() const;
  /// Returns how long a step may be, in seconds, so that what is seen of it is smooth.
  double resolution() const { return resolution_; }
  /// Returns how long ago it began, in seconds.
  double time() const { return time_; }
  MotionCode& code() const { return code_; }
  /// Says why nobody can tell where the robot is: no curve was found that keeps the contract. Empty if all is well.
  const std::string& lost() const { return lost_; }
  /// Says what the controller does not keep of the contract; empty if all is well.
  const std::string& broken() const { return broken_; }

 private:
  double Longest() const;
  void ChooseTimes();
  void ChooseGoal();
  void ChooseWay();
  void ChoosePace();
  std::vector<double> GuessAt(double time) const;
  double Step(Condition& wanted, const std::vector<double>& guess, const std::vector<double>& before);
  bool Follow(double dt, int halvings);
  void Drive(double until);
  void Act();
  void Flow(double dt);
  void Happen();
  std::vector<double> Free() const;
  void SetFree(std::span<const double> values);

  MotionCode& code_;
  SceneState& scene_;
  std::mt19937_64& random_;
  Manner manner_;
  double time_ = 0;
  double over_ = 0;   // when it is over, if nobody ends it before; infinite for ever
  double ready_ = 0;  // when the robot is content to go on
  double resolution_;
  std::vector<double> start_, goal_, swing_, turns_;  // of the free states
  double pace_ = 0;                                   // how uneven it goes
  double samples_ = 0;                                // how often the controller has acted
  std::vector<bool> happened_;                        // by event: its condition held before
  std::string lost_, broken_;
};

}  // namespace rondo::sim::motions
