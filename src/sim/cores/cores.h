#pragma once

#include <memory>
#include <optional>
#include <queue>
#include <set>
#include <tuple>
#include <vector>

#include "runtime/rounds/core.h"
#include "sim/cores/fault.h"
#include "transport/simulated/clock.h"
#include "transport/simulated/network.h"

/// Runs a fleet of unchanged cores in virtual time: their radio, clocks, disks and lives, and what goes wrong
/// with them.
namespace rondo::sim::cores {

constexpr Time kNever = INT64_MAX;

/// Says what a fleet is, and what goes wrong.
struct Setup {
  runtime::rounds::Settings settings;  ///< of every core; `self` and `incarnation` are set for each life
  bool disks = false;                  ///< robots keep what they store and promise
  uint64_t seed = 1;                   ///< of the network and the clocks
  transport::simulated::Conditions conditions;  ///< while nothing else is wrong
  std::vector<Fault> faults;                    ///< of robots that exist
};

/// Owns the programs of the robots, and receives what their cores say.
class Robots {
 public:
  virtual ~Robots() = default;
  /// Begins a life: returns the robot's program, with the store before `init`. It outlives the `Cores`.
  virtual runtime::rounds::Program& Begin(uint32_t robot) = 0;
  /// Says that a robot is gone, with everything that it had in mind.
  virtual void Crashed(uint32_t robot) = 0;
  /// Says how long an external function of a robot takes from now on.
  virtual void Slows(uint32_t robot, Time delay) = 0;
  /// Receives everything but `Send`, in order.
  virtual void On(uint32_t robot, const runtime::rounds::Output& output) = 0;
};

/// Delivers datagrams, wakes cores, and lets faults begin and end, each at its moment. The same setup gives the
/// same run.
class Cores {
 public:
  /// @param robots  outlives this.
  Cores(const Setup& setup, Robots& robots);

  /// Begins the first life of every robot.
  void Start();
  /// Goes on to the next thing that happens, and lets it happen; returns false, with the time at `until`, if
  /// nothing does before or then. `kNever`: whatever comes next.
  bool Next(Time until);

  const Time& now() const { return now_; }
  /// Returns when the last fault is over.
  Time quiet() const { return quiet_; }
  uint32_t robots() const { return settings_.robots; }
  /// Returns the core of a robot; nullptr while it is gone.
  const runtime::rounds::Core* core(uint32_t robot) const { return lives_[robot].core.get(); }
  uint64_t incarnation(uint32_t robot) const { return lives_[robot].incarnation; }
  /// Returns the moment of virtual time at which a robot's clock says this.
  Time When(uint32_t robot, runtime::rounds::Time local) const { return lives_[robot].clock.When(local); }
  /// Returns what the clock on a robot's wall says. Cores do not have it.
  Time Wall(uint32_t robot) const { return now_ + lives_[robot].ahead; }
  /// Reports whether there was a session of which at some moment nobody and no disk knew any more. What begins
  /// then is another one.
  bool forgotten() const { return forgotten_; }
  uint64_t datagrams() const { return network_.sent(); }
  uint64_t bytes() const { return network_.bytes(); }
  /// Returns a number that tells runs apart by what was sent.
  uint64_t digest() const { return digest_; }
  /// Returns the pairs of phases that some core went through, by `kPhases` * from + to.
  const std::set<uint64_t>& visited() const { return visited_; }
  static constexpr size_t kPhases = 6;

 private:
  class MemoryDisk : public runtime::rounds::Disk {
   public:
    bool Keep(runtime::codec::View bytes) override;
    std::optional<runtime::codec::Bytes> record;
    bool full = false;
    bool fresh = false;  // something was kept since this was last looked at
  };
  struct Life {
    transport::simulated::Clock clock;
    std::unique_ptr<runtime::rounds::Core> core;  // nullptr: it is gone
    MemoryDisk disk;
    uint64_t incarnation = 0;
    Time paused_until = 0;
    Time step = 0;      // how long it needs for each
    Time ahead = 0;     // of its clock on the wall
    uint64_t wake = 0;  // which of the wakes that are under way counts
    int crashes = 0;    // faults that keep it away
    uint64_t kept = 0;  // the epoch of which its disk knows
    runtime::rounds::Phase phase = runtime::rounds::Phase::kOutside;
  };
  enum class What : uint8_t { kArrives, kWakes, kFaultBegins, kFaultEnds };
  struct Event {
    Time at;
    uint64_t order;
    What what;
    uint32_t number;  // of the robot, or of the fault
    uint64_t serial;
    std::shared_ptr<runtime::codec::Bytes> bytes;
    bool operator<(const Event& other) const { return std::tie(at, order) > std::tie(other.at, other.order); }
  };

  void Push(Time at, What what, uint32_t number, uint64_t serial = 0,
            std::shared_ptr<runtime::codec::Bytes> bytes = nullptr);
  void Begin(uint32_t robot);
  void Crash(uint32_t robot);
  bool Known() const;
  void Handle(const Event& event);
  void Step(uint32_t robot, runtime::codec::View datagram);
  void Deliver(uint32_t from, const runtime::rounds::Send& send);
  void Way(uint32_t from, uint32_t to, bool cut);
  void Let(const Fault& fault, bool begins);

  Robots& robots_;
  runtime::rounds::Settings settings_;
  const bool disks_;
  const transport::simulated::Conditions usual_;
  const std::vector<Fault> faults_;
  transport::simulated::Network network_;
  std::vector<Life> lives_;
  std::priority_queue<Event> events_;
  uint64_t order_ = 0;
  Time now_ = 0;
  Time quiet_ = 0;
  bool known_ = false;  // somebody has known of a session
  bool forgotten_ = false;
  uint64_t digest_ = 0;
  runtime::rounds::Outputs outputs_;
  std::vector<transport::simulated::Delivery> deliveries_;
  std::set<uint64_t> visited_;
};

}  // namespace rondo::sim::cores
