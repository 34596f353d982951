#include "koord/semantics/program_transition.h"

#include <algorithm>

namespace rondo::koord::semantics {

ProgramTransition::ProgramTransition(Team& team)
    : team_(team),
      effects_(team.robots()),
      counts_(team.robots()),
      choice_(team.robots(), kSkips),
      lock_holder_(team.events().size() + 1, -1),
      acted_(team.robots()) {
  for (const EventCode& event : team.events()) any_urgent_ = any_urgent_ || event.urgent;
  team.machine().SetChooser([this](uint64_t possibilities) { return choices_.Pick(possibilities); });
}

Effect& ProgramTransition::Next(size_t robot) {
  std::vector<Effect>& all = effects_[robot];
  if (counts_[robot] == all.size()) all.emplace_back();
  Effect& effect = all[counts_[robot]++];
  effect.own.clear();
  effect.shared.clear();
  effect.words.clear();
  effect.said.clear();
  return effect;
}

// Once for each sequence of choices.
template <typename Way>
void ProgramTransition::Each(const Way& way) {
  choices_.Clear();
  size_t ways = 0;
  do {
    Fault* fault = way();
    // More than anybody could look at: a fault, not fewer possibilities.
    if (++ways == kMostWays && *fault == Fault::kNone && choices_.any()) *fault = Fault::kTooMany;
  } while (ways < kMostWays && choices_.Next());
}

// Rule SelectEvent and the statements of the event, on the robot's own copy.
void ProgramTransition::Run(size_t robot, uint32_t event, uint32_t entry, Effect& effect) {
  Machine& machine = team_.machine();
  choices_.Begin();
  effect.event = event;
  effect.fault = machine.Run(entry, robot, false) ? Fault::kNone : machine.fault();
  effect.fault_span = machine.fault_span();
  effect.locks = machine.locked();
  effect.said = machine.said();
  const uint32_t first = team_.layout().shared_words();
  effect.idle = !effect.locks && machine.units().empty();
  for (const Machine::Write& w : machine.writes()) {
    if (w.at < first) continue;
    effect.own.push_back({w.at, memory_[w.at]});
    effect.idle = effect.idle && memory_[w.at] == w.before;
  }
  if (machine.stopped()) {
    effect.own.push_back({team_.layout().block(robot) + team_.layout().stopped(), 1});
    effect.idle = false;
  }
  for (const Machine::Unit unit : machine.units()) {
    effect.shared.push_back({unit, static_cast<uint32_t>(effect.words.size())});
    for (uint32_t k = 0; k < unit.width; ++k) effect.words.push_back(memory_[unit.at + k]);
  }
  machine.Undo();
}

void ProgramTransition::Start(std::span<const Word> state) {
  init_ = false;
  memory_.assign(state.begin(), state.end());
  team_.machine().SetMemory(memory_.data());
  std::ranges::fill(counts_, 0);
}

void ProgramTransition::Prepare(std::span<const Word> state) {
  Start(state);
  for (size_t r = 0; r < team_.robots(); ++r) Find(r);
}

void ProgramTransition::Prepare(std::span<const Word> state, size_t robot) {
  Start(state);
  Find(robot);
}

void ProgramTransition::Find(size_t r) {
  Machine& machine = team_.machine();
  const Layout& layout = team_.layout();
  if (memory_[layout.block(r) + layout.stopped()] != 0) return;
  if (team_.native() != nullptr) {
    team_.native()->Find(memory_, r, effects_[r]);
    counts_[r] = effects_[r].size();
    return;
  }
  for (uint32_t e = 0; e < team_.events().size(); ++e) {
    const EventCode& event = team_.events()[e];
    if (event.guard != 0) {
      const bool defined = machine.Run(event.guard, r, false);
      if (defined && machine.result()[0] == 0) continue;
      if (!defined) {
        Effect& effect = Next(r);
        effect.event = e;
        effect.urgent = event.urgent;
        effect.locks = effect.idle = false;
        effect.fault = machine.fault();
        effect.fault_span = machine.fault_span();
        continue;
      }
    }
    Each([&] {
      Effect& effect = Next(r);
      effect.urgent = event.urgent;
      Run(r, e, event.body, effect);
      return &effect.fault;
    });
  }
  // An urgent event excludes those that are not.
  std::vector<Effect>& all = effects_[r];
  const auto end = all.begin() + static_cast<ptrdiff_t>(counts_[r]);
  if (any_urgent_ && std::any_of(all.begin(), end, [](const Effect& e) { return e.urgent; })) {
    size_t kept = 0;
    for (size_t k = 0; k < counts_[r]; ++k) {
      if (all[k].urgent) std::swap(all[kept++], all[k]);
    }
    counts_[r] = kept;
  }
}

void ProgramTransition::PrepareInit(std::span<const Word> state) {
  init_ = true;
  memory_.assign(state.begin(), state.end());
  team_.machine().SetMemory(memory_.data());
  for (size_t r = 0; r < team_.robots(); ++r) {
    counts_[r] = 0;
    if (team_.native() != nullptr) {
      team_.native()->FindInit(memory_, r, effects_[r]);
      counts_[r] = effects_[r].size();
      continue;
    }
    Each([&] {
      Effect& effect = Next(r);
      RunInits(r, effect);
      return &effect.fault;
    });
  }
}

// Several blocks run one after the other; each reads what the ones before it wrote.
void ProgramTransition::RunInits(size_t robot, Effect& effect) {
  Machine& machine = team_.machine();
  effect.event = 0;
  effect.urgent = true;
  effect.locks = effect.idle = false;
  effect.fault = Fault::kNone;
  choices_.Begin();
  bool stopped = false;
  std::vector<Machine::Write> undo;
  std::vector<Machine::Unit> units;
  for (const uint32_t entry : team_.inits()) {
    const bool good = machine.Run(entry, robot, false);
    undo.insert(undo.end(), machine.writes().begin(), machine.writes().end());
    for (const Machine::Unit unit : machine.units()) {
      if (std::find(units.begin(), units.end(), unit) == units.end()) units.push_back(unit);
    }
    stopped = stopped || machine.stopped();
    effect.said.insert(effect.said.end(), machine.said().begin(), machine.said().end());
    if (good || effect.fault != Fault::kNone) continue;
    effect.fault = machine.fault();
    effect.fault_span = machine.fault_span();
  }
  for (const Machine::Write& w : undo) {
    if (w.at >= team_.layout().shared_words()) effect.own.push_back({w.at, memory_[w.at]});
  }
  if (stopped) effect.own.push_back({team_.layout().block(robot) + team_.layout().stopped(), 1});
  for (const Machine::Unit unit : units) {
    effect.shared.push_back({unit, static_cast<uint32_t>(effect.words.size())});
    for (uint32_t k = 0; k < unit.width; ++k) effect.words.push_back(memory_[unit.at + k]);
  }
  for (auto it = undo.rbegin(); it != undo.rend(); ++it) memory_[it->at] = it->before;
}

bool ProgramTransition::AnyEnabled() const {
  return std::any_of(counts_.begin(), counts_.end(), [](size_t n) { return n > 0; });
}

const Effect* ProgramTransition::Failed(size_t* robot) const {
  for (size_t r = 0; r < counts_.size(); ++r) {
    for (const Effect& e : Of(r)) {
      if (e.fault == Fault::kNone) continue;
      if (robot != nullptr) *robot = r;
      return &e;
    }
  }
  return nullptr;
}

void ProgramTransition::Apply(const Effect& effect, std::vector<Machine::Write>& undo, bool shared) {
  for (const Effect::Write& w : effect.own) {
    undo.push_back({w.at, memory_[w.at]});
    memory_[w.at] = w.value;
  }
  if (!shared) return;
  for (const Effect::Shared& s : effect.shared) {
    for (uint32_t k = 0; k < s.unit.width; ++k) {
      undo.push_back({s.unit.at + k, memory_[s.unit.at + k]});
      memory_[s.unit.at + k] = effect.words[s.values + k];
    }
  }
}

void ProgramTransition::TakeBack(std::vector<Machine::Write>& undo, size_t from) {
  while (undo.size() > from) {
    memory_[undo.back().at] = undo.back().before;
    undo.pop_back();
  }
}

// An urgent event must be run before the environment moves, unless another robot holds the lock that it
// needs.
bool ProgramTransition::MaySkip(size_t robot) const {
  for (const Effect& e : Of(robot)) {
    if (!e.urgent) continue;
    const int holder = lock_holder_[e.event];
    if (!e.locks || holder < 0 || holder == static_cast<int>(robot)) return false;
  }
  return true;
}

bool ProgramTransition::Complete() const {
  if (!any_urgent_ && !init_) return true;
  for (size_t r = 0; r < choice_.size(); ++r) {
    if (choice_[r] == kSkips && !MaySkip(r)) return false;
  }
  return true;
}

bool ProgramTransition::Enumerate(const Visit& visit) {
  like_previous_.assign(team_.robots(), false);
  const Layout& layout = team_.layout();
  for (size_t r = 1; alike_ && !init_ && r < team_.robots(); ++r) {
    const auto block = memory_.begin() + layout.block(r);
    like_previous_[r] =
        std::equal(block, block + layout.block_words(), memory_.begin() + layout.block(r - 1));
  }
  std::fill(lock_holder_.begin(), lock_holder_.end(), -1);
  undo_.clear();
  last_.clear();
  const bool more = Choose(0, visit);
  TakeBack(undo_, 0);
  return more;
}

bool ProgramTransition::Choose(size_t robot, const Visit& visit) {
  if (robot == team_.robots()) return Settle(visit);
  const int least = like_previous_[robot] ? choice_[robot - 1] : kSkips;
  choice_[robot] = kSkips;
  if (!init_ && least == kSkips && !Choose(robot + 1, visit)) return false;
  const auto effects = Of(robot);
  for (size_t k = static_cast<size_t>(std::max(0, least)); k < effects.size(); ++k) {
    const Effect& effect = effects[k];
    if (effect.fault != Fault::kNone) continue;
    if (effect.idle && !effect.urgent) continue;
    if (effect.locks && lock_holder_[effect.event] >= 0) continue;
    choice_[robot] = static_cast<int>(k);
    if (effect.locks) lock_holder_[effect.event] = static_cast<int>(robot);
    const size_t mark = undo_.size();
    Apply(effect, undo_, false);
    const bool more = Choose(robot + 1, visit);
    TakeBack(undo_, mark);
    if (effect.locks) lock_holder_[effect.event] = -1;
    choice_[robot] = kSkips;
    if (!more) return false;
  }
  return true;
}

// What several robots write takes the value of its last writer: one order decides for all variables.
bool ProgramTransition::Settle(const Visit& visit) {
  const bool complete = Complete();
  unit_count_ = 0;
  for (size_t r = 0; r < choice_.size(); ++r) {
    if (choice_[r] == kSkips) continue;
    for (const Effect::Shared& s : effects_[r][static_cast<size_t>(choice_[r])].shared) {
      size_t u = 0;
      while (u < unit_count_ && !(units_[u].unit == s.unit)) ++u;
      if (u == unit_count_) {
        if (unit_count_ == units_.size()) units_.emplace_back();
        units_[u].unit = s.unit;
        units_[u].writers.clear();
        units_[u].winner = -1;
        ++unit_count_;
      }
      units_[u].writers.push_back(r);
    }
  }
  if (unit_count_ == 0) return visit(memory_, complete);
  return Resolve(visit, complete);
}

bool ProgramTransition::Resolve(const Visit& visit, bool complete) {
  const auto values = [&](size_t robot, Machine::Unit unit) -> const Word* {
    const Effect& effect = effects_[robot][static_cast<size_t>(choice_[robot])];
    for (const Effect::Shared& s : effect.shared) {
      if (s.unit == unit) return effect.words.data() + s.values;
    }
    return nullptr;
  };
  // Robots that write a variable with several writers and no last one yet.
  std::vector<size_t> candidates;
  for (size_t u = 0; u < unit_count_; ++u) {
    const Conflict& c = units_[u];
    if (c.winner >= 0 || c.writers.size() < 2) continue;
    const Word* first = values(c.writers[0], c.unit);
    const bool same = std::all_of(c.writers.begin(), c.writers.end(), [&](size_t w) {
      return std::equal(first, first + c.unit.width, values(w, c.unit));
    });
    if (same) continue;
    for (const size_t w : c.writers) {
      if (std::find(candidates.begin(), candidates.end(), w) == candidates.end()) candidates.push_back(w);
    }
  }
  if (candidates.empty()) {
    const size_t mark = undo_.size();
    for (size_t u = 0; u < unit_count_; ++u) {
      const Conflict& c = units_[u];
      const size_t winner = c.winner >= 0 ? static_cast<size_t>(c.winner) : c.writers[0];
      const Word* from = values(winner, c.unit);
      for (uint32_t k = 0; k < c.unit.width; ++k) {
        undo_.push_back({c.unit.at + k, memory_[c.unit.at + k]});
        memory_[c.unit.at + k] = from[k];
      }
      if (c.writers.size() > 1) last_.push_back({c.unit, winner});
    }
    const bool more = visit(memory_, complete);
    last_.clear();
    TakeBack(undo_, mark);
    return more;
  }
  // The last of them all wins whatever it writes; then the last of the rest, and so on.
  for (const size_t robot : candidates) {
    std::vector<size_t> won;
    for (size_t u = 0; u < unit_count_; ++u) {
      Conflict& c = units_[u];
      if (c.winner >= 0 || std::find(c.writers.begin(), c.writers.end(), robot) == c.writers.end()) continue;
      c.winner = static_cast<int>(robot);
      won.push_back(u);
    }
    const bool more = Resolve(visit, complete);
    for (const size_t u : won) units_[u].winner = -1;
    if (!more) return false;
  }
  return true;
}

bool ProgramTransition::EnumerateOrders(const Visit& visit) {
  std::fill(lock_holder_.begin(), lock_holder_.end(), -1);
  std::fill(choice_.begin(), choice_.end(), kSkips);
  std::fill(acted_.begin(), acted_.end(), false);
  undo_.clear();
  last_.clear();
  const bool more = Order(0, visit);
  TakeBack(undo_, 0);
  return more;
}

bool ProgramTransition::Order(size_t done, const Visit& visit) {
  const bool all = done == team_.robots();
  if (!visit(memory_, all && Complete())) return false;
  for (size_t r = 0; r < team_.robots(); ++r) {
    if (acted_[r]) continue;
    acted_[r] = true;
    for (int k = init_ ? 0 : kSkips; k < static_cast<int>(counts_[r]); ++k) {
      const size_t mark = undo_.size();
      int event = -1;
      if (k != kSkips) {
        const Effect& effect = effects_[r][static_cast<size_t>(k)];
        if (effect.fault != Fault::kNone) continue;
        if (effect.locks && lock_holder_[effect.event] >= 0) continue;
        if (effect.locks) event = static_cast<int>(effect.event);
        Apply(effect, undo_, true);
      }
      choice_[r] = k;
      if (event >= 0) lock_holder_[static_cast<size_t>(event)] = static_cast<int>(r);
      const bool more = Order(done + 1, visit);
      if (event >= 0) lock_holder_[static_cast<size_t>(event)] = -1;
      choice_[r] = kSkips;
      TakeBack(undo_, mark);
      if (!more) return false;
    }
    acted_[r] = false;
  }
  return true;
}

}  // namespace rondo::koord::semantics
