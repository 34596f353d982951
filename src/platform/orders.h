#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "dds/participant.h"
#include "koord/node/cells.h"
#include "platform/messages.h"
#include "platform/offboard.h"
#include "platform/senses.h"

namespace rondo::platform {

/// Sends what the actuators of one robot are told to topics of ROS 2, on a thread of its own: who gives an order does not wait.
/// Where a robot is driven by velocities, the controller of its model goes to where it is told, fifty times a second, by what
/// the sensors say; without them, and at the end, it stands still.
/// Looks at the clock before each order: none is sent, or goes to the controller, after the time until which it may take effect. What
/// was told in time holds until something else is told. What nobody listened to is sent again when somebody does.
class Orders {
 public:
  /// @param ports  of the program; outlives this, as do the others.
  /// @param senses  of the same robot.
  Orders(const koord::Model& model, const sim::Fleet& fleet, const std::vector<sim::Port>& ports,
         size_t robot, Senses& senses, const Clock& clock);
  Orders(const Orders&) = delete;
  Orders& operator=(const Orders&) = delete;
  ~Orders();

  /// Begins. @error in the words of the library.
  base::Result<bool> Begin(dds::Participant& participant, size_t node);

  /// Says that all orders, this one and those before, may take effect until then.
  void Extend(Time until);
  /// Tells one actuator what its words say; latest wins. `always`: whatever time it is, as for fallbacks.
  void Give(size_t variable, const Heap& heap, const Word* at, bool always);
  /// Tells the robot to stay where it is, whatever time it is, and waits until that is sent, for half a second at most.
  void Stay(const sim::Point& position);

  /// Puts the path that a robot is told by that actuator into `path`; without points, it is to stay. Returns false if the
  /// actuator is none that makes it go somewhere.
  bool PathOf(size_t variable, const Heap& heap, const Word* at, std::vector<sim::Point>& path) const;
  /// Returns what an adapter said last when it could not do what it was told, since the last call; empty: nothing.
  std::string TakeProblem();
  /// Returns how many orders came too late to be sent.
  uint64_t late() const;

 private:
  struct Line {
    const sim::Port* port;
    Topic topic;
    size_t sender;  // the line whose publisher sends it: its own, but of joints of one topic the first
    std::unique_ptr<dds::Publisher> publisher;
    std::unique_ptr<AdaptedActuator> adapted;
    std::vector<sim::Point> path;  // of kPose one point
    Numbers numbers{};             // of others
    bool told = false;             // something; of an autopilot, by a round
    bool due = false;              // to be sent
    bool unheard = false;          // sent, and nobody was there
    bool always = false;           // whatever time it is
    // Only the thread that sends uses what follows.
    std::vector<sim::Point> said;  // as `path`, `numbers`, of what is being sent
    Numbers said_numbers{};
    std::unique_ptr<sim::Body> body;             // its controller, of what is driven
    std::unique_ptr<Offboard> offboard;          // of what is flown by an autopilot
    bool refused = false, refusal_said = false;  // under the lock
    bool ticks() const { return body != nullptr || offboard != nullptr; }
  };
  base::Result<bool> Begin(dds::Participant& participant, size_t node, Line& line);
  void Run();
  void Send(const Line& line);
  // What is so when a line is looked at.
  struct Moment {
    bool fresh;     // there is a new order
    bool ticks;     // the period of the controllers is over
    bool last;      // the robot ends
    bool in_force;  // what was told may take effect
  };
  void Tick(Line& line, const Moment& moment);
  void Drive(Line& line, bool last);
  ros::std_msgs::Header Header() const;

  const koord::Model& model_;
  const sim::Fleet& fleet_;
  const size_t robot_;
  Senses& senses_;
  const Clock& clock_;
  bool ticks_ = false;
  Time ticked_ = 0;
  double period_ = 0;  // of the controllers, now
  std::vector<Line> lines_;
  mutable std::mutex mutex_;
  std::condition_variable changed_, sent_;
  Time until_ = 0;
  uint64_t late_ = 0;
  bool ended_ = false;
  std::thread thread_;
};

}  // namespace rondo::platform
