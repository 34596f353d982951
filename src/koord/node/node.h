#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "koord/node/cells.h"
#include "koord/node/commands.h"
#include "koord/semantics/program_transition.h"
#include "runtime/rounds/merge.h"

/// Presents Koord programs to the round protocol, run by the machine.
namespace rondo::koord::node {

/// Says what the sensors of one robot read at the start of a round: gives each cell a value.
class Sensors {
 public:
  virtual ~Sensors() = default;
  /// Puts the words of a sensor's cell into `words`, which hold the value of the round before.
  virtual void Read(size_t robot, uint64_t round, Cell cell, std::span<Word> words) = 0;
  /// Reports whether the sensors of a robot can be relied on. While they cannot, it skips, and its sensors stay as they
  /// were for the team; in round 0, in which nobody skips, what they said last counts.
  virtual bool Usable(size_t /*robot*/, uint64_t /*round*/) { return true; }
};

/// Tells what the round did that a node applied last; nothing if its store came from another robot.
struct Applied {
  std::vector<std::optional<uint32_t>> events;  ///< by robot; nothing: it skipped
  std::vector<Cell> written;                    ///< by this robot
  std::vector<std::string> said;                ///< by this robot, to streams
  /// Forgets everything but the memory. `robots`: none, if the store came from another robot.
  void Clear(size_t robots) {
    events.assign(robots, std::nullopt);
    written.clear();
    said.clear();
  }
};

/// Says why an event has no value, and where in the program.
constexpr uint32_t kInit = UINT32_MAX;  ///< stands for `init` where an event is meant
struct Failure {
  uint32_t event;
  semantics::Fault fault;
  diag::Span span;
};

/// Chooses which of these effects of its enabled events a robot would like best; their number: it skips.
using Choose =
    std::function<size_t(uint64_t round, size_t robot, std::span<const semantics::Effect> effects)>;

/// Runs one robot of a program. Round 0 is `init`. Events that cannot be completed are skipped.
///
/// A robot that falls back sets the actuators of modules with a `fallback` itself. What an event that it offered before
/// writes to them is lost; the store of the team has what it set from the next round on that it takes part in (`Commands`).
class Node : public runtime::rounds::Program {
 public:
  /// @param team  compiled for all robots; this node alone uses it.
  /// @param sensors  nullptr: they stay as they are.
  /// @param seed  decides which of several enabled events runs.
  Node(semantics::Team& team, uint32_t robot, Sensors* sensors, uint64_t seed);

  /// Begins again with this state, the one before `init`.
  void Reset(std::span<const Word> state, uint64_t seed);
  void SetSensors(Sensors* sensors) { sensors_ = sensors; }
  /// Sets who chooses; without one, the seed does.
  void SetChoose(Choose choose) { choose_ = std::move(choose); }

  void Contribute(uint64_t round, runtime::codec::Bytes& out) override;
  bool Accepts(uint32_t robot, runtime::codec::View inputs,
               std::span<const runtime::rounds::Alternative> alternatives) const override;
  void Apply(uint64_t round, std::span<const runtime::rounds::Turn> turns) override;
  void Save(runtime::codec::Bytes& out) const override { Save(state_, out); }
  /// Appends some state of the team, such as `real`, in the same way.
  void Save(std::span<const Word> state, runtime::codec::Bytes& out) const;
  bool Load(runtime::codec::View bytes) override;

  /// Runs the fallbacks of the program on what the sensors read now. Returns the actuators that they belong to, with their
  /// values in `real`; those whose fallback has no value hold.
  const std::vector<Cell>& FallBack(uint64_t round);
  /// Says that the robot acts on the store. Returns the actuators that get what it says.
  const std::vector<Cell>& Act() { return commands_.Act(state_); }
  /// Returns the state of the team as this robot sees it: its sensors when it fell back, and its actuators since.
  const std::vector<Word>& real() const { return commands_.real(); }

  const std::vector<Word>& state() const { return state_; }
  const Applied& applied() const { return applied_; }
  /// Returns why the event that the robot would have liked best in this round is left out; nothing if it is not.
  const std::optional<Failure>& failed() const { return failed_; }
  /// Reports whether the robot chose to skip this round, in which it could do something.
  bool skips() const { return skips_; }
  /// Reports whether the robot skips this round because its sensors could not be relied on.
  bool blind() const { return blind_; }
  /// Returns the events that are left out in this round because a function is not finished, or, if the robot is blind,
  /// all.
  const std::vector<uint32_t>& waits() const { return waits_; }
  /// Returns the round of which the robot says, or said last, what it does.
  uint64_t round() const { return round_; }
  const Cells& cells() const { return cells_; }

 private:
  size_t First(uint64_t round, std::span<const semantics::Effect> effects) const;
  void See(uint64_t round);
  void Offer(const semantics::Effect& effect);
  void EncodeEffect(const semantics::Effect& effect, runtime::codec::Bytes& out);
  bool Reads(runtime::codec::View bytes, uint32_t robot, bool inputs, std::span<const Word> before,
             std::vector<Word>* state, std::vector<Cell>* cells = nullptr) const;
  void Collect();

  semantics::Team& team_;
  uint32_t robot_;
  Sensors* sensors_;
  uint64_t seed_;
  Cells cells_;
  semantics::ProgramTransition transition_;
  std::vector<Word> state_;
  Choose choose_;
  struct Offered {
    uint32_t event;
    runtime::codec::Bytes effect;
    std::vector<std::string> said;
  };
  std::vector<Offered> offered_;  // by this robot, in this round: so many of these
  size_t offers_ = 0;
  Applied applied_;
  std::optional<Failure> failed_;
  std::vector<uint32_t> waits_;
  uint64_t round_ = 0;
  bool blind_ = false, skips_ = false;
  Commands commands_;
  size_t collect_at_ = 0;  // words of the heap

  // Kept for their memory.
  std::vector<Word> seen_, before_;
  runtime::codec::Bytes inputs_;
  runtime::rounds::Contribution contribution_;
  std::vector<Cell> touched_;
  mutable std::vector<Word> read_;
};

}  // namespace rondo::koord::node
