#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "sim/run.h"

namespace rondo::sim {

using koord::node::Node;

// The world goes on in steps of the controllers; between them, whatever the network brings happens.
void Run::OverNetwork(double end) {
  networked_ = std::make_unique<Networked>(
      model_, fleet_, options_, bodies_, [this](Functions& functions) { return NewTeam(functions); },
      diagnostics_, static_cast<Stage&>(*this));
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
  runtime::codec::Bytes bytes;
  node.Save(bytes);
  store_->Load(bytes);
  state_ = store_->state();
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

void Run::Acts(size_t robot, Heap& heap, const Node& node) {
  const double t = networked_->now();
  for (const Port& port : ports_) {
    if (port.role != PortRole::kTarget && port.role != PortRole::kPath) continue;
    const bool written = std::ranges::any_of(node.applied().written, [&](const koord::node::Cell& cell) {
      return cell.variable == port.variable;
    });
    // Who got the store from another robot does what it says; who has applied a round, what it wrote.
    if (written || node.applied().events.empty())
      Follow(port, robot, heap, node.state().data() + At(port, robot), t);
  }
  for (const std::string& text : node.applied().said) Say(t, robot, text);
}

void Run::Happens(int robot, const std::string& what) {
  recorder_.Event(networked_->now(), {{"event", "network"}, {"robot", robot}, {"what", what}});
}

void Run::Fails(size_t robot, const koord::node::Failure& failure) {
  Fails(robot, failure, networked_->now());
}

}  // namespace rondo::sim
