#pragma once

#include <memory>
#include <string>
#include <vector>

#include "program/codec.h"
#include "program/effects.h"

/// Presents a program that was made by `rondo build` to whoever does not know its types: everything goes as bytes, in the form
/// that robots send (`ByteWriter`).
namespace rondo::program {

/// Answers what a program asks, and chooses for `any`.
class CoreHost {
 public:
  virtual ~CoreHost() = default;
  /// Answers question number `function`, counted as `Core::questions` lists them.
  virtual Answer Ask(size_t function, int64_t robot, std::span<const uint8_t> arguments,
                     Bytes& result) noexcept = 0;
  /// Returns a number below `possibilities`.
  virtual uint64_t Pick(uint64_t possibilities) noexcept = 0;
};

/// Is an effect: what `BasicEffect` holds, with its changes as bytes.
struct CoreEffect {
  uint32_t event = 0;
  bool urgent = false, ran = false, locks = false;
  Fault fault = Fault::kNone;
  Place place;
  struct Change {
    uint32_t cell;
    Bytes value;
  };
  std::vector<Change> changes;  ///< by number of the cell
  std::vector<std::string> said;
};

/// Is a program with a state of its team.
///
/// A state is, as bytes: what all robots may write, variable by variable; then for each robot what is its own (cells of arrays with
/// one item for each robot, locals, sensors, actuators), in the order of the program, and whether it has stopped. Arrays go item by
/// item, without their length. Cells are numbered in the same order: variables that are no sensors, item by item, and `stopped`.
class Core {
 public:
  virtual ~Core() = default;
  virtual size_t robots() const = 0;
  virtual size_t events() const = 0;
  /// Returns a number for what it was made of (`koord::native::DigestOf`).
  virtual uint64_t digest() const = 0;
  /// Returns the names of the external functions.
  virtual std::vector<std::string> questions() const = 0;
  /// Takes a state. Returns false, and has none then, if it is none of this program, or a list has no room.
  virtual bool Load(std::span<const uint8_t> state) = 0;
  virtual void Save(Bytes& state) const = 0;
  /// Gives variables their initial values in the state. Returns whether all had one.
  virtual bool Begin(CoreHost& host) = 0;
  /// Return the effects of a robot in the state; those of its `init`; of one event, enabled or not.
  virtual std::vector<CoreEffect> Effects(size_t robot, CoreHost& host) = 0;
  virtual CoreEffect Init(size_t robot, CoreHost& host) = 0;
  virtual CoreEffect RunEvent(size_t robot, size_t event, CoreHost& host) = 0;
  /// Lets a robot fall back: changes its actuators in the state. Returns whether all operations of all fallbacks had values.
  virtual bool FallBack(size_t robot, CoreHost& host) = 0;
  /// Ends the round: `turns` are the robots in order, and their alternatives numbers of the effects that `Effects` returned last.
  struct Wish {
    size_t robot;
    std::vector<size_t> alternatives;
  };
  virtual std::vector<size_t> Merge(const std::vector<Wish>& turns) = 0;
  /// Evaluates the formulas of one kind in the state.
  enum class Kind : uint8_t { kInvariant, kInitially, kFact, kPortFact };
  virtual std::vector<Truth> Holds(Kind kind, CoreHost& host) = 0;
  /// Evaluates the controller assumptions for a robot: whether P holds in the state of the last `Remember`, and Q now.
  virtual void Remember() = 0;
  virtual std::vector<std::pair<Truth, Truth>> Promises(size_t robot, CoreHost& host) = 0;
};

/// Asks a host by bytes.
template <typename Result, typename... Arguments>
Answer AskCore(CoreHost& host, size_t function, int64_t robot, Result& result,
               const Arguments&... arguments) noexcept {
  Bytes bytes, back;
  ByteWriter writer(bytes);
  (writer.Value(arguments), ...);
  const Answer answer = host.Ask(function, robot, bytes, back);
  if (answer != Answer::kValue) return answer;
  ByteReader reader(back);
  reader.Value(result);
  return reader.Complete() ? answer : Answer::kNone;
}

/// Is the core of program `P`. `Asking` is its class `Calls` that asks a `CoreHost`.
template <typename P, typename Asking>
class CoreOf final : public Core {
 public:
  size_t robots() const override { return P::kRobots; }
  size_t events() const override { return P::kEvents.size(); }
  uint64_t digest() const override { return P::kDigest; }
  std::vector<std::string> questions() const override { return Asking::Questions(); }

  bool Load(std::span<const uint8_t> bytes) override {
    ByteReader reader(bytes);
    Each(now_, [&](auto& value) { reader.Value(value); });
    return reader.Complete();
  }
  void Save(Bytes& bytes) const override {
    ByteWriter writer(bytes);
    Each(const_cast<State&>(now_), [&](const auto& value) { writer.Value(value); });
  }

  std::vector<CoreEffect> Effects(size_t robot, CoreHost& host) override {
    Asking calls(host);
    Chooser choice(host);
    const size_t count = P::Effects(SelfOf(robot), calls, &choice, effects_[robot]);
    std::vector<CoreEffect> all;
    for (size_t k = 0; k < count; ++k) all.push_back(Tell(effects_[robot][k], robot));
    return all;
  }
  bool Begin(CoreHost& host) override {
    Asking calls(host);
    return P::Begin(now_.shared, now_.local, now_.in, now_.out, calls, effects_[0][0]);
  }
  CoreEffect Init(size_t robot, CoreHost& host) override {
    Asking calls(host);
    Chooser choice(host);
    P::Init(SelfOf(robot), calls, &choice, effects_[robot][0]);
    return Tell(effects_[robot][0], robot);
  }
  CoreEffect RunEvent(size_t robot, size_t event, CoreHost& host) override {
    Asking calls(host);
    Chooser choice(host);
    P::RunEvent(SelfOf(robot), static_cast<typename P::Event>(event), calls, &choice, effects_[robot][0]);
    return Tell(effects_[robot][0], robot);
  }
  bool FallBack(size_t robot, CoreHost& host) override {
    Asking calls(host);
    bool good = true;
    for (size_t f = 0; f < P::kFallbacks.size(); ++f) {
      P::FallBack(SelfOf(robot), f, calls, effects_[robot][0]);
      good = good && effects_[robot][0].fault == Fault::kNone;
    }
    return good;
  }
  std::vector<size_t> Merge(const std::vector<Wish>& wishes) override {
    std::vector<Turn<P>> turns;
    for (const Wish& wish : wishes) {
      Alternatives& wanted = wanted_[wish.robot];
      for (size_t k = 0; k < wish.alternatives.size(); ++k)
        wanted[k] = effects_[wish.robot][wish.alternatives[k]];
      turns.push_back({wish.robot, std::span(wanted).first(wish.alternatives.size())});
    }
    std::vector<size_t> did(turns.size());
    program::Merge<P>(turns, now_.shared, now_.local, now_.out, did);
    return did;
  }
  std::vector<Truth> Holds(Kind kind, CoreHost& host) override {
    Asking calls(host);
    std::vector<Truth> all;
    const auto add = [&](const auto& formulas) {
      for (const auto& formula : formulas) all.push_back(program::Holds<P>(formula, TeamOf(now_), calls));
    };
    switch (kind) {
      case Kind::kInvariant:
        add(P::kInvariants);
        break;
      case Kind::kInitially:
        add(P::kInitially);
        break;
      case Kind::kFact:
        add(P::kFacts);
        break;
      case Kind::kPortFact:
        add(P::kPortFacts);
        break;
    }
    return all;
  }
  void Remember() override { old_ = now_; }
  std::vector<std::pair<Truth, Truth>> Promises(size_t robot, CoreHost& host) override {
    Asking calls(host);
    std::vector<std::pair<Truth, Truth>> all;
    const auto r = static_cast<int64_t>(robot);
    for (const auto& promise : P::kPromises) {
      all.emplace_back(promise.when.holds == nullptr
                           ? Truth{}
                           : HoldsFor<P>(promise.when, r, TeamOf(old_), TeamOf(old_), calls),
                       HoldsFor<P>(promise.always, r, TeamOf(now_), TeamOf(old_), calls));
    }
    return all;
  }

 private:
  struct State {
    typename P::Shared shared{};
    std::array<typename P::Local, P::kRobots> local{};
    std::array<typename P::In, P::kRobots> in{};
    std::array<typename P::Out, P::kRobots> out{};
  };
  class Chooser final : public Choice {
   public:
    explicit Chooser(CoreHost& host) : host_(host) {}
    uint64_t Pick(uint64_t possibilities) noexcept override { return host_.Pick(possibilities); }

   private:
    CoreHost& host_;
  };

  template <typename Visit>
  static void Each(State& s, const Visit& visit) {
    P::EachShared(s.shared, visit);
    for (size_t r = 0; r < P::kRobots; ++r) P::EachOwn(r, s.shared, s.local[r], s.in[r], s.out[r], visit);
  }
  Self<P> SelfOf(size_t r) {
    return {static_cast<int64_t>(r), now_.shared, now_.local[r], now_.in[r], now_.out[r]};
  }
  static Team<P> TeamOf(const State& s) { return {s.shared, s.local, s.in, s.out}; }

  CoreEffect Tell(typename P::Effect& effect, size_t r) {
    CoreEffect told{static_cast<uint32_t>(effect.event),
                    effect.urgent,
                    effect.ran,
                    effect.locks,
                    effect.fault,
                    effect.place,
                    {},
                    {}};
    P::EachCell(static_cast<int64_t>(r), effect.changes, now_.shared, now_.local[r], now_.out[r],
                [&](size_t cell, const auto& value, const auto&) {
                  if (!effect.wrote[cell]) return;
                  told.changes.push_back({static_cast<uint32_t>(cell), {}});
                  ByteWriter(told.changes.back().value).Value(value);
                });
    for (uint32_t k = 0; k < effect.said.size(); ++k) told.said.emplace_back(effect.said[k]);
    return told;
  }

  using Alternatives = std::array<typename P::Effect, P::kEvents.size() + 1>;  // one for `init` at least

  State now_, old_;
  std::array<Alternatives, P::kRobots> effects_, wanted_;  // by robot
};

/// Counts up when anything above changes.
inline constexpr int kCoreVersion = 1;

}  // namespace rondo::program
