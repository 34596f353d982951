#pragma once

#include <memory>

#include "koord/node/cells.h"
#include "koord/semantics/program_transition.h"
#include "runtime/rounds/program.h"

/// Presents Koord programs to the round protocol, run by the machine.
namespace rondo::koord::node {

/// Says what the sensors of one robot read at the start of a round: gives each cell a value.
class Sensors {
 public:
  virtual ~Sensors() = default;
  /// Puts the words of a sensor's cell into `words`, which hold the value of the round before.
  virtual void Read(size_t robot, uint64_t round, Cell cell, std::span<Word> words) = 0;
};

/// Runs one robot of a program. Round 0 is `init`. Events that cannot be completed are skipped.
class Node : public runtime::rounds::Program {
 public:
  /// @param team  compiled for all robots; this node alone uses it.
  /// @param sensors  nullptr: they stay as they are.
  /// @param seed  decides which of several enabled events runs.
  Node(semantics::Team& team, uint32_t robot, Sensors* sensors, uint64_t seed);

  /// Begins again with this state, the one before `init`.
  void Reset(std::span<const Word> state, uint64_t seed);
  void SetSensors(Sensors* sensors) { sensors_ = sensors; }

  void Contribute(uint64_t round, runtime::codec::Bytes& out) override;
  bool Accepts(uint32_t robot, runtime::codec::View inputs,
               std::span<const runtime::rounds::Alternative> alternatives) const override;
  void Apply(uint64_t round, std::span<const runtime::rounds::Turn> turns) override;
  void Save(runtime::codec::Bytes& out) const override;
  bool Load(runtime::codec::View bytes) override;

  const std::vector<Word>& state() const { return state_; }
  const Cells& cells() const { return cells_; }

 private:
  void EncodeEffect(const semantics::Effect& effect, runtime::codec::Bytes& out) const;
  bool Reads(runtime::codec::View bytes, uint32_t robot, bool inputs, std::vector<Word>* state) const;

  semantics::Team& team_;
  uint32_t robot_;
  Sensors* sensors_;
  uint64_t seed_;
  Cells cells_;
  semantics::ProgramTransition transition_;
  std::vector<Word> state_;
  size_t collect_at_ = 1'000'000;  // words of the heap
};

}  // namespace rondo::koord::node
