#pragma once

#include "runtime/rounds/merge.h"
#include "runtime/rounds/program.h"

namespace rondo::runtime::rounds {

/// Is a program whose store is a number, to which every robot adds its own number plus one in each round.
class Adder : public Program {
 public:
  explicit Adder(uint32_t robot) : robot_(robot) {}

  void Contribute(uint64_t, Bytes& out) override {
    const Bytes effect(foul ? 2 : 1, static_cast<uint8_t>(robot_ + 1));
    Encode(Contribution{{}, {{0, false, effect}}}, out);
  }
  bool Accepts(uint32_t, View, std::span<const Alternative> all) const override {
    return all.empty() || (all.size() == 1 && all[0].effect.size() == 1);
  }
  void Apply(uint64_t, std::span<const Turn> turns) override {
    for (const Turn& turn : turns) sum_ += turn.does == nullptr ? 0 : turn.does->effect[0];
  }
  void Save(Bytes& out) const override { codec::Writer(out).Number(sum_); }
  bool Load(View bytes) override {
    codec::Reader reader(bytes);
    const uint64_t sum = reader.Number();
    if (reader.Complete()) sum_ = sum;
    return reader.Complete();
  }
  uint64_t sum() const { return sum_; }

  bool foul = false;  ///< it contributes what nobody accepts

 private:
  uint32_t robot_;
  uint64_t sum_ = 0;
};

}  // namespace rondo::runtime::rounds
