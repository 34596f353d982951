#include "sim/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <set>

#include "base/parallel.h"
#include "koord/semantics/machine/values.h"
#include "koord/semantics/round_execution.h"
#include "sim/functions/functions.h"
#include "sim/monitor.h"
#include "sim/ports.h"
#include "sim/recorder.h"

namespace rondo::sim {
namespace {

using diag::Kind;
using koord::semantics::FromFloat;
using koord::semantics::RoundExecution;
using koord::semantics::Team;
using nlohmann::json;

// A number between 0 and 1, and one from the normal distribution: the same everywhere for the same engine.
double Uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }
double Normal(std::mt19937_64& random) {
  const double u = 1 - Uniform(random);
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * Uniform(random));
}

class Run {
 public:
  Run(const koord::Model& model, const Fleet& fleet, const SimulationOptions& options, trace::Writer* trace,
      diag::Diagnostics& diagnostics)
      : model_(model),
        fleet_(fleet),
        options_(options),
        diagnostics_(diagnostics),
        recorder_(trace, fleet),
        functions_(model, fleet, options.seed),
        random_(options.seed) {}

  SimulationReport Go() {
    ports_ = FindPorts(model_, diagnostics_);
    const bool maps =
        std::any_of(model_.variables.begin(), model_.variables.end(), [&](const koord::Variable& v) {
          return v.kind == koord::VariableKind::kAllwrite && model_.types.Is(v.type, lang::TypeKind::kOpaque);
        });
    if (fleet_.until == "mapped" && !maps)
      diagnostics_.Report(Kind::kFleetValue, fleet_.until_span, "the program draws no shared map");
    if (!MakeTeam() || diagnostics_.has_errors() || !MakeRobots() || !Start()) return std::move(report_);
    report_.ran = true;
    const double end = options_.duration > 0 ? options_.duration : fleet_.duration;
    const auto rounds = static_cast<uint64_t>(std::ceil(end / fleet_.delta - 1e-9));
    report_.ended = Ending::kTime;
    for (uint64_t k = 0; k < rounds && report_.ended == Ending::kTime; ++k) {
      if (options_.stop.StopRequested()) {
        report_.ended = Ending::kInterrupted;
        break;
      }
      Round(k);
      if (options_.progress) options_.progress(report_.time, end);
    }
    Finish();
    return std::move(report_);
  }

 private:
  // -- before the first round

  std::optional<std::vector<Word>> ValueOf(const std::string& name, const FleetValue& given,
                                           size_t variable) {
    auto words =
        koord::semantics::FromJson(model_.types, team_->heap(), model_.variables[variable].type, given.value);
    if (!words) {
      diagnostics_.Report(
          Kind::kFleetValue, given.span,
          fmt::format("`{}` must be a `{}`", name, model_.types.Name(model_.variables[variable].type)));
    }
    return words;
  }

  int Find(const std::string& name) const {
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      if (model_.variables[v].name == name) return static_cast<int>(v);
    }
    return -1;
  }

  bool MakeTeam() {
    koord::semantics::TeamOptions options;
    options.robots = fleet_.robots.size();
    options.hosted = [&](size_t f) { return functions_.Knows(f); };
    const size_t before = diagnostics_.errors();
    for (const auto& [name, given] : fleet_.params) {
      const int v = Find(name);
      if (v < 0 || model_.variables[static_cast<size_t>(v)].kind != koord::VariableKind::kParam) {
        diagnostics_.Report(Kind::kFleetValue, given.span,
                            fmt::format("the program has no parameter `{}`", name));
        continue;
      }
      // Parameters have no lists that need the team's heap but its own: numbers, points, truth values.
      koord::semantics::Heap scratch;
      const auto words = koord::semantics::FromJson(
          model_.types, scratch, model_.variables[static_cast<size_t>(v)].type, given.value);
      if (words) {
        options.params[static_cast<size_t>(v)] = *words;
      } else {
        diagnostics_.Report(Kind::kFleetValue, given.span,
                            fmt::format("`{}` must be a `{}`", name,
                                        model_.types.Name(model_.variables[static_cast<size_t>(v)].type)));
      }
    }
    team_ = Team::Make(model_, options, diagnostics_);
    if (team_ == nullptr || diagnostics_.errors() != before) return false;
    for (const auto& part : team_->unchecked()) {
      report_.unchecked.push_back(part.name);
      diagnostics_
          .Report(Kind::kKoordNotChecked, part.span,
                  fmt::format("runs are not checked against `{}`", part.name))
          .Under(part.reason);
    }
    team_->machine().CheckSummaries(true);
    team_->machine().SetHost(&functions_);
    return true;
  }

  bool MakeRobots() {
    std::vector<double> radii;
    for (size_t r = 0; r < fleet_.robots.size(); ++r) {
      const FleetRobot& robot = fleet_.robots[r];
      auto body = MakeBody(robot.model);
      for (const auto& [name, value] : robot.parameters) body->Set(name, value);
      body->Place(robot.position, robot.yaw);
      radii.push_back(body->radius());
      bodies_.push_back(std::move(body));
      noise_.emplace_back(options_.seed * 0x9e3779b97f4a7c15U + r + 1);
      scans_.emplace_back();
    }
    functions_.Attach(*team_, bodies_);
    contacts_ = std::make_unique<Contacts>(fleet_.world, radii);
    return true;
  }

  uint32_t At(const Port& port, size_t robot) const { return team_->layout().Address(port.variable, robot); }

  void Sense() {
    for (size_t r = 0; r < bodies_.size(); ++r) {
      const Body& body = *bodies_[r];
      for (const Port& port : ports_) {
        Word* at = state_.data() + At(port, r);
        const auto point = [&](const Point& p) {
          for (size_t i = 0; i < 3; ++i) at[i] = FromFloat(p[i] + 0.0);
        };
        switch (port.role) {
          case PortRole::kPosition:
            point(body.position());
            break;
          case PortRole::kVelocity:
            point(body.velocity());
            break;
          case PortRole::kHeading:
            *at = FromFloat(body.yaw() + 0.0);
            break;
          case PortRole::kReached:
            *at = body.reached();
            break;
          case PortRole::kScans:
            *at = team_->heap().Intern(scans_[r]);
            break;
          case PortRole::kTarget:
          case PortRole::kPath:
            break;
        }
      }
    }
  }

  bool Start() {
    const size_t before = diagnostics_.errors();
    state_ = team_->blank();
    Sense();
    koord::semantics::Machine& machine = team_->machine();
    machine.SetMemory(state_.data());
    machine.SetChooser([this](uint64_t possibilities) { return random_() % possibilities; });
    // A robot holds its position until it is told something else.
    for (size_t r = 0; r < bodies_.size(); ++r) {
      const Point p = bodies_[r]->position();
      for (const Port& port : ports_) {
        if (port.role == PortRole::kPath) state_[At(port, r)] = EncodePath(team_->heap(), {p});
        if (port.role == PortRole::kTarget) {
          for (size_t i = 0; i < 3; ++i) state_[At(port, r) + i] = FromFloat(p[i] + 0.0);
        }
      }
    }
    const auto run = [&](const std::vector<koord::semantics::InitialCode>& code) {
      for (const auto& i : code) {
        const bool own = model_.variables[i.variable].PerRobot();
        for (size_t r = 0; r < (own ? bodies_.size() : 1); ++r) {
          if (machine.Run(i.entry, r, false)) continue;
          diagnostics_.Report(Kind::kKoordFault, machine.fault_span(), std::string(Describe(machine.fault())))
              .Under("in an initial value");
          return false;
        }
      }
      return true;
    };
    if (!run(team_->declared())) return false;
    for (const auto& [name, given] : fleet_.initial) {
      const int found = Find(name);
      const auto v = static_cast<size_t>(found);
      const bool good = found >= 0 && model_.variables[v].kind != koord::VariableKind::kSensor &&
                        model_.variables[v].kind != koord::VariableKind::kParam &&
                        team_->layout()[v].exists && team_->layout()[v].length == 0;
      if (!good) {
        diagnostics_.Report(
            Kind::kFleetValue, given.span,
            fmt::format("the program has no variable `{}` that can start with a value", name));
        continue;
      }
      const auto words = ValueOf(name, given, v);
      for (size_t r = 0; words && r < (model_.variables[v].PerRobot() ? bodies_.size() : 1); ++r)
        std::copy(words->begin(), words->end(), state_.begin() + team_->layout().Address(v, r));
    }
    if (diagnostics_.errors() != before) return false;
    machine.SetMemory(state_.data());
    if (!run(team_->derived())) return false;
    if (!Initialise()) return false;
    monitor_ = std::make_unique<Monitor>(*team_, diagnostics_, [this](const Violation& v, bool first) {
      if (first) recorder_.Event(v.first, {{"event", "violation"}, {"what", v.what}, {"robot", v.robot}});
    });
    Record();
    monitor_->Initially(state_);
    Observe(0);
    return true;
  }

  // The blocks of `init`: every robot runs them once, from the declared values.
  bool Initialise() {
    if (team_->inits().empty()) return true;
    koord::semantics::Machine& machine = team_->machine();
    std::vector<Word> memory = state_;
    std::vector<RoundExecution::Write> writes;
    for (size_t r = 0; r < bodies_.size(); ++r) {
      std::vector<koord::semantics::Machine::Write> undo;
      for (const uint32_t entry : team_->inits()) {
        machine.SetMemory(memory.data());
        if (!machine.Run(entry, r, false)) {
          diagnostics_.Report(Kind::kKoordFault, machine.fault_span(), std::string(Describe(machine.fault())))
              .Under("in `init`");
          return false;
        }
        undo.insert(undo.end(), machine.writes().begin(), machine.writes().end());
        if (machine.stopped()) writes.push_back({team_->layout().block(r) + team_->layout().stopped(), 1});
      }
      for (const auto& w : undo) writes.push_back({w.at, memory[w.at]});
      for (auto it = undo.rbegin(); it != undo.rend(); ++it) memory[it->at] = it->before;
    }
    for (const auto& w : writes) state_[w.at] = w.value;
    Command(writes, 0);
    return true;
  }

  void Record() {
    if (!recorder_.on()) return;
    json robots = json::array();
    for (size_t r = 0; r < bodies_.size(); ++r) {
      robots.push_back({{"name", fleet_.robots[r].name},
                        {"model", fleet_.robots[r].model},
                        {"radius", bodies_[r]->radius()}});
    }
    recorder_.Run({{"format", "rondo-trace/1"},
                   {"engine", "simulate"},
                   {"program_name", options_.program_name},
                   {"program", options_.program},
                   {"spec", options_.spec},
                   {"fleet", options_.fleet},
                   {"seed", options_.seed},
                   {"duration", options_.duration},
                   {"delta", fleet_.delta},
                   {"robots", robots}});
    recorder_.World(fleet_);
    for (size_t r = 0; r < bodies_.size(); ++r) recorder_.Pose(0, r, *bodies_[r]);
  }

  // -- a round

  void Round(uint64_t k) {
    const double t = static_cast<double>(k) * fleet_.delta;
    RoundExecution round(*team_);
    round.Begin(state_);
    std::vector<std::string> chosen(bodies_.size());
    for (const size_t r : Order(k)) {
      const auto enabled = round.Enabled(r);
      if (enabled.empty()) continue;
      const bool urgent = team_->events()[enabled[0]].urgent;
      if (!urgent && fleet_.skip > 0 && Uniform(random_) < fleet_.skip) continue;
      const uint32_t event = Choose(enabled, k, r);
      switch (round.Run(r, event)) {
        case RoundExecution::Ran::kDone:
          chosen[r] = team_->events()[event].def->name;
          ++report_.events;
          break;
        case RoundExecution::Ran::kNoLock:
          break;
        case RoundExecution::Ran::kFailed:
          diagnostics_
              .Report(Kind::kKoordFault, round.fault_span(),
                      fmt::format("robot {} fails at t = {:.6g} s: {}", r, t, Describe(round.fault())))
              .Under(fmt::format("in event `{}`", team_->events()[event].def->name));
          recorder_.Event(t, {{"event", "fault"}, {"robot", r}, {"what", Describe(round.fault())}});
          report_.ended = Ending::kFailed;
          return;
      }
    }
    round.Finish();
    ++report_.rounds;
    monitor_->Summary(t);
    Command(round.writes(), t);
    for (const auto& [robot, text] : functions_.TakeLog()) {
      recorder_.Event(t, {{"event", "log"}, {"robot", robot}, {"text", text}});
      report_.log.push_back(fmt::format("[{:.6g} s] {}: {}", t, fleet_.robots[robot].name, text));
      if (report_.log.size() > 20) report_.log.erase(report_.log.begin());
    }
    if (recorder_.on()) recorder_.Round(t, {{"round", k}, {"events", chosen}});
    monitor_->Settled(t, state_);
    Environment(t);
    After(t + fleet_.delta);
  }

  std::vector<size_t> Order(uint64_t k) {
    std::vector<size_t> order(bodies_.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    if (fleet_.policy == Policy::kRoundRobin)
      std::rotate(order.begin(), order.begin() + static_cast<ptrdiff_t>(k % order.size()), order.end());
    if (fleet_.policy == Policy::kRandom) {
      for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random_() % i]);
    }
    return order;
  }

  uint32_t Choose(std::span<const uint32_t> enabled, uint64_t k, size_t robot) {
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

  // What was written to actuators goes to the bodies.
  void Command(const std::vector<RoundExecution::Write>& writes, double t) {
    std::set<std::pair<size_t, size_t>> told;  // robot, port
    const koord::semantics::Layout& layout = team_->layout();
    for (const auto& w : writes) {
      if (w.at < layout.shared_words()) continue;
      const size_t robot = (w.at - layout.shared_words()) / layout.block_words();
      const uint32_t offset = w.at - layout.block(robot);
      for (size_t p = 0; p < ports_.size(); ++p) {
        const auto& place = layout[ports_[p].variable];
        if (offset < place.at || offset >= place.at + place.width) continue;
        if (ports_[p].role == PortRole::kTarget || ports_[p].role == PortRole::kPath) told.emplace(robot, p);
      }
    }
    for (const auto& [robot, p] : told) {
      const Word* at = state_.data() + At(ports_[p], robot);
      std::vector<Point> path;
      if (ports_[p].role == PortRole::kPath)
        path = DecodePath(team_->heap(), *at);
      else
        path = {{koord::semantics::ToFloat(at[0]), koord::semantics::ToFloat(at[1]),
                 koord::semantics::ToFloat(at[2])}};
      if (ports_[p].role == PortRole::kPath || path != bodies_[robot]->path()) {
        if (ports_[p].role == PortRole::kPath) recorder_.Path(t, robot, path);
        bodies_[robot]->Follow(std::move(path));
      }
    }
  }

  // -- the environment's turn

  // How many controller periods from one instant of this kind to the next?
  static uint64_t Every(double period, double step) {
    return std::max<uint64_t>(1, static_cast<uint64_t>(std::llround(period / step)));
  }

  void Environment(double t) {
    const uint64_t steps = Every(fleet_.delta, fleet_.step);
    const double dt = fleet_.delta / static_cast<double>(steps);
    const uint64_t monitor = Every(fleet_.monitor, dt);
    const uint64_t pose = Every(1 / fleet_.pose_rate, dt);
    const uint64_t scan = Every(1 / fleet_.lidar.rate, dt);
    // Small teams are looked at after every step: fast robots are through each other soon.
    const uint64_t touch = bodies_.size() <= 100 ? 1 : monitor;
    report_.observed_every = static_cast<double>(touch) * dt;
    const bool scans =
        std::any_of(ports_.begin(), ports_.end(), [](const Port& p) { return p.role == PortRole::kScans; });
    settled_ = state_;
    for (auto& s : scans_) s.clear();
    for (uint64_t i = 0; i < steps;) {
      // Up to the next instant at which something is looked at.
      uint64_t n = 1;
      const auto due = [&](uint64_t every) { return (step_ + n) % every == 0; };
      while (i + n < steps && !due(monitor) && !due(pose) && !due(touch) && !(scans && due(scan))) ++n;
      if (!Move(n, dt, t + static_cast<double>(i) * dt)) return;
      i += n;
      step_ += n;
      const double now = t + static_cast<double>(i) * dt;
      report_.time = now;
      if (step_ % pose == 0) {
        for (size_t r = 0; r < bodies_.size(); ++r) recorder_.Pose(now, r, *bodies_[r]);
      }
      if (scans && step_ % scan == 0) Scan(now);
      if (step_ % touch == 0 || i == steps) Observe(now);
      if (step_ % monitor == 0 || i == steps) {
        Sense();
        monitor_->During(now, state_, settled_);
      }
    }
    report_.time = t + fleet_.delta;
  }

  // All bodies, on their own: the result does not depend on the number of threads.
  bool Move(uint64_t n, double dt, double t) {
    const size_t chunks = bodies_.size() < 64 ? 1 : 8;
    std::vector<int> bad(chunks, -1);
    const auto work = [&](size_t chunk) {
      for (size_t r = chunk; r < bodies_.size(); r += chunks) {
        for (uint64_t k = 0; k < n; ++k) {
          if (!bodies_[r]->Step(dt, fleet_.integrator) && bad[chunk] < 0) bad[chunk] = static_cast<int>(r);
          if (bad[chunk] >= 0) return;
        }
      }
    };
    if (chunks == 1)
      work(0);
    else
      base::ParallelFor(chunks, options_.jobs, work);
    int robot = -1;
    for (const int b : bad) {
      if (b >= 0 && (robot < 0 || b < robot)) robot = b;
    }
    if (robot < 0) return true;
    const FleetRobot& who = fleet_.robots[static_cast<size_t>(robot)];
    diagnostics_
        .Report(Kind::kFleetValue, who.span,
                fmt::format("the state of `{}` is not finite behind t = {:.6g} s", who.name, t))
        .Under(fmt::format("model `{}` with these parameters", who.model))
        .Help("a smaller `step` in `[run]`, or other parameters, may help");
    report_.ended = Ending::kFailed;
    return false;
  }

  void Scan(double now) {
    std::vector<Rays> all(bodies_.size());
    const auto work = [&](size_t r) {
      Rays& rays = all[r];
      const int beams = fleet_.lidar.beams;
      rays.first = bodies_[r]->yaw() - std::numbers::pi;
      rays.step = 2 * std::numbers::pi / beams;
      rays.range = fleet_.lidar.range;
      rays.distances.resize(static_cast<size_t>(beams));
      const Point from = bodies_[r]->position();
      for (int b = 0; b < beams; ++b) {
        double d = fleet_.world.Cast(from, rays.first + b * rays.step, rays.range);
        if (std::isfinite(d)) {
          if (fleet_.lidar.noise > 0) d += fleet_.lidar.noise * Normal(noise_[r]);
          if (fleet_.lidar.resolution > 0)
            d = std::round(d / fleet_.lidar.resolution) * fleet_.lidar.resolution;
          d = std::max(d, 0.0);
        }
        rays.distances[static_cast<size_t>(b)] = d;
      }
    };
    if (bodies_.size() < 16) {
      for (size_t r = 0; r < bodies_.size(); ++r) work(r);
    } else {
      base::ParallelFor(bodies_.size(), options_.jobs, work);
    }
    for (size_t r = 0; r < bodies_.size(); ++r) {
      recorder_.Scan(now, r, all[r], bodies_[r]->yaw(), 1 / fleet_.lidar.rate);
      for (const double x : bodies_[r]->position()) scans_[r].push_back(FromFloat(x + 0.0));
      scans_[r].push_back(EncodeRays(team_->heap(), all[r]));
    }
  }

  // Collisions and distances.
  void Observe(double now) {
    std::vector<Point> positions;
    for (const auto& body : bodies_) positions.push_back(body->position());
    contacts_->Move(positions);
    const auto touching = contacts_->Touching();
    const std::set<std::pair<int, int>> pairs(touching.begin(), touching.end());
    const auto name = [&](int who) {
      if (who >= 0) return fleet_.robots[static_cast<size_t>(who)].name;
      const auto number = static_cast<size_t>(-1 - who);
      const size_t boxes = fleet_.world.boxes.size();
      return number < boxes ? fmt::format("box {}", number) : fmt::format("cylinder {}", number - boxes);
    };
    for (const auto& [a, b] : pairs) {
      if (touching_.contains({a, b})) continue;
      if (report_.collisions++ == 0) {
        report_.first_collision = now;
        report_.first_pair = fmt::format("{} and {}", name(a), name(b));
      }
      recorder_.Event(now, {{"event", "collision"}, {"robot", name(a)}, {"with", name(b)}});
    }
    touching_ = pairs;
    if (bodies_.size() > 200) return;
    report_.least_between_robots = std::min(report_.least_between_robots, contacts_->LeastBetweenRobots());
    report_.least_to_obstacles = std::min(report_.least_to_obstacles, contacts_->LeastToObstacles());
  }

  // -- between rounds

  // The shared map, if the program has one.
  std::optional<GridMap> SharedMap() const {
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      const koord::Variable& variable = model_.variables[v];
      if (variable.kind != koord::VariableKind::kAllwrite ||
          model_.types[variable.type].kind != lang::TypeKind::kOpaque)
        continue;
      if (auto map = DecodeMap(team_->heap(), state_[team_->layout().Address(v, 0)])) return map;
    }
    return std::nullopt;
  }

  void After(double t) {
    if (report_.ended == Ending::kFailed) return;
    bool stopped = true;
    for (size_t r = 0; r < bodies_.size(); ++r)
      stopped = stopped && state_[team_->layout().block(r) + team_->layout().stopped()] != 0;
    if (stopped && fleet_.until != "mapped") report_.ended = Ending::kStopped;
    const auto map = SharedMap();
    if (map && map->cells != last_map_) {
      last_map_ = map->cells;
      recorder_.Map(t, *map);
    }
    if (fleet_.until == "mapped" && map) {
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

  // Cells that a robot could come to from where the robots are.
  static std::vector<bool> Reachable(const GridMap& map, const World& world,
                                     const std::vector<Point>& starts) {
    std::vector<bool> seen(map.cells.size());
    std::vector<std::pair<int, int>> stack;
    for (const Point& p : starts) stack.emplace_back(map.Column(p[0]), map.Row(p[1]));
    while (!stack.empty()) {
      const auto [c, r] = stack.back();
      stack.pop_back();
      if (!map.Inside(c, r)) continue;
      const size_t at = static_cast<size_t>(r) * static_cast<size_t>(map.columns) + static_cast<size_t>(c);
      if (seen[at] || TrulyOccupied(map, world, c, r)) continue;
      seen[at] = true;
      for (const auto& [dc, dr] : {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)})
        stack.emplace_back(c + dc, r + dr);
    }
    return seen;
  }

  void Finish() {
    report_.violations = monitor_->violations();
    report_.plans = functions_.plans();
    if (const auto map = SharedMap()) {
      std::vector<Point> starts;
      for (const FleetRobot& robot : fleet_.robots) starts.push_back(robot.position);
      const std::vector<bool> reachable = Reachable(*map, fleet_.world, starts);
      for (int r = 0; r < map->rows; ++r) {
        for (int c = 0; c < map->columns; ++c) {
          const int8_t cell = map->At(c, r);
          if (cell != GridMap::kUnknown) ++report_.known_cells;
          if (cell == GridMap::kOccupied && !TrulyOccupied(*map, fleet_.world, c, r)) ++report_.wrong_cells;
          const size_t at =
              static_cast<size_t>(r) * static_cast<size_t>(map->columns) + static_cast<size_t>(c);
          if (cell == GridMap::kUnknown && reachable[at]) ++report_.reachable_unknown;
        }
      }
    }
    recorder_.Event(report_.time,
                    {{"event", "end"}, {"why", Name(report_.ended)}, {"rounds", report_.rounds}});
  }

  const koord::Model& model_;
  const Fleet& fleet_;
  const SimulationOptions& options_;
  diag::Diagnostics& diagnostics_;
  Recorder recorder_;
  Functions functions_;
  std::unique_ptr<Team> team_;
  std::vector<Port> ports_;
  std::vector<std::unique_ptr<Body>> bodies_;
  std::vector<std::mt19937_64> noise_;
  std::vector<std::vector<Word>> scans_;  // by robot: of this round
  std::unique_ptr<Contacts> contacts_;
  std::unique_ptr<Monitor> monitor_;
  std::set<std::pair<int, int>> touching_;
  std::mt19937_64 random_;
  std::vector<Word> state_;
  std::vector<Word> settled_;
  std::vector<int8_t> last_map_;
  uint64_t step_ = 0;
  size_t collect_at_ = 2'000'000;
  SimulationReport report_;
};

}  // namespace

std::string_view Name(Ending ending) {
  switch (ending) {
    case Ending::kTime:
      return "time";
    case Ending::kStopped:
      return "stopped";
    case Ending::kMapped:
      return "mapped";
    case Ending::kInterrupted:
      return "interrupted";
    case Ending::kFailed:
      return "failed";
  }
  return "";
}

SimulationReport Simulate(const koord::Model& model, const Fleet& fleet, const SimulationOptions& options,
                          trace::Writer* trace, diag::Diagnostics& diagnostics) {
  return Run(model, fleet, options, trace, diagnostics).Go();
}

}  // namespace rondo::sim
