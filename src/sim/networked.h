#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "koord/node/slow_calls.h"
#include "sim/cores/cores.h"
#include "sim/functions/functions.h"
#include "sim/monitor.h"
#include "sim/network.h"
#include "sim/simulation.h"

/// Lets the robots of a simulation agree on their rounds over a network, by the cores that robots run.
namespace rondo::sim {

/// Is the world around the robots: what their sensors read, and what comes of what they do.
class Stage {
 public:
  virtual ~Stage() = default;
  /// Puts what a sensor of a robot reads into `words`, the value of the round before.
  virtual void Read(size_t robot, size_t variable, Heap& heap, std::span<Word> words) = 0;
  /// Says that a robot told the others what it does in a round.
  virtual void Contributed(size_t robot) = 0;
  /// Says that a round is final, which no robot knew before. The node has its store.
  virtual void Committed(uint64_t round, const koord::node::Node& node) = 0;
  /// Says that a robot acts on its store: these actuators get what it says.
  virtual void Acts(size_t robot, Heap& heap, const koord::node::Node& node,
                    const std::vector<koord::node::Cell>& commands) = 0;
  /// Says that a robot acts no more: its actuators get what the fallbacks of the program say, and hold where there are
  /// none. `covered`: the former.
  virtual void FallsBack(size_t robot, const koord::node::Node& node,
                         const std::vector<koord::node::Cell>& covered) = 0;
  /// Says what happens to the team, for reports.
  virtual void Happens(int robot, const std::string& what) = 0;
  /// Says that an operation of an event has no value.
  virtual void Fails(size_t robot, const koord::node::Failure& failure) = 0;
};

/// Gives each robot a team, functions, a node and a core of its own, as if each were a machine.
class Networked : cores::Robots {
 public:
  using MakeTeam = std::function<std::unique_ptr<koord::semantics::Team>(Functions& functions)>;
  /// @param make  compiles the program for all robots; it has been compiled before.
  /// @param bodies, stage  outlive this.
  Networked(const koord::Model& model, const Fleet& fleet, const SimulationOptions& options,
            const std::vector<std::unique_ptr<Body>>& bodies, const MakeTeam& make,
            diag::Diagnostics& diagnostics, Stage& stage);

  /// Begins the first life of every robot.
  /// @param store  the one before `init`, as `Node::Save` writes it.
  void Start(runtime::codec::Bytes store);
  /// Lets everything happen up to this moment, in seconds.
  void Until(double time);
  double now() const { return cores::Seconds(cores_.now()); }
  /// Returns what a core found broken; empty if all is well.
  const std::string& broken() const { return broken_; }

  /// Returns what the network did. To be called once, at the end.
  NetworkReport Report();
  /// Returns how many paths the robots planned, and which summaries their functions violated.
  uint64_t plans() const;
  std::vector<Violation> violations() const;

 private:
  // Sensors of one robot.
  class Senses : public koord::node::Sensors {
   public:
    Senses(Stage& stage, Heap& heap) : stage_(stage), heap_(heap) {}
    void Read(size_t robot, uint64_t, koord::node::Cell cell, std::span<Word> words) override {
      stage_.Read(robot, cell.variable, heap_, words);
    }

   private:
    Stage& stage_;
    Heap& heap_;
  };
  struct Machine {
    std::unique_ptr<Functions> functions;
    std::unique_ptr<koord::semantics::Team> team;
    std::unique_ptr<Senses> senses;
    std::unique_ptr<koord::node::Node> node;
    std::unique_ptr<koord::node::SlowCalls> calls;
    std::unique_ptr<Monitor> monitor;  // of summaries
    runtime::rounds::Place contributed;
    cores::Time contributed_at = 0;
    uint64_t acted = 0;  // the last round on which it acted
  };

  static cores::Setup SetupOf(const Fleet& fleet, const SimulationOptions& options);
  runtime::rounds::Program& Begin(uint32_t robot) override;
  void Crashed(uint32_t robot) override;
  void Slows(uint32_t robot, cores::Time delay) override;
  void FallBack(uint32_t robot);
  void Happens(int robot, const std::string& what);
  void On(uint32_t robot, const runtime::rounds::Output& output) override;
  void Do(uint32_t robot, const runtime::rounds::Send& send);
  void Do(uint32_t robot, const runtime::rounds::Contributed& contributed);
  void Do(uint32_t robot, const runtime::rounds::Stored& stored);
  void Do(uint32_t robot, const runtime::rounds::Committed& committed);
  void Do(uint32_t robot, const runtime::rounds::Act& act);
  void Do(uint32_t robot, const runtime::rounds::FallBack& fall_back);
  void Do(uint32_t robot, const runtime::rounds::Adopted& adopted);
  void Do(uint32_t robot, const runtime::rounds::Broken& broken);

  const Fleet& fleet_;
  const SimulationOptions& options_;
  Stage& stage_;
  std::string broken_;
  std::vector<Machine> machines_;
  runtime::codec::Bytes store_;
  cores::Cores cores_;
  uint64_t committed_ = 0;  // the latest round
  uint64_t epoch_ = 0;      // the latest that was told
  NetworkReport report_;
};

}  // namespace rondo::sim
