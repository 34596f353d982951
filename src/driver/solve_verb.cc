#include <fmt/format.h>

#include <atomic>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/file.h"
#include "base/parallel.h"
#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "solve/script/script_run.h"
#include "solve/smtlib/smtlib_solver.h"
#include "solve/z3/z3_solver.h"
#include "workspace/session.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::vector<std::string> files;
  std::string certificate;
  std::string solver = "auto";
  unsigned jobs = 0;
  double timeout = 60;
  double precision = 0;
  bool compare = false;
  bool no_lemmas = false;
  bool model = false;
  bool stats = false;
  bool json = false;
};

/// One script and what it printed.
struct Item {
  std::string path;
  lang::smtlib::Script script;
  solve::script::ScriptOutcome outcome;
};

nlohmann::json ToJson(const Item& item) {
  nlohmann::json answers = nlohmann::json::array();
  for (const solve::script::CheckOutcome& c : item.outcome.checks) {
    nlohmann::json engines = nlohmann::json::array();
    for (const auto& e : c.report.outcomes)
      engines.push_back({{"engine", e.engine}, {"answer", e.answer}, {"seconds", e.seconds}});
    nlohmann::json model = nlohmann::json::object();
    for (const auto& [name, value] : c.model) model[name] = value;
    answers.push_back({{"answer", solve::Name(c.answer)},
                       {"seconds", c.seconds},
                       {"boxes", c.report.icp.boxes},
                       {"cases", c.report.icp.cases},
                       {"model", model},
                       {"engines", engines}});
    if (!c.reason.empty()) answers.back()["reason"] = c.reason;
  }
  return {{"file", item.path}, {"answers", answers}};
}

// Writes the certificates of all `unsat`, the second and later ones under numbered names.
bool WriteCertificates(const std::vector<Item>& items, const std::filesystem::path& path) {
  size_t number = 0;
  for (const Item& item : items) {
    for (const solve::script::CheckOutcome& c : item.outcome.checks) {
      const auto* unsat = std::get_if<solve::Unsat>(&c.report.answer);
      if (unsat == nullptr) continue;
      std::filesystem::path to = path;
      if (++number > 1)
        to.replace_filename(fmt::format("{}-{}{}", path.stem().string(), number, path.extension().string()));
      const auto written = base::WriteFileAtomically(to, unsat->certificate);
      if (written.ok()) continue;
      PrintFailure(fmt::format("cannot write `{}`: {}", to.string(), written.error().message));
      return false;
    }
  }
  return true;
}

ExitStatus StatusOf(const std::vector<Item>& items) {
  ExitStatus status = ExitStatus::kEstablished;
  for (const Item& item : items) {
    for (const solve::script::CheckOutcome& c : item.outcome.checks) {
      if (c.report.disagreement) return ExitStatus::kBug;
      if (!solve::IsDefinite(c.report.answer)) status = ExitStatus::kUndecided;
    }
  }
  return status;
}

ExitStatus Run(const Options& options) {
  workspace::Session session;
  std::vector<Item> items(options.files.size());
  for (size_t i = 0; i < items.size(); ++i) {
    items[i].path = options.files[i];
    const auto file = workspace::ReadSource(options.files[i], workspace::Wanted::kText, session);
    if (file) lang::smtlib::ReadScript(session.sources, *file, items[i].script, session.diagnostics);
  }
  const nlohmann::json diagnostics = diag::RenderJson(session.sources, session.diagnostics);
  if (session.diagnostics.has_errors()) {
    if (options.json) {
      PrintJson({{"command", "solve"},
                 {"status", ExitStatus::kRejected},
                 {"files", nlohmann::json::array()},
                 {"diagnostics", diagnostics}});
    } else {
      PrintDiagnostics(session.sources, session.diagnostics);
    }
    return ExitStatus::kRejected;
  }

  const solve::z3::Z3Solver z3;
  const bool external = options.solver != "auto" && options.solver != "icp" && options.solver != "z3";
  const solve::smtlib::SmtLibSolver process(external ? options.solver : "");
  solve::script::ScriptOptions run;
  run.timeout = std::chrono::milliseconds(static_cast<int64_t>(options.timeout * 1000));
  run.compare = options.compare;
  run.lemmas = !options.no_lemmas;
  run.want_model = options.model;
  if (options.precision > 0) run.precision = options.precision;
  run.certificate = !options.certificate.empty();
  if (run.certificate && options.solver != "auto" && options.solver != "icp") {
    PrintFailure("only interval arithmetic writes certificates: use --cert without --solver, or with `icp`");
    return ExitStatus::kUsage;
  }
  if (options.solver == "auto" && !run.certificate) run.portfolio = {&z3};
  if (options.solver == "z3") run.only = &z3;
  if (external) run.only = &process;
  // Many scripts: one thread each. One script: all threads for it.
  const unsigned cores = options.jobs > 0 ? options.jobs : std::max(1u, std::thread::hardware_concurrency());
  run.jobs = items.size() == 1 ? cores : 1;
  {
    ProgressLine line;
    base::StopToken stop;
    const InterruptScope interrupt(stop);
    std::mutex mutex;
    size_t done = 0;
    base::ParallelFor(items.size(), items.size() == 1 ? 1 : cores, [&](size_t i) {
      items[i].outcome = solve::script::RunScript(items[i].script, run, stop);
      const std::scoped_lock lock(mutex);
      line.Show(fmt::format("[{}/{}] {}", ++done, items.size(), items[i].path));
    });
  }
  ExitStatus status = StatusOf(items);
  if (run.certificate && !WriteCertificates(items, options.certificate)) status = ExitStatus::kRejected;
  if (options.json) {
    nlohmann::json files = nlohmann::json::array();
    for (const Item& item : items) files.push_back(ToJson(item));
    PrintJson({{"command", "solve"}, {"status", status}, {"files", files}, {"diagnostics", diagnostics}});
    return status;
  }
  for (const Item& item : items) {
    const std::string prefix = items.size() > 1 ? item.path + ": " : "";
    Print(solve::script::Prefixed(item.outcome.text, prefix));
    if (!options.stats) continue;
    for (const solve::script::CheckOutcome& c : item.outcome.checks) {
      Print(fmt::format("{}; {:.3f} s, {} boxes in {} cases ({} decided exactly), {} variables, {} nodes\n",
                        prefix, c.seconds, c.report.icp.boxes, c.report.icp.cases, c.report.icp.exact,
                        c.report.icp.variables, c.report.icp.nodes));
    }
  }
  return status;
}

}  // namespace

void AddSolveVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "solve", "decide SMT-LIB 2 scripts of nonlinear real arithmetic");
  verb.Option("FILE", options->files, "scripts, in the dialect of dReal").Required();
  verb.Option(
      "--solver", options->solver,
      "auto (interval arithmetic, then Z3 beside it), icp (interval arithmetic alone), z3, or a program such as cvc5 or dreal; "
      "default: auto");
  verb.Option("--jobs", options->jobs, "threads; default: one for each core");
  verb.Option("--timeout", options->timeout, "seconds for each script; default: 60").Between(0.001, 1e6);
  verb.Option("--precision", options->precision,
              "the widest box that may be answered with delta-sat; default: what the script says")
      .Between(1e-12, 1e3);
  verb.Option("--cert", options->certificate,
              "where to write the refutation of `unsat`, for `rondo certify`; more than one are numbered");
  verb.Flag("--compare", options->compare, "ask every engine and compare their answers");
  verb.Flag("--no-lemmas", options->no_lemmas, "do not look for rotations, to measure what they bring");
  verb.Flag("--model", options->model, "print values of the variables after `sat`");
  verb.Flag("--stats", options->stats, "print what each question took");
  verb.Flag("--json", options->json, "the answers as JSON on standard output");
  verb.Footer(
      "example: rondo solve --model --stats examples/smt/levels.smt2\n"
      "\n"
      "answers: unsat (no solution, rigorously), sat (with a verified solution), delta-sat (a small box in which\n"
      "nothing could be excluded), unknown\n"
      "exit status: 0 every question answered with sat or unsat, 1 wrong input, 3 something undecided, 4 engines\n"
      "contradict each other");
  verb.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
