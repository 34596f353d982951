#include "koord/node/node.h"

#include <algorithm>

#include "base/mixed.h"
#include "koord/semantics/fallback.h"

namespace rondo::koord::node {

using runtime::codec::Bytes;
using runtime::codec::Reader;
using runtime::codec::View;
using runtime::codec::Writer;
using runtime::rounds::Alternative;
using semantics::Effect;

Node::Node(semantics::Team& team, uint32_t robot, Sensors* sensors, uint64_t seed)
    : team_(team),
      robot_(robot),
      sensors_(sensors),
      seed_(seed),
      cells_(team),
      transition_(team),
      state_(team.blank()),
      commands_(team, cells_, robot) {
  team_.machine().KeepSaid(true);
}

void Node::Reset(std::span<const Word> state, uint64_t seed) {
  state_.assign(state.begin(), state.end());
  seed_ = seed;
  offers_ = 0;
  applied_.Clear(0);
  failed_.reset();
  commands_.Reset(state);
}

const std::vector<Cell>& Node::FallBack(uint64_t round) {
  if (commands_.covered().empty()) return commands_.covered();
  std::vector<Word> seen = state_;
  for (const Cell cell : commands_.covered()) {
    const uint32_t at = cells_.Address(cell, robot_);
    std::copy_n(real().begin() + at, cells_.Width(cell), seen.begin() + at);
  }
  for (const Cell cell : cells_.sensors()) {
    if (sensors_ != nullptr)
      sensors_->Read(robot_, round, cell,
                     std::span(seen).subspan(cells_.Address(cell, robot_), cells_.Width(cell)));
  }
  semantics::FallBack(team_, seen, robot_);
  commands_.FallBack(seen);
  return commands_.covered();
}

// Whole cells; of one that is written in parts, all words.
void Node::EncodeEffect(const Effect& effect, Bytes& out) {
  touched_.clear();
  std::vector<Word>& after = seen_;
  const auto write = [&](uint32_t at, Word value) {
    const Cell cell = cells_.At(at);
    if (std::ranges::find(touched_, cell) == touched_.end()) touched_.push_back(cell);
    after[at] = value;
  };
  for (const Effect::Write& w : effect.own) write(w.at, w.value);
  for (const Effect::Shared& shared : effect.shared) {
    for (uint32_t k = 0; k < shared.unit.width; ++k)
      write(shared.unit.at + k, effect.words[shared.values + k]);
  }
  Writer writer(out);
  writer.Number(touched_.size());
  for (const Cell cell : touched_) {
    const uint32_t at = cells_.Address(cell, robot_), width = cells_.Width(cell);
    cells_.Encode(cell, robot_, state_, std::span(after).subspan(at, width), writer);
    std::copy_n(before_.begin() + at, width, after.begin() + at);
  }
}

size_t Node::First(uint64_t round, std::span<const Effect> effects) const {
  if (effects.empty()) return 0;
  if (choose_) return choose_(round, robot_, effects);
  return base::Mixed(seed_ ^ base::Mixed(round * 1024 + robot_)) % effects.size();
}

// What the robot sees of the world now goes into `seen_`; the store gets it with the frame.
void Node::See(uint64_t round) {
  seen_ = state_;
  inputs_.clear();
  Writer writer(inputs_);
  const std::vector<Cell>& apart = commands_.Tell(state_);
  writer.Number((blind_ ? 0 : cells_.sensors().size()) + apart.size());
  const auto tell = [&](Cell cell, std::span<const Word> words) {
    cells_.Encode(cell, robot_, state_, words, writer);
  };
  for (const Cell cell : cells_.sensors()) {
    if (blind_) break;
    const std::span<Word> words(seen_.data() + cells_.Address(cell, robot_), cells_.Width(cell));
    if (sensors_ != nullptr) sensors_->Read(robot_, round, cell, words);
    tell(cell, words);
  }
  for (const Cell cell : apart) {
    const uint32_t at = cells_.Address(cell, robot_), width = cells_.Width(cell);
    std::copy_n(real().begin() + at, width, seen_.begin() + at);
    tell(cell, std::span(seen_).subspan(at, width));
  }
}

void Node::Offer(const Effect& effect) {
  if (offers_ == offered_.size()) offered_.emplace_back();
  Offered& offered = offered_[offers_++];
  offered.event = effect.event;
  offered.effect.clear();
  EncodeEffect(effect, offered.effect);
  offered.said.clear();
  for (const semantics::Said& said : effect.said)
    offered.said.push_back(team_.ShowLogged(said.type, said.value));
}

void Node::Contribute(uint64_t round, Bytes& out) {
  round_ = round;
  offers_ = 0;
  failed_.reset();
  waits_.clear();
  skips_ = false;
  blind_ = round > 0 && sensors_ != nullptr && !sensors_->Usable(robot_, round);
  See(round);
  if (blind_) {
    for (uint32_t e = 0; e < team_.events().size(); ++e) waits_.push_back(e);
    contribution_.inputs = inputs_;
    contribution_.alternatives.clear();
    runtime::rounds::Encode(contribution_, out);
    return;
  }
  if (round == 0)
    transition_.PrepareInit(seen_);
  else
    transition_.Prepare(seen_, robot_);
  before_ = seen_;
  const auto effects = transition_.Of(robot_);
  const size_t first = First(round, effects);
  skips_ = first >= effects.size() && !effects.empty();
  // What `init` asks for has to be there.
  const auto late = [&](const Effect& e) { return e.fault == semantics::Fault::kNotYet && round > 0; };
  for (const Effect& effect : effects) {
    if (late(effect)) waits_.push_back(effect.event);
  }
  if (first < effects.size() && effects[first].fault != semantics::Fault::kNone && !late(effects[first]))
    failed_ = {round == 0 ? kInit : effects[first].event, effects[first].fault, effects[first].fault_span};
  const size_t count =
      first < effects.size() ? std::min(effects.size(), runtime::rounds::kMostAlternatives) : 0;
  contribution_.alternatives.clear();
  for (size_t i = 0; i < count; ++i) {
    const Effect& effect = effects[(first + i) % effects.size()];
    if (effect.fault != semantics::Fault::kNone) continue;
    Offer(effect);
    contribution_.alternatives.push_back({effect.event, effect.locks, {}});
    if (!effect.locks) break;  // nothing can take it away
  }
  for (size_t i = 0; i < offers_; ++i) contribution_.alternatives[i].effect = offered_[i].effect;
  contribution_.inputs = inputs_;
  runtime::rounds::Encode(contribution_, out);
}

// Reads cells, which are changes of `before`, and, if there is a state, puts them there; `cells` gets which they were.
bool Node::Reads(View bytes, uint32_t robot, bool inputs, std::span<const Word> before,
                 std::vector<Word>* state, std::vector<Cell>* cells) const {
  if (bytes.empty()) return inputs;  // nothing new
  Reader reader(bytes);
  const size_t count = reader.Number(bytes.size());
  for (size_t i = 0; i < count && reader.ok(); ++i) {
    read_.clear();
    const Cell cell = cells_.Decode(robot, before, reader, read_);
    if (!reader.ok()) return false;
    const bool sensor = cells_.Kind(cell) == VariableKind::kSensor;
    if (inputs ? !sensor && !commands_.IsCovered(cell) : sensor) return false;
    if (state != nullptr) std::ranges::copy(read_, state->begin() + cells_.Address(cell, robot));
    if (cells != nullptr) cells->push_back(cell);
  }
  return reader.Complete();
}

bool Node::Accepts(uint32_t robot, View inputs, std::span<const Alternative> alternatives) const {
  if (!Reads(inputs, robot, true, state_, nullptr)) return false;
  return std::ranges::all_of(alternatives, [&](const Alternative& a) {
    return a.event < team_.events().size() && Reads(a.effect, robot, false, state_, nullptr);
  });
}

void Node::Apply(uint64_t, std::span<const runtime::rounds::Turn> turns) {
  // What everybody said is a change of the store at the start of the round.
  before_ = state_;
  for (const auto& turn : turns) Reads(turn.inputs, turn.robot, true, before_, &state_);
  applied_.Clear(team_.robots());
  for (const auto& turn : turns) {
    if (turn.does == nullptr) continue;
    const bool own = turn.robot == robot_;
    Reads(turn.does->effect, turn.robot, false, before_, &state_, own ? &applied_.written : nullptr);
    applied_.events[turn.robot] = turn.does->event;
    if (!own) continue;
    const auto same = [&](const Offered& o) {
      return o.event == turn.does->event && std::ranges::equal(o.effect, turn.does->effect);
    };
    const std::span<const Offered> offered(offered_.data(), offers_);
    if (const auto it = std::ranges::find_if(offered, same); it != offered.end())
      applied_.said.assign(it->said.begin(), it->said.end());
  }
  commands_.Apply(applied_.written);
  Collect();
}

// Often enough that the heap comes to an end of growing soon, and seldom enough that it costs little.
void Node::Collect() {
  if (team_.heap().words_in_use() < collect_at_) return;
  const std::span<const Word> states[] = {state_, real()};
  team_.Collect(states);
  collect_at_ = 4096 + 2 * team_.heap().words_in_use();
}

void Node::Save(std::span<const Word> state, Bytes& out) const {
  Writer writer(out);
  const auto put = [&](Cell cell, size_t robot) {
    cells_.EncodeValueOf(cell, state.subspan(cells_.Address(cell, robot), cells_.Width(cell)), writer);
  };
  for (const Cell cell : cells_.shared()) put(cell, 0);
  for (size_t r = 0; r < team_.robots(); ++r) {
    for (const Cell cell : cells_.own()) put(cell, r);
  }
}

bool Node::Load(View bytes) {
  Reader reader(bytes);
  std::vector<Word> state = state_;
  std::vector<Word> words;
  const auto get = [&](Cell cell, size_t robot) {
    words.clear();
    cells_.DecodeValueOf(cell, reader, words);
    if (reader.ok()) std::ranges::copy(words, state.begin() + cells_.Address(cell, robot));
  };
  for (const Cell cell : cells_.shared()) get(cell, 0);
  for (size_t r = 0; r < team_.robots(); ++r) {
    for (const Cell cell : cells_.own()) get(cell, r);
  }
  if (!reader.Complete()) return false;
  state_ = std::move(state);
  applied_.Clear(0);
  commands_.Load();
  return true;
}

}  // namespace rondo::koord::node
