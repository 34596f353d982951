#pragma once

#include <memory>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "koord/semantics/round_execution.h"
#include "sim/functions/functions.h"
#include "sim/monitor.h"
#include "sim/networked.h"
#include "sim/ports.h"
#include "sim/recorder.h"
#include "sim/simulation.h"
#include "sim/touches.h"

/// Carries out simulations; only the sources of the simulator include it.
namespace rondo::sim {

/// Carries out one simulation, from the fleet to the report, in virtual time. In each round the program
/// transition comes first, then the environment's turn of `delta` seconds, in controller periods of `step`
/// seconds. Over a network, rounds come when the robots have agreed on them, while the world goes on.
class Run : Stage {
 public:
  Run(const koord::Model& model, const Fleet& fleet, const SimulationOptions& options, trace::Writer* trace,
      diag::Diagnostics& diagnostics)
      : model_(model),
        fleet_(fleet),
        options_(options),
        diagnostics_(diagnostics),
        recorder_(trace, fleet),
        functions_(model, fleet, options.seed),
        random_(options.seed) {}

  /// Runs the simulation to its end; to be called once.
  SimulationReport Go();

 private:
  // Before the first round.
  bool MakeTeam();
  bool MakeRobots();
  bool Start();
  bool Initialise();
  void Record();

  // A round.
  void Round(uint64_t k);
  std::vector<size_t> Order(uint64_t k);
  uint32_t Choose(std::span<const uint32_t> enabled, uint64_t k, size_t robot);
  void Command(const std::vector<koord::semantics::RoundExecution::Write>& writes, double t);
  void Obey(const Port& port, size_t robot, const Heap& heap, const Word* at, double t);
  void Say(double t, size_t robot, const std::string& text);
  void Fails(size_t robot, const koord::node::Failure& failure, double t);
  std::optional<GridMap> SharedMap() const;
  void After(double t);
  bool AtRest() const;

  // The environment's turn.
  uint32_t At(const Port& port, size_t robot) const;
  void Sense();
  void Sense(const Port& port, size_t robot, Heap& heap, Word* at) const;
  static uint64_t Every(double period, double step);
  void FindPeriods();
  bool Due(uint64_t step) const;
  bool Pass(uint64_t n, double t, double now, bool last);
  void Environment(double t);
  bool Move(uint64_t n, double dt, double t);
  void Scan(double now);
  void WatchModels(double now);

  // Rounds over a network.
  void OverNetwork(double end);
  void Settle(double t);
  void Read(size_t robot, size_t variable, Heap& heap, std::span<Word> words) override;
  void Contributed(size_t robot) override;
  void Committed(uint64_t round, const koord::node::Node& node) override;
  void Acts(size_t robot, Heap& heap, const koord::node::Node& node,
            const std::vector<koord::node::Cell>& commands) override;
  void FallsBack(size_t robot, const koord::node::Node& node,
                 const std::vector<koord::node::Cell>& covered) override;
  void Sets(size_t robot, const koord::node::Node& node, std::span<const Word> values,
            const std::vector<koord::node::Cell>& actuators);
  void Happens(int robot, const std::string& what) override;
  void Fails(size_t robot, const koord::node::Failure& failure) override;

  // The end.
  static std::vector<bool> Reachable(const GridMap& map, const World& world,
                                     const std::vector<Point>& starts);
  void Finish();

  const koord::Model& model_;
  const Fleet& fleet_;
  const SimulationOptions& options_;
  diag::Diagnostics& diagnostics_;
  Recorder recorder_;
  Functions functions_;
  std::unique_ptr<koord::semantics::Team> team_;
  std::vector<Port> ports_;
  std::vector<std::unique_ptr<Body>> bodies_;
  std::vector<std::mt19937_64> noise_;
  std::vector<std::vector<Word>> scans_;  // by robot: of this round
  struct Seen {
    double time;  // seconds
    Point from;
    Rays rays;
  };
  std::vector<std::vector<Seen>> seen_;  // by robot, over a network: since it read them last
  struct Periods {
    double dt = 0;  // of the controllers, in seconds; the others are multiples of it
    uint64_t monitor = 1, pose = 1, scan = 1, touch = 1;
    bool scans = false;
  };
  Periods periods_;
  std::unique_ptr<Touches> touches_;
  std::unique_ptr<Monitor> monitor_;
  std::unique_ptr<Networked> networked_;
  std::unique_ptr<koord::node::Node> store_;            // the last that is final, for the monitor
  std::vector<std::vector<koord::node::Cell>> fallen_;  // by robot: actuators that are not as the store says
  double settled_at_ = -1;                              // seconds; before the first round nothing is
  static constexpr double kNeverQuiet = 1e300;
  double quiet_since_ = kNeverQuiet;  // seconds: no event could run, and nothing moved
  std::mt19937_64 random_;
  std::vector<Word> state_;
  std::vector<Word> settled_;
  std::vector<int8_t> last_map_;
  uint64_t step_ = 0;
  size_t collect_at_ = 2'000'000;
  SimulationReport report_;
};

}  // namespace rondo::sim
