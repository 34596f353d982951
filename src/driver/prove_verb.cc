#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "contracts/discharge.h"
#include "contracts/program_report.h"
#include "driver/command.h"
#include "driver/prove_choreographies.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "runs/helper_search.h"
#include "runs/witness_search.h"
#include "solve/cache/caching_solver.h"
#include "solve/smtlib/smtlib_solver.h"
#include "solve/z3/z3_solver.h"
#include "workspace/koord_files.h"
#include "workspace/module_files.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::vector<std::string> files;
  std::string file;  ///< the only one: a Koord program
  std::string spec;
  int64_t robots = 0;
  unsigned jobs = 0;
  double timeout = 10;
  std::string smt_out;
  std::string cross_check;
  std::vector<std::string> admitted;
  std::string certificates;
  std::string svg;
  uint32_t reach = 0;
  bool helpers = false;
  bool no_certify = false;
  bool no_cache = false;
  bool json = false;
};

koord::ProveOptions ToProveOptions(const Options& options) {
  koord::ProveOptions prove;
  if (options.robots > 0) prove.robots = options.robots;
  prove.jobs = options.jobs;
  prove.timeout = std::chrono::milliseconds(static_cast<int64_t>(options.timeout * 1000));
  prove.smt_out = options.smt_out;
  return prove;
}

ExitStatus StatusOf(const koord::Report& report) {
  if (report.disagreement) return ExitStatus::kBug;
  if (report.AnyFailed()) return ExitStatus::kRejected;
  if (!report.problems.empty()) return ExitStatus::kRejected;
  return report.AllProved() ? ExitStatus::kEstablished : ExitStatus::kUndecided;
}

// What the JSON of every end has.
nlohmann::json Envelope(const Options& options, const workspace::Session& session, ExitStatus status) {
  return {{"command", "prove"},
          {"file", options.file},
          {"status", status},
          {"diagnostics", diag::RenderJson(session.sources, session.diagnostics)}};
}

runs::HelperRequest ToHelperRequest(const Options& options, const workspace::Session& session,
                                    const koord::ProveOptions& prove) {
  runs::HelperRequest request{options.file, {}, {}, prove};
  for (size_t f = 0; f < session.sources.size(); ++f) {
    const diag::FileId id(f);
    (session.sources.path(id) == options.file ? request.program : request.spec) = session.sources.text(id);
  }
  return request;
}

std::string HelperText(const runs::Helpers& helpers) {
  if (!helpers.proved) return fmt::format("\nno helper invariants found: {}\n", helpers.why);
  std::string text = "\nwith these, everything is proved:\n";
  for (const std::string& line : helpers.invariants) text += line + "\n";
  return text;
}

ExitStatus Run(const Options& options) {
  workspace::Session session;
  const auto loaded = workspace::LoadKoord({options.file, options.spec, true}, session);
  const auto finish_early = [&](ExitStatus status) {
    if (options.json) {
      PrintJson(Envelope(options, session, status));
    } else {
      PrintDiagnostics(session.sources, session.diagnostics);
    }
    return status;
  };
  if (!loaded) return finish_early(ExitStatus::kRejected);
  const auto refuse = [&](const std::string& why) {
    return driver::Refuse("prove", options.file, options.json, session.sources, session.diagnostics, why);
  };
  if (const std::string why = Folder(options.smt_out); !why.empty()) return refuse(why);
  const koord::Model& model = loaded->model;
  if (model.invariants.empty()) {
    session.diagnostics
        .Report(diag::Kind::kKoordNoInvariant, loaded->program.item_spans.back(), "there is nothing to prove")
        .Help(model.responses.empty()
                  ? "state what must always hold: `invariant NAME: ...`, here or in the `.spec` file "
                    "beside the program"
                  : "responses are checked by `rondo explore` and `rondo simulate`; proofs are of "
                    "invariants");
    return finish_early(ExitStatus::kRejected);
  }
  const solve::z3::Z3Solver z3;
  const solve::cache::ProofCache cache(options.no_cache ? std::filesystem::path()
                                                        : solve::cache::ProofCache::DefaultFolder());
  const solve::cache::CachingSolver caching(z3, cache);
  const solve::smtlib::SmtLibSolver other(options.cross_check);
  if (!options.cross_check.empty()) {
    if (const auto tried = other.Try(); !tried.ok()) return refuse(tried.error().message);
  }
  koord::ProveOptions prove = ToProveOptions(options);
  prove.solver = options.no_cache ? static_cast<const solve::Solver*>(&z3) : &caching;
  if (!options.cross_check.empty()) prove.cross_check = &other;
  koord::Report report;
  {
    ProgressLine line;
    const InterruptScope interrupt(prove.stop);
    prove.progress = [&](size_t done, size_t total, const std::string& what) {
      line.Show(fmt::format("[{}/{}] {}", done, total, what));
    };
    report = koord::Prove(model, prove, session.diagnostics);
  }
  if (report.rows.empty()) return finish_early(ExitStatus::kRejected);
  for (const koord::ResponseDef* def : model.responses) {
    session.diagnostics
        .Report(diag::Kind::kKoordNotChecked, def->span, fmt::format("proofs say nothing of `{}`", def->name))
        .Help("`rondo explore` and `rondo simulate` check it");
  }
  std::vector<runs::Reached> reached;
  {
    ProgressLine line;
    runs::ReachRequest request;
    if (options.reach > 0) request.rounds = options.reach;
    if (options.robots > 0) request.robots = static_cast<size_t>(options.robots);
    request.file = options.file;
    request.spec = options.spec;
    request.exploration.jobs = options.jobs;
    const InterruptScope interrupt(request.exploration.stop);
    request.exploration.progress = [&](const explore::SearchOptions::Progress& p) {
      line.Show(fmt::format("[reach] {} states, frontier {}, depth {}", p.states, p.frontier, p.depth));
    };
    reached = runs::SearchWitnesses(model, report, request, session.diagnostics);
  }
  runs::Helpers helpers;
  if (options.helpers && !report.AllProved()) {
    ProgressLine line;
    runs::HelperRequest request = ToHelperRequest(options, session, prove);
    const InterruptScope interrupt(request.prove.stop);
    request.prove.progress = [&](size_t done, size_t total, const std::string& what) {
      line.Show(fmt::format("[helpers {}/{}] {}", done, total, what));
    };
    helpers = runs::FindHelpers(request, report);
  }
  contracts::Discharge(*loaded, session, cache, options.file, report.basis);
  const ExitStatus status = StatusOf(report);
  if (options.json) {
    nlohmann::json json = Envelope(options, session, status);
    json.update(contracts::ToJson(report, session.sources));
    for (const runs::Reached& r : reached)
      json["reach"].push_back(
          {{"invariant", r.invariant}, {"found", r.found}, {"text", r.text}, {"run", r.run}});
    if (options.helpers && !report.AllProved())
      json["helpers"] = {{"found", helpers.proved}, {"invariants", helpers.invariants}, {"why", helpers.why}};
    PrintJson(json);
    return status;
  }
  Print(contracts::ProveHeader(options.file, report, prove, options.no_cache ? 0 : caching.hits()));
  Print(contracts::ProveTable(report));
  if (!session.diagnostics.all().empty()) {
    Print("\n");
    PrintDiagnostics(session.sources, session.diagnostics);
  }
  for (const runs::Reached& r : reached) Print(fmt::format("\nsearch: {}\n", r.text));
  Print(contracts::ProveSummary(report, prove));
  if (options.helpers && !report.AllProved()) Print(HelperText(helpers));
  PrintStatus(status);
  return status;
}

ProveChoreographiesOptions ToChoreographyOptions(const Options& options) {
  ProveChoreographiesOptions prove;
  prove.files = options.files;
  prove.admitted = options.admitted;
  prove.jobs = options.jobs;
  prove.timeout = options.timeout;
  prove.smt_out = options.smt_out;
  prove.certificates = options.certificates;
  prove.svg = options.svg;
  prove.certify = !options.no_certify;
  prove.cache = !options.no_cache;
  prove.json = options.json;
  return prove;
}

// Options that belong to the other language are a mistake, not to be ignored.
void Refuse(const Command& verb, std::initializer_list<const char*> names, const char* what) {
  for (const char* name : names) {
    if (verb.Given(name)) RefuseOption(name, fmt::format("is not for {}", what));
  }
}

ExitStatus Dispatch(Options& options, const Command& verb) {
  if (workspace::IsModuleFile(options.files[0])) {
    Refuse(verb, {"--spec", "--robots", "--cross-check", "--reach", "--helpers"}, "choreographies");
    return ProveChoreographies(ToChoreographyOptions(options));
  }
  Refuse(verb, {"--option", "--certificates", "--svg", "--no-certify"}, "Koord programs");
  if (options.files.size() > 1) RefuseOption("FILE", "one Koord program at a time");
  options.file = options.files[0];
  return Run(options);
}

}  // namespace

void AddProveVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "prove", "prove Koord programs for any number of robots, and choreographies of motions");
  verb.Option(
          "FILE", options->files,
          "a Koord program (`NAME.spec` beside it belongs to it), or a choreography (`.rondo`), perhaps with original "
          "choreographies (`.chor`) and programs (`ROBOT.rosl`) behind it")
      .Required();
  verb.Option("--spec", options->spec, "the specification, if it is not beside the program");
  verb.Option("--robots", options->robots, "fix the number of robots; default: every N >= 1")
      .Between(int64_t{1}, int64_t{1'000'000});
  verb.Option("--jobs", options->jobs, "threads; default: one for each core");
  verb.Option("--timeout", options->timeout, "seconds for each question or obligation; default: 10")
      .Between(0.001, 1e6);
  verb.Option("--smt-out", options->smt_out, "write every obligation as SMT-LIB 2 into this folder");
  verb.Option("--cross-check", options->cross_check,
              "decide every obligation again with this solver, such as cvc5");
  verb.Option("--option", options->admitted,
              "an option for every choreography, as if it were written there: `equal_durations`")
      .OneEach();
  verb.Option("--certificates", options->certificates,
              "write every certificate of a choreography into this folder, for `rondo certify`");
  verb.Option("--svg", options->svg,
              "draw the scene of the first collision or region that fails: from above and from the side");
  verb.Option("--reach", options->reach,
              "search so many rounds for runs that violate what is not inductive or could not be decided")
      .Between(1U, 1'000'000U);
  verb.Flag("--helpers", options->helpers,
            "look for helper invariants, half a minute at most, if something is not inductive");
  verb.Flag("--no-certify", options->no_certify, "do not write and check certificates of choreographies");
  verb.Flag("--no-cache", options->no_cache, "neither use nor fill the proof cache");
  verb.Flag("--json", options->json, "the verdicts as JSON on standard output");
  verb.Footer(
      "examples:\n"
      "  rondo prove examples/koord/lineform.koord\n"
      "  rondo prove --robots 15 --cross-check cvc5 examples/koord/delivery.koord\n"
      "  rondo prove examples/choreo/handover.rondo\n"
      "  rondo prove --svg scene.svg --smt-out obligations examples/choreo/underpass.rondo\n"
      "\n"
      "exit status: 0 everything proved, 1 something refuted or not inductive, 3 something undecided");
  verb.Run([options, verb, &status] { status = Dispatch(*options, verb); });
}

}  // namespace rondo::driver
