#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/uniform.h"
#include "sim/run.h"

namespace rondo::sim {

using diag::Kind;
using koord::semantics::RoundExecution;

void Run::Round(uint64_t k) {
  const double t = static_cast<double>(k) * fleet_.delta;
  RoundExecution round(*team_);
  round.Begin(state_);
  std::vector<std::string> chosen(bodies_.size());
  bool idle = true;
  for (const size_t r : Order(k)) {
    const auto enabled = round.Enabled(r);
    if (enabled.empty()) continue;
    idle = false;
    const bool urgent = team_->events()[enabled[0]].urgent;
    if (!urgent && fleet_.skip > 0 && base::Uniform(random_) < fleet_.skip) continue;
    const uint32_t event = Choose(enabled, k, r);
    switch (round.Run(r, event)) {
      case RoundExecution::Ran::kDone:
        chosen[r] = team_->events()[event].def->name;
        ++report_.events;
        break;
      case RoundExecution::Ran::kNoLock:
        break;
      case RoundExecution::Ran::kFailed:
        Fails(r, {event, round.fault(), round.fault_span()}, t);
        return;
    }
  }
  round.Finish();
  ++report_.rounds;
  monitor_->Summary(t);
  Command(round.writes(), t);
  for (const auto& [robot, text] : functions_.TakeLog()) Say(t, robot, text);
  if (recorder_.on()) recorder_.Round(t, {{"round", k}, {"events", chosen}});
  monitor_->Settled(t, state_);
  Environment(t);
  monitor_->Between(t + fleet_.delta, state_);
  After(t + fleet_.delta);
  // Sensors that see noise may see something new; the others only if something moves, or `reached` is still to come.
  idle = idle && AtRest() && (!periods_.scans || fleet_.lidar.noise == 0);
  quiet_since_ = idle ? std::min(quiet_since_, t) : kNeverQuiet;
  if (report_.ended == Ending::kTime && t + fleet_.delta - quiet_since_ >= std::max(2.0, 2 * fleet_.delta))
    report_.ended = Ending::kQuiet;
}

bool Run::AtRest() const {
  return std::ranges::all_of(bodies_, [](const auto& body) { return body->AtRest(); });
}

std::vector<size_t> Run::Order(uint64_t k) {
  std::vector<size_t> order(bodies_.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  if (fleet_.policy == Policy::kRoundRobin)
    std::rotate(order.begin(), order.begin() + static_cast<ptrdiff_t>(k % order.size()), order.end());
  if (fleet_.policy == Policy::kRandom) {
    for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random_() % i]);
  }
  return order;
}

uint32_t Run::Choose(std::span<const uint32_t> enabled, uint64_t k, size_t robot) {
  switch (fleet_.policy) {
    case Policy::kFirst:
      return enabled[0];
    case Policy::kRandom:
      return enabled[random_() % enabled.size()];
    case Policy::kRoundRobin:
      return enabled[(k + robot) % enabled.size()];
  }
  return enabled[0];
}

void Run::Fails(size_t robot, const koord::node::Failure& failure, double t) {
  diagnostics_
      .Report(Kind::kKoordFault, failure.span,
              fmt::format("robot {} fails at t = {:.6g} s: {}", robot, t, Describe(failure.fault)))
      .Under(failure.event < team_->events().size()
                 ? fmt::format("in event `{}`", team_->events()[failure.event].def->name)
                 : std::string("in `init`"));
  recorder_.Event(t, {{"event", "fault"}, {"robot", robot}, {"what", Describe(failure.fault)}});
  report_.ended = Ending::kFailed;
}

void Run::Say(double t, size_t robot, const std::string& text) {
  recorder_.Event(t, {{"event", "log"}, {"robot", robot}, {"text", text}});
  report_.log.push_back(fmt::format("[{:.6g} s] {}: {}", t, fleet_.robots[robot].name, text));
  if (report_.log.size() > 20) report_.log.erase(report_.log.begin());
}

// What was written to actuators goes to the bodies.
void Run::Command(const std::vector<RoundExecution::Write>& writes, double t) {
  std::set<std::pair<size_t, size_t>> told;  // robot, port
  const koord::semantics::Layout& layout = team_->layout();
  for (const auto& w : writes) {
    if (w.at < layout.shared_words()) continue;
    const size_t robot = (w.at - layout.shared_words()) / layout.block_words();
    const uint32_t offset = w.at - layout.block(robot);
    for (size_t p = 0; p < ports_.size(); ++p) {
      const auto& place = layout[ports_[p].variable];
      if (offset < place.at || offset >= place.at + place.width) continue;
      if (IsActuator(model_, ports_[p])) told.emplace(robot, p);
    }
  }
  for (const auto& [robot, p] : told)
    Obey(ports_[p], robot, team_->heap(), state_.data() + At(ports_[p], robot), t);
}

void Run::Obey(const Port& port, size_t robot, const Heap& heap, const Word* at, double t) {
  if (port.role == PortRole::kPath && !port.own[robot]) recorder_.Path(t, robot, DecodePath(heap, *at));
  sim::Obey(port, robot, heap, at, *bodies_[robot]);
}

// The shared map, if the program has one.
std::optional<GridMap> Run::SharedMap() const {
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    const koord::Variable& variable = model_.variables[v];
    if (variable.kind != koord::VariableKind::kAllwrite ||
        model_.types[variable.type].kind != lang::TypeKind::kOpaque)
      continue;
    if (auto map = DecodeMap(team_->heap(), state_[team_->layout().Address(v, 0)])) return map;
  }
  return std::nullopt;
}

void Run::After(double t) {
  if (report_.ended == Ending::kFailed) return;
  bool stopped = true;
  for (size_t r = 0; r < bodies_.size(); ++r)
    stopped = stopped && state_[team_->layout().block(r) + team_->layout().stopped()] != 0;
  if (stopped && AtRest() && fleet_.until != Until::kMapped) report_.ended = Ending::kStopped;
  const auto map = SharedMap();
  if (map && map->cells != last_map_) {
    last_map_ = map->cells;
    recorder_.Map(t, *map);
  }
  if (fleet_.until == Until::kMapped && map) {
    Point nowhere{};
    const bool more = std::any_of(bodies_.begin(), bodies_.end(), [&](const auto& body) {
      return Frontier(*map, body->position(), nowhere);
    });
    const int column = map->Column(bodies_[0]->position()[0]);
    const int row = map->Row(bodies_[0]->position()[1]);
    if (!more && map->Inside(column, row) && map->At(column, row) == GridMap::kEmpty)
      report_.ended = Ending::kMapped;
  }
  if (team_->heap().words_in_use() > collect_at_) {
    const std::span<const Word> roots[] = {state_, settled_};
    std::vector<std::span<const Word>> all(std::begin(roots), std::end(roots));
    team_->Collect(all);
    collect_at_ = std::max<size_t>(2'000'000, 2 * team_->heap().words_in_use());
  }
}

}  // namespace rondo::sim
