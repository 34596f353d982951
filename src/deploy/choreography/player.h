#pragma once

#include <deque>
#include <functional>
#include <memory>

#include "deploy/choreography/session_event.h"
#include "platform/motions/state_orders.h"
#include "platform/motions/state_senses.h"
#include "sim/motions/performer.h"
#include "sim/motions/places.h"

namespace rondo::deploy {

/// Says how near to its motions a body has to be. Metres and radians alike.
struct Precision {
  double tolerance = 0.05;  ///< a contract that is missed by more is broken

  double arrival() const { return tolerance / 10; }  ///< of where a motion ends, before the next one begins
  double lost() const { return 5 * tolerance; }      ///< away from where it is to be, a body is beyond help
};

/// Plays the part of one robot with a body that is reached over topics: plans each motion as the simulator does, straight and from rest to
/// rest, by the contract or by the model and its controller; tells the body where to be; and watches by the robot's own sensors
/// whether contracts are kept. Used by one thread.
class Player final : private sim::motions::Audience {
 public:
  /// Receives what the robot does.
  using Say = std::function<void(SessionEvent event)>;

  /// Everything must outlive it.
  /// @param heard  the robots that `senses` hears, the robot itself first.
  Player(const choreo::Cast& cast, choreo::RobotId robot, const Precision& precision, uint64_t seed,
         std::vector<size_t> heard, const platform::StateSenses& senses, platform::StateOrders& orders,
         Say say);

  /// Are what the session runs.
  runtime::sessions::Program& program() { return *performer_; }
  runtime::sessions::Motions& motions() { return *performer_; }

  /// Takes the place where the robot is as the one where it is to be. To be called once, when it is known.
  void Begin();
  /// Looks at the world and moves on. To be called before each step of the session.
  void Step(int64_t now);
  /// Lets the body stay where it is. The motion under way is given up.
  void Stop();

  /// Says what went wrong, for people; empty if nothing did.
  const std::string& trouble() const { return trouble_.empty() ? performer_->problem() : trouble_; }
  uint64_t motions_made() const { return motions_; }
  uint64_t messages() const { return messages_; }
  /// Returns by how much contracts were missed, at most, and which motion missed it.
  double missed() const { return missed_; }
  const std::string& missed_by() const { return missed_by_; }
  double late() const { return late_; }  ///< seconds by which motions took longer than they may, at most
  uint64_t broken() const { return broken_; }  ///< how many motions did not keep theirs

 private:
  void Begins(sim::motions::MotionRun& motion) override;
  void Ends(const sim::motions::MotionRun& motion) override;
  void Takes(choreo::RobotId robot, const runtime::sessions::Expected& message,
             const std::vector<double>& values) override;
  void Sends(choreo::RobotId robot, const runtime::sessions::Step& message) override;
  runtime::sessions::Progress Checked(const sim::motions::MotionRun& motion,
                                      runtime::sessions::Progress progress) override;

  void Watch(sim::motions::Condition& condition, double clock);
  /// Does so for a body that may be a moment behind.
  void WatchLate(sim::motions::Condition& condition, double clock);
  /// Returns how far the body is, by its own sensors, from where it is to be.
  double Away(const std::vector<double>& wanted) const;
  /// Returns how far it is, at least, from where it was to be within the last moments: it may lag.
  double Astray() const;
  void Remember(int64_t now);
  /// Returns which of the moments is the last one before the body was seen.
  size_t Present() const;
  SessionEvent Event(Did did, std::string what) const;

  const choreo::Cast& cast_;
  choreo::RobotId robot_;
  Precision precision_;
  std::vector<size_t> heard_;
  const platform::StateSenses& senses_;
  platform::StateOrders& orders_;
  Say say_;
  std::mt19937_64 random_;
  sim::motions::SceneState wanted_, sensed_;  // of what is not heard: zero
  std::vector<size_t> own_;                   // places of its states
  std::vector<bool> known_;                   // by place: it is heard
  sim::motions::MotionLibrary library_;
  sim::motions::Places places_;
  std::unique_ptr<sim::motions::Performer> performer_;
  /// Is where the body was to be, and when: of the last moments. It is told ahead of time.
  struct Moment {
    int64_t time;
    std::vector<double> wanted;
  };
  std::deque<Moment> moments_;
  int64_t now_ = 0, began_ = 0;
  int64_t seen_ = 0;          // when the body was where sensors say
  bool watched_ = false;      // the contract speaks of what is known alone
  double motion_missed_ = 0;  // of the motion under way
  std::string trouble_;
  uint64_t motions_ = 0, messages_ = 0, broken_ = 0;
  double missed_ = 0, late_ = 0;
  std::string missed_by_;
};

}  // namespace rondo::deploy
