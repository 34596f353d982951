#include "koord/node/node.h"

#include <algorithm>

#include "base/mixed.h"
#include "koord/semantics/fallback.h"
#include "runtime/rounds/merge.h"

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
  offered_.clear();
  applied_ = {};
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
  commands_.FallBack(std::move(seen));
  return commands_.covered();
}

void Node::EncodeEffect(const Effect& effect, Bytes& out) const {
  // Whole cells; of one that is written in parts, all words.
  std::vector<std::pair<Cell, std::vector<Word>>> written;
  const auto cell_of = [&](Cell cell) -> std::vector<Word>& {
    for (auto& [known, words] : written) {
      if (known == cell) return words;
    }
    const auto at = state_.begin() + cells_.Address(cell, robot_);
    written.emplace_back(cell, std::vector<Word>(at, at + cells_.Width(cell)));
    return written.back().second;
  };
  for (const Effect::Write& write : effect.own) {
    const Cell cell = cells_.At(write.at);
    cell_of(cell)[write.at - cells_.Address(cell, robot_)] = write.value;
  }
  for (const Effect::Shared& shared : effect.shared) {
    for (uint32_t k = 0; k < shared.unit.width; ++k) {
      const uint32_t at = shared.unit.at + k;
      const Cell cell = cells_.At(at);
      cell_of(cell)[at - cells_.Address(cell, robot_)] = effect.words[shared.values + k];
    }
  }
  Writer writer(out);
  writer.Number(written.size());
  for (const auto& [cell, words] : written) cells_.Encode(cell, words, writer);
}

size_t Node::First(uint64_t round, std::span<const Effect> effects) const {
  if (effects.empty()) return 0;
  if (choose_) return choose_(round, robot_, effects);
  return base::Mixed(seed_ ^ base::Mixed(round * 1024 + robot_)) % effects.size();
}

void Node::Contribute(uint64_t round, Bytes& out) {
  // The robot sees the world as it is now; the store gets that with the frame.
  std::vector<Word> seen = state_;
  Bytes inputs;
  Writer writer(inputs);
  const std::vector<Cell> apart = commands_.Tell(state_);
  writer.Number(cells_.sensors().size() + apart.size());
  for (const Cell cell : cells_.sensors()) {
    const std::span<Word> words(seen.data() + cells_.Address(cell, robot_), cells_.Width(cell));
    if (sensors_ != nullptr) sensors_->Read(robot_, round, cell, words);
    cells_.Encode(cell, words, writer);
  }
  for (const Cell cell : apart) {
    const uint32_t at = cells_.Address(cell, robot_);
    std::copy_n(real().begin() + at, cells_.Width(cell), seen.begin() + at);
    cells_.Encode(cell, std::span(seen).subspan(at, cells_.Width(cell)), writer);
  }
  std::swap(seen, state_);
  if (round == 0)
    transition_.PrepareInit(state_);
  else
    transition_.Prepare(state_, robot_);
  const auto effects = transition_.Of(robot_);
  runtime::rounds::Contribution contribution;
  offered_.clear();
  offered_.reserve(effects.size());
  failed_.reset();
  const size_t first = First(round, effects);
  if (first < effects.size() && effects[first].fault != semantics::Fault::kNone)
    failed_ = {round == 0 ? kInit : effects[first].event, effects[first].fault, effects[first].fault_span};
  const size_t count =
      first < effects.size() ? std::min(effects.size(), runtime::rounds::kMostAlternatives) : 0;
  for (size_t i = 0; i < count; ++i) {
    const Effect& effect = effects[(first + i) % effects.size()];
    if (effect.fault != semantics::Fault::kNone) continue;
    Offered& offered = offered_.emplace_back();
    offered.event = effect.event;
    EncodeEffect(effect, offered.effect);
    for (const semantics::Said& said : effect.said)
      offered.said.push_back(team_.ShowLogged(said.type, said.value));
    contribution.alternatives.push_back({effect.event, effect.locks, offered.effect});
    if (!effect.locks) break;  // nothing can take it away
  }
  std::swap(seen, state_);
  contribution.inputs = inputs;
  runtime::rounds::Encode(contribution, out);
}

// Reads cells and, if there is a state, puts them there; `cells` gets which they were.
bool Node::Reads(View bytes, uint32_t robot, bool inputs, std::vector<Word>* state,
                 std::vector<Cell>* cells) const {
  if (bytes.empty()) return inputs;  // nothing new
  Reader reader(bytes);
  const size_t count = reader.Number(bytes.size());
  std::vector<Word> words;
  for (size_t i = 0; i < count && reader.ok(); ++i) {
    words.clear();
    const Cell cell = cells_.Decode(reader, words);
    if (!reader.ok()) return false;
    const bool sensor = cells_.Kind(cell) == VariableKind::kSensor;
    if (inputs ? !sensor && !commands_.IsCovered(cell) : sensor) return false;
    if (state != nullptr) std::ranges::copy(words, state->begin() + cells_.Address(cell, robot));
    if (cells != nullptr) cells->push_back(cell);
  }
  return reader.Complete();
}

bool Node::Accepts(uint32_t robot, View inputs, std::span<const Alternative> alternatives) const {
  if (!Reads(inputs, robot, true, nullptr)) return false;
  return std::ranges::all_of(alternatives, [&](const Alternative& a) {
    return a.event <= team_.events().size() && Reads(a.effect, robot, false, nullptr);
  });
}

void Node::Apply(uint64_t, std::span<const runtime::rounds::Turn> turns) {
  for (const auto& turn : turns) Reads(turn.inputs, turn.robot, true, &state_);
  applied_ = {};
  applied_.events.resize(team_.robots());
  for (const auto& turn : turns) {
    if (turn.does == nullptr) continue;
    const bool own = turn.robot == robot_;
    Reads(turn.does->effect, turn.robot, false, &state_, own ? &applied_.written : nullptr);
    applied_.events[turn.robot] = turn.does->event;
    if (!own) continue;
    const auto same = [&](const Offered& o) {
      return o.event == turn.does->event && std::ranges::equal(o.effect, turn.does->effect);
    };
    if (const auto it = std::ranges::find_if(offered_, same); it != offered_.end()) applied_.said = it->said;
  }
  commands_.Apply(applied_.written);
  if (team_.heap().words_in_use() < collect_at_) return;
  const std::span<const Word> states[] = {state_, real()};
  team_.Collect(states);
  collect_at_ = std::max<size_t>(1'000'000, 2 * team_.heap().words_in_use());
}

void Node::Save(Bytes& out) const {
  Writer writer(out);
  const auto put = [&](Cell cell, size_t robot) {
    cells_.EncodeValueOf(cell, std::span(state_).subspan(cells_.Address(cell, robot), cells_.Width(cell)),
                         writer);
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
  applied_ = {};
  commands_.Load();
  return true;
}

}  // namespace rondo::koord::node
