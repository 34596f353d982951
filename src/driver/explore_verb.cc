#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "base/file.h"
#include "driver/command.h"
#include "driver/page.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "runs/exploration.h"
#include "runs/run_file.h"
#include "runs/run_trace.h"
#include "workspace/koord_files.h"
#include "workspace/places.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

using explore::Ending;

struct Options {
  std::string file;
  std::string spec;
  std::vector<size_t> robots;
  uint32_t depth = 0;
  uint64_t states = 100'000'000;
  uint64_t memory = 0;
  bool deadlock = false;
  bool no_symmetry = false;
  bool no_reduction = false;
  bool compact = false;
  unsigned jobs = 0;
  uint64_t walks = 0;
  uint64_t steps = 1000;
  uint64_t seed = 1;
  std::string save;
  std::string trace;
  bool open = false;
  bool json = false;
};

const char* Word(const runs::Explored& e, const Options& options) {
  if (options.walks > 0) return e.broken ? "a run is broken" : "random walks";
  if (e.left) return "left unfinished";
  switch (e.search.ending) {
    case Ending::kComplete:
      return options.compact ? "complete up to hash collisions" : "complete";
    case Ending::kDepth:
      return "up to the depth";
    case Ending::kStates:
      return "too many states";
    case Ending::kMemory:
      return "too much memory";
    case Ending::kStopped:
      return "interrupted";
    case Ending::kBroken:
    case Ending::kDeadlock:
      return "a run is broken";
  }
  return "";
}

// Events and branches that no size reached, if all were explored completely.
void Coverage(const koord::Model& model, const std::vector<runs::Explored>& all,
              diag::Diagnostics& diagnostics) {
  for (size_t e = 0; e < model.events.size(); ++e) {
    if (std::any_of(all.begin(), all.end(), [&](const runs::Explored& x) { return x.enabled[e] > 0; }))
      continue;
    diagnostics
        .Report(diag::Kind::kKoordNeverHappened, model.events[e]->span,
                fmt::format("event `{}` was never enabled", model.events[e]->name))
        .Under("in no reachable state");
  }
  for (size_t b = 0; b < all[0].branch_spans.size(); ++b) {
    const diag::Span span = all[0].branch_spans[b];
    if (span.begin == span.end) continue;
    if (std::any_of(all.begin(), all.end(), [&](const runs::Explored& x) { return x.branches[b]; })) continue;
    const bool otherwise = b > 0 && all[0].branch_spans[b - 1].begin == span.begin;
    diagnostics.Report(diag::Kind::kKoordNeverHappened, span,
                       otherwise ? "the `else` of this condition was never reached"
                                 : "this condition was never true where it was reached");
  }
}

std::string Table(const std::vector<runs::Explored>& all, const Options& options) {
  std::string text;
  for (const runs::Explored& e : all) {
    if (e.unusable) continue;
    const double rate = e.search.seconds > 0 ? static_cast<double>(e.search.states) / e.search.seconds : 0;
    const std::string size =
        options.walks > 0
            ? fmt::format("{}, {}", base::Counted(e.walked, "walk"),
                          base::Counted(e.search.transitions, "step"))
            : fmt::format("{}, {}, {}",
                          base::Counted(e.search.states, e.symmetric ? "state up to renaming" : "state"),
                          base::Counted(e.search.transitions, "transition"),
                          base::Counted(e.rounds, "round"));
    std::string fixed = size;
    if (const size_t at = fixed.find("state up to renamings"); at != std::string::npos)
      fixed.replace(at, 21, "states up to renaming");
    text +=
        fmt::format("  N = {:<3} {:58} {:12} {:8.2f} s", e.robots, fixed, Word(e, options), e.search.seconds);
    if (e.search.seconds > 0.5) text += fmt::format("  {:.0f} states/s", rate);
    text += "\n";
  }
  return text;
}

nlohmann::json ToJson(const runs::Explored& e, const Options& options, const koord::Model& model) {
  nlohmann::json events = nlohmann::json::object();
  for (size_t i = 0; i < e.enabled.size(); ++i) events[model.events[i]->name] = e.enabled[i];
  return {{"robots", e.robots},
          {"ending", Word(e, options)},
          {"states", e.search.states},
          {"transitions", e.search.transitions},
          {"rounds", e.rounds},
          {"symmetric", e.symmetric},
          {"seconds", e.search.seconds},
          {"bytes", e.search.bytes},
          {"enabled", events},
          {"unchecked", e.unchecked},
          {"zero_at_start", e.zeroed},
          {"broken", e.property.empty() ? nlohmann::json(nullptr) : nlohmann::json(e.property)}};
}

ExitStatus StatusOf(const std::vector<runs::Explored>& all, const Options& options) {
  bool undecided = false;
  for (const runs::Explored& e : all) {
    if (e.broken || e.unusable) return ExitStatus::kRejected;
    const bool cut = e.search.ending == Ending::kStates || e.search.ending == Ending::kMemory ||
                     e.search.ending == Ending::kStopped;
    undecided = undecided || cut || e.stuck || !e.unchecked.empty() ||
                (options.walks > 0 && e.walked < options.walks);
  }
  return undecided ? ExitStatus::kUndecided : ExitStatus::kEstablished;
}

// Three quarters of what the machine has: who takes more is ended by it, with nothing to show.
size_t UsableMemory() {
  const auto pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGESIZE);
  return pages <= 0 || size <= 0 ? SIZE_MAX : static_cast<size_t>(pages) / 4 * 3 * static_cast<size_t>(size);
}

ExitStatus Run(const Options& options) {
  workspace::Session session;
  std::vector<runs::Explored> all;
  const auto loaded = workspace::LoadKoord({options.file, options.spec, true}, session);
  std::vector<size_t> sizes = options.robots;
  if (loaded) {
    const std::vector<size_t> declared = runs::DeclaredSizes(loaded->model, session.diagnostics);
    if (sizes.empty()) sizes = declared.empty() ? std::vector<size_t>{1, 2, 3} : declared;
  }
  std::sort(sizes.begin(), sizes.end());
  sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
  const bool good = !session.diagnostics.has_errors();
  runs::ExplorationOptions exploration;
  if (options.depth > 0) exploration.rounds = options.depth;
  exploration.states = options.states;
  exploration.memory = options.memory > 0 ? options.memory << 20 : UsableMemory();
  exploration.compact = options.compact;
  exploration.deadlocks = options.deadlock;
  exploration.reduce = !options.no_reduction;
  exploration.symmetry = !options.no_symmetry;
  exploration.jobs = options.jobs;
  exploration.walks = options.walks;
  exploration.steps = options.steps;
  exploration.seed = options.seed;
  if (good) {
    ProgressLine line;
    const InterruptScope interrupt(exploration.stop);
    all = runs::ExploreSizes(
        loaded->model, sizes, exploration,
        [&](size_t n, const explore::SearchOptions::Progress& p) {
          line.Show(fmt::format("[N = {}] {} states, {:.0f} states/s, frontier {}, depth {}", n, p.states,
                                static_cast<double>(p.states) / std::max(p.seconds, 1e-9), p.frontier,
                                p.depth));
        },
        session.diagnostics);
  }
  const bool complete = !all.empty() && std::all_of(all.begin(), all.end(), [&](const runs::Explored& e) {
    return options.walks == 0 && !e.unusable && e.search.ending == Ending::kComplete && !e.broken;
  });
  if (complete) Coverage(loaded->model, all, session.diagnostics);
  const ExitStatus status = good ? StatusOf(all, options) : ExitStatus::kRejected;
  std::string saved;
  std::string trouble;
  for (const runs::Explored& e : all) {
    if (!e.run.is_array() || e.run.empty()) continue;
    const std::string path =
        options.save.empty() ? workspace::DefaultRunFile(options.file, e.property) : options.save;
    const runs::RunFile run{options.file, options.spec, e.robots, e.property, "explore", e.run};
    const auto written = runs::SaveRun(path, run);
    (written.ok() ? saved : trouble) = written.ok() ? path : written.error().message;
    if (options.trace.empty()) continue;
    const auto traced = runs::WriteRunTrace(options.trace, run, session);
    if (!traced.ok()) trouble = traced.error().message;
  }
  if (options.json) {
    nlohmann::json sizes_json = nlohmann::json::array();
    for (const runs::Explored& e : all) {
      if (!e.unusable) sizes_json.push_back(ToJson(e, options, loaded->model));
    }
    nlohmann::json out{
        {"command", "explore"}, {"file", options.file},
        {"status", status},     {"explored", sizes_json},
        {"seed", options.seed}, {"diagnostics", diag::RenderJson(session.sources, session.diagnostics)}};
    if (!saved.empty()) out["run"] = saved;
    PrintJson(out);
    return status;
  }
  if (!all.empty() && !all[0].unusable) Print(fmt::format("{}\n{}", options.file, Table(all, options)));
  PrintDiagnostics(session.sources, session.diagnostics);
  std::string text;
  if (status == ExitStatus::kEstablished) {
    std::vector<std::string> done;
    for (const runs::Explored& e : all) done.push_back(fmt::format("{}", e.robots));
    const size_t invariants = loaded->model.invariants.size();
    const std::string what = options.walks > 0 ? "simulated at random"
                             : options.depth > 0
                                 ? fmt::format("explored up to {}", base::Counted(options.depth, "round"))
                                 : "explored";
    text += fmt::format("\n{}: {} hold{} for N = {}, no operation fails.\n", what,
                        base::Counted(invariants, "invariant"), invariants == 1 ? "s" : "",
                        fmt::join(done, ", "));
  }
  if (!all.empty() && !all[0].zeroed.empty())
    text += fmt::format("zero, false or empty at the start: {}\n", fmt::join(all[0].zeroed, ", "));
  if (options.walks > 0) text += fmt::format("seed {}\n", options.seed);
  if (!saved.empty()) text += fmt::format("the run is in {}: `rondo replay {}`\n", saved, saved);
  if (!trouble.empty()) text += fmt::format("the run could not be saved: {}\n", trouble);
  Print(text);
  return status;
}

}  // namespace

void AddExploreVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "explore", "visit every state that a small team can reach");
  verb.Option("FILE", options->file, "a Koord program; `NAME.spec` beside it belongs to it").Required();
  verb.Option("--spec", options->spec, "the specification, if it is not beside the program");
  verb.Option("--robots", options->robots,
              "team sizes, such as `--robots 2 3`; default: what `explore` declares, or 1 2 3")
      .Between(size_t{1}, size_t{64});
  verb.Option("--depth", options->depth, "explore no more than so many rounds").Between(1U, 1'000'000'000U);
  verb.Option("--states", options->states, "give up beyond so many states; default: 100000000")
      .Between(uint64_t{1}, uint64_t{4'000'000'000});
  verb.Option("--memory", options->memory,
              "give up before states take more than so many MB; default: three quarters of the machine's")
      .Between(uint64_t{1}, uint64_t{1'000'000'000});
  verb.Flag("--deadlock", options->deadlock, "look for states in which nothing can happen any more");
  verb.Flag("--no-symmetry", options->no_symmetry, "count states that differ in the names of robots apart");
  verb.Flag("--no-reduction", options->no_reduction,
            "every order of the robots, one after the other (slow: to check the explorer)");
  verb.Flag("--compact", options->compact,
            "keep 64 bits of each state: less memory, but two states may be taken for one");
  verb.Option("--jobs", options->jobs,
              "threads; default: one for each core. What is found does not depend on it")
      .Between(1U, 256U);
  verb.Option("--walks", options->walks, "so many random walks instead of all states");
  verb.Option("--steps", options->steps, "length of a random walk; default: 1000");
  verb.Option("--seed", options->seed, "of the random walks; default: 1");
  verb.Option("--save", options->save, "where to write the run that breaks a property");
  verb.Option("--trace", options->trace, "write that run as a trace (MCAP), too");
  verb.Flag("--open", options->open, "show the run that breaks a property in a browser (`rondo view`)");
  verb.Flag("--json", options->json, "the result as JSON on standard output");
  verb.Footer(
      "examples:\n"
      "  rondo explore examples/koord/leader.koord --robots 8\n"
      "  rondo explore examples/koord/mutex_naive.koord\n"
      "  rondo explore --walks 100 --seed 7 examples/koord/addnums.koord\n"
      "\n"
      "The `explore` section of the specification gives parameters, sensors and external functions values (docs/language.md).\n"
      "exit status: 0 no property is broken, 1 one is, 3 not everything was explored or checked");
  verb.Run([options, &status] {
    if (options->open && options->trace.empty()) options->trace = PlaceForTrace();
    status = Run(*options);
    if (options->open) ShowTrace(options->trace, options->json);
  });
}

}  // namespace rondo::driver
