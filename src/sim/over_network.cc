#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sim/run.h"
#include "sim/start.h"

namespace rondo::sim {

using koord::node::Node;

// The world goes on in steps of the controllers; between them, whatever the network brings happens.
void Run::OverNetwork(double end) {
  networked_ = std::make_unique<Networked>(
      model_, fleet_, options_, bodies_,
      [this](Functions& functions) { return TeamOf(model_, fleet_, functions, diagnostics_); }, diagnostics_,
      static_cast<Stage&>(*this));
  fallen_.resize(bodies_.size());
  runtime::codec::Bytes before;
  store_->Save(before);
  networked_->Start(std::move(before));
  const auto steps = static_cast<uint64_t>(std::ceil(end / periods_.dt - 1e-9));
  const uint64_t round = Every(fleet_.delta, fleet_.step);
  for (uint64_t i = 0; i < steps && report_.ended == Ending::kTime; ++i) {
    const auto at = [&](uint64_t k) { return static_cast<double>(k) * periods_.dt; };
    if (options_.stop.StopRequested()) {
      report_.ended = Ending::kInterrupted;
      break;
    }
    networked_->Until(at(i));
    if (!networked_->broken().empty()) {
      diagnostics_
          .Report(diag::Kind::kKoordFault, {}, fmt::format("at t = {:.6g} s the robots cannot go on", at(i)))
          .Under(networked_->broken())
          .Help("this is a mistake of the round protocol: please report it, with the trace");
      report_.ended = Ending::kFailed;
    }
    // A round that takes longer counts as several, in all but the first of which everybody skips.
    if (settled_at_ >= 0 && at(i) >= settled_at_ + fleet_.delta) Settle(at(i));
    if (report_.ended != Ending::kTime || !Pass(1, at(i), at(i + 1), i + 1 == steps)) break;
    if (options_.progress && (i + 1) % round == 0) options_.progress(report_.time, end);
  }
}

void Run::Settle(double t) {
  Sense();
  for (auto& scans : scans_) scans.clear();
  settled_ = state_;
  settled_at_ = t;
  monitor_->Settled(t, state_);
}

void Run::Read(size_t robot, size_t variable, Heap& heap, std::span<Word> words) {
  for (const Port& port : ports_) {
    if (port.variable == variable) Sense(port, robot, heap, words.data());
  }
}

void Run::Contributed(size_t robot) { seen_[robot].clear(); }

void Run::Committed(uint64_t round, const Node& node) {
  if (settled_at_ >= 0) {
    Sense();
    monitor_->Settled(networked_->now(), state_, true);
  }
  runtime::codec::Bytes bytes;
  node.Save(bytes);
  store_->Load(bytes);
  const std::vector<Word> was = std::exchange(state_, store_->state());
  // Who fell back does what its fallback says until it acts again, whatever the team knows of it.
  for (size_t r = 0; r < fallen_.size(); ++r) {
    for (const koord::node::Cell cell : fallen_[r])
      std::copy_n(was.begin() + store_->cells().Address(cell, r), store_->cells().Width(cell),
                  state_.begin() + store_->cells().Address(cell, r));
  }
  const double t = networked_->now();
  if (round > 1) {
    std::vector<std::string> chosen(bodies_.size());
    for (size_t r = 0; r < node.applied().events.size(); ++r) {
      if (const auto event = node.applied().events[r]) {
        chosen[r] = team_->events()[*event].def->name;
        ++report_.events;
      }
    }
    ++report_.rounds;
    if (recorder_.on()) recorder_.Round(t, {{"round", round - 1}, {"events", chosen}});
  }
  Settle(t);
  After(t);
}

void Run::Acts(size_t robot, Heap& heap, const Node& node, const std::vector<koord::node::Cell>& commands) {
  const double t = networked_->now();
  for (const Port& port : ports_) {
    if (!IsActuator(model_, port)) continue;
    const bool driven = std::ranges::any_of(
        commands, [&](const koord::node::Cell& cell) { return cell.variable == port.variable; });
    if (driven) Obey(port, robot, heap, node.state().data() + At(port, robot), t);
  }
  if (const auto fallen = std::exchange(fallen_[robot], {}); !fallen.empty())
    Sets(robot, node, node.real(), fallen);
  for (const std::string& text : node.applied().said) Say(t, robot, text);
}

void Run::FallsBack(size_t robot, const Node& node, const std::vector<koord::node::Cell>& covered) {
  if (covered.empty()) return;
  fallen_[robot] = covered;
  Sets(robot, node, node.real(), covered);
  for (const Port& port : ports_) {
    if (model_.FallsBack(port.variable) && IsActuator(model_, port))
      Obey(port, robot, team_->heap(), state_.data() + At(port, robot), networked_->now());
  }
}

// Actuators of one robot change in the middle of a round: for this robot, controllers begin anew with what they promise.
void Run::Sets(size_t robot, const Node& node, std::span<const Word> values,
               const std::vector<koord::node::Cell>& actuators) {
  Sense();
  for (const koord::node::Cell cell : actuators) {
    runtime::codec::Bytes bytes;  // lists are handles of the robot's own heap
    runtime::codec::Writer writer(bytes);
    const uint32_t at = node.cells().Address(cell, robot);
    node.cells().EncodeValueOf(cell, values.subspan(at, node.cells().Width(cell)), writer);
    runtime::codec::Reader reader(bytes);
    std::vector<Word> words;
    store_->cells().DecodeValueOf(cell, reader, words);
    std::ranges::copy(words, state_.begin() + at);
  }
  if (settled_at_ < 0) return;
  const uint32_t block = team_->layout().block(robot);
  std::copy_n(state_.begin() + block, team_->layout().block_words(), settled_.begin() + block);
  monitor_->Settled(networked_->now(), state_);
}

void Run::Happens(int robot, const std::string& what) {
  recorder_.Event(networked_->now(), {{"event", "network"}, {"robot", robot}, {"what", what}});
}

void Run::Fails(size_t robot, const koord::node::Failure& failure) {
  Fails(robot, failure, networked_->now());
}

}  // namespace rondo::sim
