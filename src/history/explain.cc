#include "history/explain.h"

#include <algorithm>

namespace rondo::history {

using koord::semantics::Effect;
using koord::semantics::Fault;

namespace {

constexpr size_t kMostTries = 1'000'000;

}  // namespace

Explainer::Explainer(koord::semantics::Team& team) : team_(team), transition_(team), options_(team.robots()) {
  covered_.resize(team.layout().block_words());
  for (size_t v = 0; v < team.model().variables.size(); ++v) {
    if (team.model().FallsBack(v) && team.layout()[v].exists)
      std::fill_n(covered_.begin() + team.layout()[v].at, team.layout()[v].words(), true);
    if (team.model().variables[v].kind == koord::VariableKind::kSensor && team.layout()[v].exists)
      sensors_.push_back(v);
  }
}

std::optional<Explanation> Explainer::Explain(std::span<const Word> before, std::span<const Word> after,
                                              bool init, const std::vector<bool>& may_skip,
                                              const std::vector<std::vector<Word>>& fallen,
                                              const std::vector<std::vector<uint32_t>>& waits) {
  start_.assign(before.begin(), before.end());
  for (const size_t v : sensors_) {
    for (size_t r = 0; r < team_.robots(); ++r) {
      const uint32_t at = team_.layout().Address(v, r);
      std::copy_n(after.begin() + at, team_.layout()[v].words(), start_.begin() + at);
    }
  }
  after_ = after;
  init_ = init;
  may_skip_ = &may_skip;
  fallen_ = &fallen;
  waits_ = &waits;
  if (init)
    transition_.PrepareInit(start_);
  else
    transition_.Prepare(start_);
  found_.choice.assign(team_.robots(), Explanation::kSkipped);
  found_.could_act.assign(team_.robots(), false);
  found_.idle.assign(team_.robots(), false);
  for (size_t r = 0; r < team_.robots(); ++r) {
    options_[r].clear();
    const auto effects = transition_.Of(r);
    for (size_t e = 0; e < effects.size(); ++e) {
      if (effects[e].fault != Fault::kNone) continue;
      found_.could_act[r] = found_.could_act[r] || !Waits(r, effects[e].event);
      if (Fits(r, &effects[e])) options_[r].push_back(static_cast<int>(e));
    }
    found_.idle[r] = options_[r].empty();
    if (Fits(r, nullptr)) options_[r].push_back(Explanation::kSkipped);
    if (options_[r].empty()) return std::nullopt;
  }
  tried_ = 0;
  if (!Try(0)) return std::nullopt;
  return found_;
}

bool Explainer::Writes(const Effect* effect, uint32_t at) {
  return effect != nullptr && std::ranges::any_of(effect->own, [&](const auto& w) { return w.at == at; });
}

// Does the robot's own block become what it is at the end?
bool Explainer::Fits(size_t robot, const Effect* effect) {
  const auto& layout = team_.layout();
  const uint32_t first = layout.block(robot);
  const auto own = [&](uint32_t at) { return at >= first && at < first + layout.block_words(); };
  std::vector<std::pair<uint32_t, Word>> undo;
  if (effect != nullptr) {
    for (const Effect::Write& w : effect->own) {
      if (!own(w.at)) return false;
      undo.emplace_back(w.at, start_[w.at]);
      start_[w.at] = w.value;
    }
  }
  const std::vector<Word>* fallen =
      robot < fallen_->size() && !(*fallen_)[robot].empty() ? &(*fallen_)[robot] : nullptr;
  bool fits = true;
  for (uint32_t k = 0; k < layout.block_words() && fits; ++k) {
    const uint32_t at = first + k;
    const bool set = fallen != nullptr && covered_[k] && (*fallen)[at] == after_[at] && !Writes(effect, at);
    fits = start_[at] == after_[at] || set;
  }
  for (auto it = undo.rbegin(); it != undo.rend(); ++it) start_[it->first] = it->second;
  return fits;
}

bool Explainer::Try(size_t robot) {
  if (robot == team_.robots()) return Locks() && LastWriters();
  for (const int option : options_[robot]) {
    if (++tried_ > kMostTries) return false;
    found_.choice[robot] = option;
    if (Try(robot + 1)) return true;
  }
  return false;
}

bool Explainer::Waits(size_t robot, uint32_t event) const {
  return robot < waits_->size() && std::ranges::find((*waits_)[robot], event) != (*waits_)[robot].end();
}

// One holder for each lock; and who leaves an urgent event undone cannot have it, or takes no part.
bool Explainer::Locks() {
  std::vector<uint32_t> held;
  for (size_t r = 0; r < team_.robots(); ++r) {
    if (found_.choice[r] < 0) continue;
    const Effect& effect = transition_.Of(r)[static_cast<size_t>(found_.choice[r])];
    if (!effect.locks) continue;
    if (std::ranges::find(held, effect.event) != held.end()) return false;
    held.push_back(effect.event);
  }
  for (size_t r = 0; r < team_.robots(); ++r) {
    if (found_.choice[r] >= 0 || (*may_skip_)[r]) continue;
    for (const Effect& effect : transition_.Of(r)) {
      if (effect.fault != Fault::kNone || !effect.urgent || Waits(r, effect.event)) continue;
      if (!effect.locks || std::ranges::find(held, effect.event) == held.end()) return false;
    }
  }
  return true;
}

// Is there an order of the robots in which the last writers leave the values at the end? Whoever can be last
// may be last: what it writes is then settled, and nobody before it matters there.
bool Explainer::LastWriters() {
  const uint32_t shared = team_.layout().shared_words();
  std::vector<bool> settled(shared);
  std::vector<size_t> left;
  for (size_t r = 0; r < team_.robots(); ++r) {
    if (found_.choice[r] >= 0) left.push_back(r);
  }
  while (!left.empty()) {
    const auto last = std::ranges::find_if(left, [&](size_t r) {
      const Effect& effect = transition_.Of(r)[static_cast<size_t>(found_.choice[r])];
      return std::ranges::all_of(effect.shared, [&](const Effect::Shared& s) {
        for (uint32_t k = 0; k < s.unit.width; ++k) {
          if (!settled[s.unit.at + k] && effect.words[s.values + k] != after_[s.unit.at + k]) return false;
        }
        return true;
      });
    });
    if (last == left.end()) return false;
    for (const auto& s : transition_.Of(*last)[static_cast<size_t>(found_.choice[*last])].shared)
      std::fill_n(settled.begin() + s.unit.at, s.unit.width, true);
    left.erase(last);
  }
  for (uint32_t at = 0; at < shared; ++at) {
    if (!settled[at] && start_[at] != after_[at]) return false;
  }
  return true;
}

}  // namespace rondo::history
