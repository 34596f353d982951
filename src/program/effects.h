#pragma once

#include <bitset>
#include <span>
#include <utility>

#include "program/step.h"

/// Runs the events of a program that was made by `rondo build`, and makes one round of what all robots do.
///
/// `P` is the class `Program` that such a program defines. Nothing here takes memory or throws.
namespace rondo::program {

/// Holds what one enabled event of one robot does, in terms of the values at the start of the round.
template <typename EventType, size_t kCells, typename Changes, typename Said>
struct BasicEffect {
  EventType event{};
  bool urgent = false;
  bool ran = false;            ///< not, if its guard has no value
  bool locks = false;          ///< it takes the lock of its event (`atomic`)
  Fault fault = Fault::kNone;  ///< why it cannot be completed; then nothing below counts
  Place place;                 ///< where that is
  std::bitset<kCells> wrote;   ///< the variables, and the items of arrays, that it writes
  std::bitset<kCells> apart;   ///< those of them that the state never had
  Changes changes;             ///< their new values
  Said said;                   ///< what it writes to streams
};

/// Holds the state of the whole team.
template <typename P>
struct Team {
  const typename P::Shared& shared;
  std::span<const typename P::Local> local;  ///< by robot, and so are the next two
  std::span<const typename P::In> in;
  std::span<const typename P::Out> out;
};

/// Is what events and formulas read: the state of the team as a robot sees it. Events see no other robot's `local`, `in` and
/// `out`.
template <typename P>
struct View {
  const typename P::Shared& shared;
  const typename P::Local& me;
  const typename P::In& in;
  const typename P::Out& out;
  typename P::Calls& calls;
  std::span<const typename P::Local> locals;
  std::span<const typename P::In> ins;
  std::span<const typename P::Out> outs;
};

/// Gives events what they may write, and keeps what was there, so that it can be put back.
template <typename P>
struct Writing {
  typename P::Shared& shared;
  typename P::Local& me;
  typename P::Out& out;
  typename P::Effect& effect;

  int64_t pid;

  /// Returns the variable or item `now`, to write to.
  template <typename T>
  T& Keep(size_t cell, T& kept, T& now) noexcept {
    if (!effect.wrote[cell]) {
      effect.wrote.set(cell);
      kept = now;
    }
    return now;
  }
  /// Returns where the new value of a variable waits that the event only writes.
  template <typename T>
  T& New(size_t cell, T& value) noexcept {
    effect.wrote.set(cell);
    effect.apart.set(cell);
    return value;
  }
  /// Returns an array `kDepth` levels deep, all of whose items count as written.
  template <int kDepth, typename T>
  T& KeepAll(size_t cell, T& kept, T& now) noexcept {
    for (size_t k = 0; k < Step::Count<kDepth>(now); ++k)
      Keep(cell + k, Step::Nested<kDepth>(kept, k), Step::Nested<kDepth>(now, k));
    return now;
  }
  /// Returns the item of such an array that `index` counts over `kLevels` of its levels; an array if there are more.
  template <int kLevels, int kDepth, typename T>
  auto& KeepItem(Step& r, size_t cell, T& kept, T& now, int64_t index, Place at) noexcept {
    using Item = std::remove_cvref_t<decltype(Step::Nested<kLevels>(now, 0))>;
    if (index < 0 || static_cast<uint64_t>(index) >= Step::Count<kLevels>(now)) {
      r.Undefined(Fault::kIndex, at);
      return Step::Nowhere<Item>();
    }
    const auto k = static_cast<size_t>(index);
    if constexpr (kLevels == kDepth) {
      return Keep(cell + k, Step::Nested<kLevels>(kept, k), Step::Nested<kLevels>(now, k));
    } else {
      return KeepAll<kDepth - kLevels>(cell + k * (Step::Count<kDepth>(now) / Step::Count<kLevels>(now)),
                                       Step::Nested<kLevels>(kept, k), Step::Nested<kLevels>(now, k));
    }
  }
  /// Ends what the robot does: it takes part in no round any more.
  void Stop() noexcept { New(P::kStopped, effect.changes.stopped) = true; }
};

/// Is one event of a program, in functions.
template <typename P>
struct EventCode {
  const char* name;
  bool urgent;
  bool (*guard)(Step&, const View<P>&);  ///< nullptr: it is always enabled
  void (*body)(Step&, const View<P>&, typename P::To&);
};

/// Is a robot's own part of the state of a team.
template <typename P>
struct Self {
  int64_t robot;
  typename P::Shared& shared;
  typename P::Local& local;
  const typename P::In& in;
  typename P::Out& out;
};

namespace detail {

template <typename P>
View<P> ViewOf(const Self<P>& self, typename P::Calls& calls) noexcept {
  return {self.shared, self.local, self.in, self.out, calls, {&self.local, 1}, {&self.in, 1}, {&self.out, 1}};
}

template <typename P>
void Clear(typename P::Effect& effect, typename P::Event event, bool urgent) noexcept {
  effect.event = event;
  effect.urgent = urgent;
  effect.ran = effect.locks = false;
  effect.fault = Fault::kNone;
  effect.place = {};
  effect.wrote.reset();
  effect.apart.reset();
  effect.said.Clear();
}

template <typename P>
void Note(const Step& step, typename P::Effect& effect) noexcept {
  if (effect.fault != Fault::kNone || !step.failed()) return;
  effect.fault = step.fault();
  effect.place = step.place();
}

// Gives the effect what was written, and the state what was there before.
template <typename P>
void Exchange(const Self<P>& self, typename P::Effect& effect) noexcept {
  const auto kept_here = effect.wrote & ~effect.apart;
  if (kept_here.none()) return;
  P::EachCell(self.robot, effect.changes, self.shared, self.local, self.out,
              [&](size_t cell, auto& kept, auto& now) {
                if (!kept_here[cell]) return;
                using std::swap;
                swap(kept, now);
              });
}

template <typename P>
void Run(const Self<P>& self, const View<P>& view, void (*body)(Step&, const View<P>&, typename P::To&),
         Choice* choice, typename P::Effect& effect) noexcept {
  Step step(self.robot, false, choice);
  effect.ran = true;
  typename P::To to{{self.shared, self.local, self.out, effect, self.robot}};
  body(step, view, to);
  Note<P>(step, effect);
}

}  // namespace detail

/// Finds what a robot can do in this round: runs each enabled event (rules SelectEvent, EventTrans), or, if one of them is urgent,
/// each of those. Everything is as before when it returns.
/// @param calls   answers calls of external functions
/// @param choice  chooses for `any`; nullptr: the first value
/// @param effects  has room for as many as there are events
/// @return how many there are. An event whose guard has no value is among them, with its fault.
template <typename P>
size_t Effects(const Self<P>& self, typename P::Calls& calls, Choice* choice,
               std::span<typename P::Effect> effects) noexcept {
  if (self.local.stopped) return 0;
  const View<P> view = detail::ViewOf<P>(self, calls);
  size_t count = 0;
  bool urgent = false;
  const auto look = [&](const EventCode<P>& event, size_t number) {
    if ((urgent && !event.urgent) || count == effects.size()) return;
    Step guard(self.robot);
    if (event.guard != nullptr && !event.guard(guard, view) && !guard.failed()) return;
    // An urgent event excludes those that are not.
    if (event.urgent && !urgent) count = 0;
    urgent = event.urgent;
    typename P::Effect& effect = effects[count++];
    detail::Clear<P>(effect, static_cast<typename P::Event>(number), event.urgent);
    detail::Note<P>(guard, effect);
    if (guard.failed()) return;
    detail::Run<P>(self, view, event.body, choice, effect);
    detail::Exchange<P>(self, effect);
  };
  // One after the other, so that compilers see each event by itself.
  [&]<size_t... kNumbers>(std::index_sequence<kNumbers...>) {
    (look(P::kEvents[kNumbers], kNumbers), ...);
  }(std::make_index_sequence<P::kEvents.size()>());
  return count;
}

/// Runs the body of one event, be it enabled or not.
template <typename P>
void RunEvent(const Self<P>& self, size_t event, typename P::Calls& calls, Choice* choice,
              typename P::Effect& effect) noexcept {
  detail::Clear<P>(effect, static_cast<typename P::Event>(event), P::kEvents[event].urgent);
  detail::Run<P>(self, detail::ViewOf<P>(self, calls), P::kEvents[event].body, choice, effect);
  detail::Exchange<P>(self, effect);
}

/// Gives all variables their initial values: those of the program, then what follows from `assume initially: x == e`. Sensors have to
/// be there. To be called once, with everything else as it is made; `Init` comes next.
/// @return whether all had values; what has none stays as it is
template <typename P>
bool Begin(typename P::Shared& shared, std::span<typename P::Local> local, std::span<const typename P::In> in,
           std::span<typename P::Out> out, typename P::Calls& calls, typename P::Effect& effect) noexcept {
  bool good = true;
  for (const auto& begin : P::kBegins) {
    for (size_t r = 0; r < (begin.per_robot ? local.size() : 1); ++r) {
      const Self<P> self{static_cast<int64_t>(r), shared, local[r], in[r], out[r]};
      detail::Clear<P>(effect, {}, false);
      detail::Run<P>(self, detail::ViewOf<P>(self, calls), begin.body, nullptr, effect);
      if (effect.fault != Fault::kNone) detail::Exchange<P>(self, effect);
      good = good && effect.fault == Fault::kNone;
    }
  }
  return good;
}

/// Runs the `init` blocks, one after the other, each of which reads what the ones before it wrote.
template <typename P>
void Init(const Self<P>& self, typename P::Calls& calls, Choice* choice,
          typename P::Effect& effect) noexcept {
  detail::Clear<P>(effect, {}, true);
  for (const auto body : P::kInits)
    detail::Run<P>(self, detail::ViewOf<P>(self, calls), body, choice, effect);
  effect.locks = false;
  detail::Exchange<P>(self, effect);
}

/// Runs fallback number `fallback`: its actuators have new values then, or all hold if some operation has no value.
template <typename P>
void FallBack(const Self<P>& self, size_t fallback, typename P::Calls& calls,
              typename P::Effect& effect) noexcept {
  detail::Clear<P>(effect, {}, false);
  detail::Run<P>(self, detail::ViewOf<P>(self, calls), P::kFallbacks[fallback].body, nullptr, effect);
  if (effect.fault != Fault::kNone) detail::Exchange<P>(self, effect);
}

/// Says what a robot would like to do: the alternative that it would like best comes first.
template <typename P>
struct Turn {
  size_t robot;
  std::span<const typename P::Effect> alternatives;
};

/// Ends a round (rule EndProgTrans): goes through the robots in this order, gives each the first alternative whose lock no robot
/// before it holds, and lets it write. So one order explains every lock and every last writer. Evaluates nothing.
/// @param did  gets, by turn, the number of the alternative; as many as there are: the robot skips
template <typename P>
void Merge(std::span<const Turn<P>> turns, typename P::Shared& shared, std::span<typename P::Local> local,
           std::span<typename P::Out> out, std::span<size_t> did) noexcept {
  std::bitset<P::kEvents.size() + 1> held;
  for (size_t t = 0; t < turns.size(); ++t) {
    const auto alternatives = turns[t].alternatives;
    size_t a = 0;
    while (a < alternatives.size() &&
           (alternatives[a].fault != Fault::kNone ||
            (alternatives[a].locks && held[static_cast<size_t>(alternatives[a].event)])))
      ++a;
    did[t] = a;
    if (a == alternatives.size()) continue;
    if (alternatives[a].locks) held.set(static_cast<size_t>(alternatives[a].event));
    const size_t robot = turns[t].robot;
    const auto& effect = alternatives[a];
    P::EachCell(static_cast<int64_t>(robot), effect.changes, shared, local[robot], out[robot],
                [&](size_t cell, const auto& value, auto& now) {
                  if (effect.wrote[cell]) now = value;
                });
  }
}

/// Is the value of a formula: not `defined` where an operation had no value.
struct Truth {
  bool holds = true;
  bool defined = true;
  int64_t robot = 0;  ///< the first for which it does not hold
};

/// Is a formula of the specification; `per_robot`: it is about the robot that looks.
template <typename P>
struct FormulaCode {
  const char* name;
  bool per_robot;
  bool (*holds)(Step&, const View<P>& now, const View<P>& old);
};

/// Evaluates a formula for one robot. `old`: the state at the end of the program transition, for controller assumptions.
template <typename P>
Truth HoldsFor(const FormulaCode<P>& formula, int64_t robot, const Team<P>& now, const Team<P>& old,
               typename P::Calls& calls) noexcept {
  const auto r = static_cast<size_t>(robot);
  const auto look = [&](const Team<P>& t) {
    return View<P>{t.shared, t.local[r], t.in[r], t.out[r], calls, t.local, t.in, t.out};
  };
  Step step(robot, true);
  const bool value = formula.holds(step, look(now), look(old));
  return {value && !step.failed(), !step.failed() && !step.used_default(), robot};
}

/// Evaluates a formula of a state, such as an invariant, for every robot that it is about.
template <typename P>
Truth Holds(const FormulaCode<P>& formula, const Team<P>& team, typename P::Calls& calls) noexcept {
  Truth all;
  for (size_t r = 0; r < (formula.per_robot ? team.local.size() : 1); ++r) {
    const Truth here = HoldsFor(formula, static_cast<int64_t>(r), team, team, calls);
    all.defined = all.defined && here.defined;
    if (here.holds) continue;
    if (all.holds) all.robot = static_cast<int64_t>(r);
    all.holds = false;
    if (here.defined) break;
  }
  return all;
}

}  // namespace rondo::program
