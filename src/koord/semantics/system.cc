#include "koord/semantics/system.h"

#include <algorithm>
#include <numeric>

#include "koord/semantics/machine/values.h"
#include "koord/semantics/symmetry.h"

namespace rondo::koord::semantics {

using explore::Broken;
using explore::State;

System::System(Team& team, const SystemOptions& options, diag::Diagnostics& diagnostics, SharedValues* shared)
    : team_(team),
      options_(options),
      environment_(team, diagnostics),
      transition_(team),
      exchange_(shared == nullptr
                    ? std::nullopt
                    : std::make_optional<HandleExchange>(team.model().types, team.heap(), *shared)),
      packing_(team.layout(), 1, exchange_ ? &*exchange_ : nullptr),
      symmetric_(options.symmetry && team.robots() > 1 && IsSymmetric(team.model())),
      state_(team.layout().words()),
      checked_(team.layout().words()),
      canonical_(team.layout().words()),
      marks_((team.events().size() + 63) / 64),
      undefined_(team.invariants().size()),
      emitted_(team.layout().words()) {
  team.machine().CheckSummaries(true);
  transition_.TreatAlike(symmetric_);
}

Trouble System::TroubleOf(int property) const {
  const int invariants = static_cast<int>(team_.invariants().size());
  return property < invariants    ? Trouble::kInvariant
         : property == invariants ? Trouble::kFault
                                  : Trouble::kSummary;
}

int System::Violated(std::span<const Word> state, bool between_rounds) {
  // Formulas only read.
  team_.machine().SetMemory(const_cast<Word*>(state.data()));  // NOLINT
  for (size_t i = 0; i < team_.invariants().size(); ++i) {
    if (options_.only && *options_.only != i) continue;
    if (team_.invariants()[i].at_rounds && !between_rounds) continue;
    bool defined = true;
    const bool holds = team_.Holds(team_.invariants()[i], nullptr, &defined);
    if (!defined)
      undefined_[i] = true;
    else if (!holds)
      return static_cast<int>(i);
  }
  return -1;
}

// Renames the robots so that their blocks are sorted.
void System::Canonical(std::span<const Word> state) {
  const Layout& layout = team_.layout();
  std::vector<uint32_t> order(team_.robots());
  std::iota(order.begin(), order.end(), 0);
  const uint32_t width = layout.block_words();
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const Word* x = state.data() + layout.block(a);
    const Word* y = state.data() + layout.block(b);
    // Handles differ from heap to heap: lists are told apart by what they hold.
    for (uint32_t i = 0; i < width; ++i) {
      if (x[i] == y[i]) continue;
      const Layout::Slot& slot = layout.block_slots()[i];
      if (slot.kind != WordKind::kHandle) return x[i] < y[i];
      return Compare(team_.model().types, team_.heap(), slot.type, x[i], y[i]) < 0;
    }
    return false;
  });
  std::copy_n(state.begin(), layout.shared_words(), canonical_.begin());
  for (size_t r = 0; r < order.size(); ++r)
    std::copy_n(state.data() + layout.block(order[r]), width, canonical_.data() + layout.block(r));
}

// False: end here.
bool System::Emit(std::span<const Word> state, Word phase, const explore::Visit& visit) {
  std::copy(state.begin(), state.end(), emitted_.begin());
  if (symmetric_) Canonical(state);
  return visit(packing_.Pack(symmetric_ ? std::span<const Word>(canonical_) : state, phase));
}

int System::Check(State packed) {
  Word phase = 0;
  packing_.Unpack(packed, checked_, phase);
  return Violated(checked_, phase == 0);
}

void System::TakeIn(const System& other) {
  for (size_t i = 0; i < undefined_.size(); ++i) undefined_[i] = undefined_[i] || other.undefined_[i];
  if (other.stuck_ && (!stuck_ || *other.stuck_ < *stuck_)) stuck_ = other.stuck_;
}

Broken System::Failure(Fault fault, diag::Span span, size_t robot, int event) {
  detail_ = {fault, span, robot, event, -1};
  return {static_cast<int>(team_.invariants().size()), false};
}

bool System::SummaryBroken(Broken& broken) {
  const int summary = team_.machine().violated_summary();
  if (summary < 0) return false;
  team_.machine().ForgetSummary();
  detail_ = {Fault::kNone, team_.model().summaries[static_cast<size_t>(summary)]->span, 0, -1, summary};
  broken = {static_cast<int>(team_.invariants().size()) + 1, false};
  return true;
}

Broken System::Initial(const explore::Visit& visit) {
  Broken broken;
  team_.machine().ForgetSummary();
  const auto begin = [&](std::span<const Word> state) {
    if (!environment_.MayBegin(state)) {
      ++refused_;
      return true;
    }
    return Emit(state, 0, visit);
  };
  environment_.Declared([&](std::span<const Word> declared) {
    if (team_.inits().empty()) return begin(declared);
    transition_.PrepareInit(declared);
    size_t robot = 0;
    if (const Effect* failed = transition_.Failed(&robot)) {
      broken = Failure(failed->fault, failed->fault_span, robot, -1);
      return false;
    }
    const auto settled = [&](std::span<const Word> state, bool complete) {
      return !complete || begin(state);
    };
    return options_.reduce ? transition_.Enumerate(settled) : transition_.EnumerateOrders(settled);
  });
  if (broken.property < 0 && environment_.fault() != Fault::kNone)
    return Failure(environment_.fault(), environment_.fault_span(), 0, -1);
  if (broken.property < 0) SummaryBroken(broken);
  return broken;
}

Broken System::Program(std::span<const Word> state, const explore::Visit& visit) {
  Broken broken;
  team_.machine().ForgetSummary();
  transition_.Prepare(state);
  if (SummaryBroken(broken)) return broken;
  size_t robot = 0;
  if (const Effect* failed = transition_.Failed(&robot))
    return Failure(failed->fault, failed->fault_span, robot, static_cast<int>(failed->event));
  for (size_t r = 0; r < team_.robots(); ++r) {
    for (const Effect& e : transition_.Of(r)) marks_[e.event / 64] |= uint64_t{1} << e.event % 64;
  }
  const Word phase = team_.has_sensors() ? 1 : 0;
  const auto settled = [&](std::span<const Word> after, bool complete) {
    if (complete) return Emit(after, phase, visit);
    const int violated = Violated(after, false);
    if (violated < 0) return true;
    std::copy(after.begin(), after.end(), emitted_.begin());
    broken = {violated, false};
    return false;
  };
  if (options_.reduce)
    transition_.Enumerate(settled);
  else
    transition_.EnumerateOrders(settled);
  return broken;
}

Broken System::Expand(std::span<const Word> state, Word phase, const explore::Visit& visit) {
  std::ranges::fill(marks_, 0);
  if (phase == 0) return Program(state, visit);
  Broken broken;
  // Before the round is over there may be states that it cannot end in; only what breaks something in them counts.
  if (std::ranges::any_of(team_.promises(), &PromiseCode::at_end)) {
    environment_.Move(state, false, [&](std::span<const Word> moved) {
      const int violated = Violated(moved, false);
      if (violated < 0) return true;
      Emit(moved, 0, visit);
      broken = {violated, true};
      return false;
    });
    if (broken.property >= 0) return broken;
  }
  environment_.Move(state, true, [&](std::span<const Word> moved) { return Emit(moved, 0, visit); });
  if (environment_.fault() != Fault::kNone)
    return Failure(environment_.fault(), environment_.fault_span(), 0, -1);
  if (environment_.stuck() >= 0) {
    const auto robot = static_cast<size_t>(environment_.stuck());
    stuck_ = std::min(stuck_.value_or(robot), robot);
  }
  return broken;
}

Broken System::Successors(State packed, const explore::Visit& visit) {
  Word phase = 0;
  packing_.Unpack(packed, state_, phase);
  return Expand(state_, phase, visit);
}

bool System::Deadlocked(State packed) {
  Word phase = 0;
  packing_.Unpack(packed, state_, phase);
  if (phase != 0) return false;
  const Layout& layout = team_.layout();
  bool all_stopped = true;
  for (size_t r = 0; r < team_.robots(); ++r)
    all_stopped = all_stopped && state_[layout.block(r) + layout.stopped()] != 0;
  if (all_stopped) return false;
  transition_.Prepare(state_);
  if (transition_.AnyEnabled()) return false;
  bool changes = false;
  if (team_.has_sensors()) {
    const std::vector<Word> here = state_;
    environment_.Move(here, true, [&](std::span<const Word> moved) {
      changes = !std::equal(moved.begin(), moved.end(), here.begin());
      return !changes;
    });
  }
  return !changes;
}

void System::StepFrom(std::span<const Word> state, bool environment,
                      const std::function<bool(const Step&)>& visit) {
  const std::vector<Word> here(state.begin(), state.end());
  const auto look = [&](State) {
    Step step;
    if (!environment) step = Tell(true);
    step.environment = environment;
    step.state = emitted_;
    return !visit(step);
  };
  Expand(here, environment ? 1 : 0, look);
}

Broken System::Try(std::span<const Word> state) {
  const std::vector<Word> here(state.begin(), state.end());
  return Expand(here, 0, [](State) { return true; });
}

bool System::HasPrefix(std::span<const Word> state, const std::function<bool(std::span<const Word>)>& is) {
  const std::vector<Word> here(state.begin(), state.end());
  transition_.Prepare(here);
  bool found = false;
  transition_.Enumerate([&](std::span<const Word> after, bool) {
    found = is(after);
    return !found;
  });
  return found;
}

std::vector<Word> System::Unpack(State packed) {
  std::vector<Word> state(team_.layout().words());
  Word phase = 0;
  packing_.Unpack(packed, state, phase);
  return state;
}

Step System::Tell(bool complete) const {
  Step step;
  step.complete = complete;
  for (size_t r = 0; r < team_.robots(); ++r) {
    Action action{r, -1, {}};
    if (const int k = transition_.choice()[r]; k >= 0) {
      const Effect& effect = transition_.Of(r)[static_cast<size_t>(k)];
      action.event = static_cast<int>(effect.event);
      action.writes = effect.own;
      for (const Effect::Shared& s : effect.shared) {
        for (uint32_t w = 0; w < s.unit.width; ++w)
          action.writes.push_back({s.unit.at + w, effect.words[s.values + w]});
      }
    }
    step.actions.push_back(std::move(action));
  }
  step.last_writers = transition_.last_writers();
  step.state = emitted_;
  return step;
}

std::vector<Step> System::Explain(const std::vector<explore::KeptState>& path, const Broken& broken) {
  std::vector<Step> run;
  std::vector<Word> here;
  for (size_t i = 0; i < path.size(); ++i) {
    bool found = false;
    Step step;
    const Word phase = i == 0 || AtRound(path[i - 1]) ? 0 : 1;
    const auto look = [&](State candidate) {
      if (!std::ranges::equal(candidate, path[i])) return true;
      found = true;
      if (i > 0 && phase == 0) step = Tell(true);
      step.environment = phase != 0;
      step.state = emitted_;
      return false;
    };
    if (i == 0)
      Initial(look);
    else
      Expand(here, phase, look);
    if (!found) return run;
    here = step.state;
    run.push_back(std::move(step));
  }
  if (broken.property < 0 || broken.at_visited || run.empty()) return run;
  // On the way from the last state: a part of the robots, or an operation that fails.
  const Word phase = AtRound(path.back()) ? 0 : 1;
  Step step;
  step.complete = false;
  bool told = false;
  if (TroubleOf(broken.property) == Trouble::kInvariant && phase == 0) {
    transition_.Prepare(here);
    const auto look = [&](std::span<const Word> after, bool) {
      if (Violated(after, false) < 0) return true;
      std::copy(after.begin(), after.end(), emitted_.begin());
      step = Tell(false);
      told = true;
      return false;
    };
    if (options_.reduce)
      transition_.Enumerate(look);
    else
      transition_.EnumerateOrders(look);
  }
  if (told) run.push_back(std::move(step));
  return run;
}

}  // namespace rondo::koord::semantics
