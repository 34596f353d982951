#include "driver/simulate_choreography.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/counted.h"
#include "base/parallel.h"
#include "driver/terminal.h"

namespace rondo::driver {
namespace {

using nlohmann::json;
using sim::motions::ChoreographyReport;
using sim::motions::Curtain;
using verdict::ExitStatus;

/// What many runs have in common.
struct Together {
  uint64_t runs = 0;
  double time = 0;
  uint64_t messages = 0, motions = 0;
  double between = std::numeric_limits<double>::infinity(), obstacles = between;
  std::map<Curtain, std::pair<uint64_t, uint64_t>> ended;  // how many runs, and the least seed
  struct Incident {
    sim::motions::Incident first;
    uint64_t seed = 0, runs = 0;
  };
  std::vector<Incident> incidents;
  std::string lost;  // of the least seed
  std::vector<std::string> unchecked;

  void Add(uint64_t seed, const ChoreographyReport& report) {
    ++runs;
    time += report.time;
    messages += report.messages;
    motions += report.motions;
    between = std::min(between, report.least_between_robots);
    obstacles = std::min(obstacles, report.least_to_obstacles);
    auto& [count, least] = ended.try_emplace(report.ended, 0, seed).first->second;
    ++count;
    if (seed <= least) {
      least = seed;
      if (report.ended == Curtain::kLost) lost = report.lost;
    }
    unchecked = report.unchecked;
    for (const sim::motions::Incident& i : report.incidents) {
      const auto it = std::ranges::find_if(incidents, [&](const Incident& known) {
        return known.first.wrong == i.wrong && known.first.what == i.what;
      });
      if (it == incidents.end()) {
        incidents.push_back({i, seed, 1});
        continue;
      }
      ++it->runs;
      if (seed < it->seed) it->first = i, it->seed = seed;
    }
  }

  // In an order that does not depend on which run ended first.
  void Sort() {
    std::ranges::sort(incidents, {},
                      [](const Incident& i) { return std::tuple(i.seed, i.first.first, i.first.what); });
  }
};

json Finite(double x) { return std::isfinite(x) ? json(x) : json(nullptr); }

class Simulation {
 public:
  explicit Simulation(const SimulateChoreographyOptions& options) : options_(options) {}

  ExitStatus Run() {
    auto staged = runs::StageChoreography(options_.files, session_);
    if (!staged)
      return Refuse("simulate", options_.files.files.front(), options_.json, session_.sources,
                    session_.diagnostics, "");
    const auto begin = std::chrono::steady_clock::now();
    std::string problem;
    {
      ProgressLine line;
      const base::StopToken stop;
      const InterruptScope interrupt(stop);
      if (options_.runs == 1) {
        problem = One(*staged, stop, line);
      } else {
        Many(stop, line);
      }
    }
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (!problem.empty())
      return Refuse("simulate", options_.files.files.front(), options_.json, session_.sources,
                    session_.diagnostics, problem);
    all_.Sort();
    return Tell(staged->cast.graph->source->name.text, staged->cast.graph->robots.size());
  }

 private:
  std::string One(const runs::StagedChoreography& staged, const base::StopToken& stop, ProgressLine& line) {
    sim::motions::ChoreographyOptions run = options_.run;
    run.stop = stop;
    auto last = std::chrono::steady_clock::now();
    run.progress = [&](double time, double end) {
      const auto now = std::chrono::steady_clock::now();
      if (now - last < std::chrono::milliseconds(200)) return;
      last = now;
      line.Show(fmt::format("[{:.0f} of at most {:.0f} s]", time, end));
    };
    const auto report =
        options_.trace.empty()
            ? sim::motions::RunChoreography(staged.cast, run, nullptr)
            : runs::RecordChoreography(staged, run, runs::RecordOf(options_.files, staged, run, session_),
                                       options_.trace);
    if (!report.ok()) return report.error().message;
    all_.Add(options_.run.seed, report.value());
    return "";
  }

  // Each thread has a choreography of its own: motions become terms as they are called.
  void Many(const base::StopToken& stop, ProgressLine& line) {
    const uint64_t cores = std::max(1U, std::thread::hardware_concurrency());
    const auto jobs = static_cast<unsigned>(
        std::min({options_.runs, options_.jobs == 0 ? cores : options_.jobs, 4 * cores}));
    std::atomic<uint64_t> next{0}, done{0};
    std::mutex mutex;
    base::ParallelFor(jobs, jobs, [&](size_t) {
      if (stop.StopRequested()) return;
      workspace::Session session;
      const auto staged = runs::StageChoreography(options_.files, session);
      while (staged && !stop.StopRequested()) {
        const uint64_t k = next++;
        if (k >= options_.runs) return;
        sim::motions::ChoreographyOptions run = options_.run;
        run.seed += k;
        run.stop = stop;
        const auto report = sim::motions::RunChoreography(staged->cast, run, nullptr);
        const std::lock_guard lock(mutex);
        all_.Add(options_.run.seed + k, report);
        line.Show(fmt::format("[{} of {} runs]", ++done, options_.runs));
      }
    });
  }

  ExitStatus Tell(const std::string& name, size_t robots) const {
    ExitStatus status = ExitStatus::kEstablished;
    if (!all_.unchecked.empty() || all_.ended.contains(Curtain::kLost) ||
        all_.ended.contains(Curtain::kInterrupted) || all_.runs < options_.runs)
      status = ExitStatus::kUndecided;
    if (!all_.incidents.empty()) status = ExitStatus::kRejected;
    if (options_.json) {
      PrintJson(Json(name, status));
      return status;
    }
    Print(fmt::format("{}: {}, {}\n{}", name, base::Counted(robots, "robot"),
                      options_.runs == 1
                          ? fmt::format("seed {}", options_.run.seed)
                          : fmt::format("{} of {} runs, seeds {} to {}", all_.runs, options_.runs,
                                        options_.run.seed, options_.run.seed + options_.runs - 1),
                      Text()));
    if (!options_.trace.empty()) Print(fmt::format("trace: {}\n", options_.trace));
    PrintDiagnostics(session_.sources, session_.diagnostics);
    return status;
  }

  std::string Text() const {
    std::string text =
        fmt::format("  {:.6g} s, {}, {}{}\n", all_.time, base::Counted(all_.messages, "message"),
                    base::Counted(all_.motions, "motion"),
                    seconds_ > 0.005 ? fmt::format("; {:.1f} x real time", all_.time / seconds_) : "");
    for (const Together::Incident& i : all_.incidents) {
      text +=
          fmt::format("  {}: {}\n    first at {:.6g} s", Name(i.first.wrong), i.first.what, i.first.first);
      if (i.first.count > 1) text += fmt::format(", {} times", i.first.count);
      if (options_.runs > 1)
        text += fmt::format(" of the run with `--seed {}`; in {}", i.seed, base::Counted(i.runs, "run"));
      text += "\n";
    }
    if (all_.incidents.empty()) text += "  no collision, no broken contract; looked at every 0.01 s\n";
    if (std::isfinite(all_.between))
      text += fmt::format("  robots never closer than {:.3f} m\n", all_.between);
    if (std::isfinite(all_.obstacles))
      text += fmt::format("  obstacles never closer than {:.3f} m\n", all_.obstacles);
    for (const std::string& what : all_.unchecked) text += fmt::format("  not checked: {}\n", what);
    for (const auto& [curtain, runs] : all_.ended) text += Ending(curtain, runs.first, runs.second);
    return text;
  }

  std::string Ending(Curtain curtain, uint64_t runs, uint64_t seed) const {
    const std::string who = options_.runs == 1 ? "" : base::Counted(runs, "run") + ": ";
    const std::string which = options_.runs == 1 ? "" : fmt::format(" (such as `--seed {}`)", seed);
    switch (curtain) {
      case Curtain::kEnd:
        return fmt::format("  {}every robot is at its end\n", who);
      case Curtain::kTime:
        return fmt::format("  {}the time was over; `--duration` gives more\n", who);
      case Curtain::kFailed:
        return fmt::format("  {}it could not go on{}\n", who, which);
      case Curtain::kLost:
        return fmt::format("  {}ended early{}: {}\n", who, which, all_.lost);
      case Curtain::kInterrupted:
        return fmt::format("  {}interrupted\n", who);
    }
    return "";
  }

  json Json(const std::string& name, ExitStatus status) const {
    json incidents = json::array(), ended = json::object();
    for (const Together::Incident& i : all_.incidents) {
      incidents.push_back({{"kind", Name(i.first.wrong)},
                           {"what", i.first.what},
                           {"first", i.first.first},
                           {"count", i.first.count},
                           {"seed", i.seed},
                           {"runs", i.runs}});
    }
    for (const auto& [curtain, runs] : all_.ended) ended[std::string(Name(curtain))] = runs.first;
    return {{"command", "simulate"},
            {"file", options_.files.files.front()},
            {"choreography", name},
            {"seed", options_.run.seed},
            {"runs", all_.runs},
            {"time", all_.time},
            {"messages", all_.messages},
            {"motions", all_.motions},
            {"incidents", incidents},
            {"ended", ended},
            {"lost", all_.lost},
            {"least_between_robots", Finite(all_.between)},
            {"least_to_obstacles", Finite(all_.obstacles)},
            {"unchecked", all_.unchecked},
            {"seconds", seconds_},
            {"status", status},
            {"diagnostics", diag::RenderJson(session_.sources, session_.diagnostics)}};
  }

  const SimulateChoreographyOptions& options_;
  workspace::Session session_;
  Together all_;
  double seconds_ = 0;
};

}  // namespace

ExitStatus SimulateChoreography(const SimulateChoreographyOptions& options) {
  return Simulation(options).Run();
}

}  // namespace rondo::driver
