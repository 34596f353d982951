#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "contracts/choreography_report.h"
#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "workspace/module_files.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::vector<std::string> files;
  std::vector<std::string> admitted;
  double timeout = 10;
  bool json = false;
};

ExitStatus Finish(const Options& options, const workspace::Session& session, const nlohmann::json& list,
                  ExitStatus status) {
  if (options.json) {
    PrintJson({{"command", "infer regions"},
               {"status", status},
               {"regions", list},
               {"diagnostics", diag::RenderJson(session.sources, session.diagnostics)}});
  } else {
    PrintDiagnostics(session.sources, session.diagnostics);
  }
  return status;
}

ExitStatus Run(const Options& options) {
  workspace::Session session;
  nlohmann::json list = nlohmann::json::array();
  const auto module = workspace::LoadModule(options.files, options.admitted, session);
  const auto conditions = workspace::CheckStructure(*module, session);
  if (!conditions || session.diagnostics.has_errors())
    return Finish(options, session, list, ExitStatus::kRejected);
  std::string text;
  {
    ProgressLine line;
    contracts::ChoreographyOptions search;
    const InterruptScope interrupt(search.stop);
    search.timeout = options.timeout;
    search.progress = [&](const std::string& what) { line.Show(what); };
    for (choreo::Graph& graph : module->graphs) {
      const choreo::Inference regions = contracts::FindRegions(graph, module->arena, search);
      text += contracts::RegionLines(regions, session.sources);
      for (const choreo::FoundRegion& r : regions.found)
        list.push_back({{"robots", r.robots}, {"region", r.text}});
      contracts::ReportRegions(regions, session.diagnostics);
    }
  }
  if (!options.json)
    Print(text.empty() && !session.diagnostics.has_errors() ? "every thread has a region\n" : text);
  return Finish(options, session, list,
                session.diagnostics.has_errors() ? ExitStatus::kUndecided : ExitStatus::kEstablished);
}

}  // namespace

void AddInferVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "infer", "find what would otherwise be written by hand");
  Command regions = verb.Verb("regions", "regions for the threads that have none");
  regions.Option("FILE", options->files, "a choreography (`.rondo`), perhaps with `.chor` files behind it")
      .Required();
  regions.Option("--option", options->admitted, "an option for every choreography: `equal_durations`")
      .OneEach();
  regions.Option("--timeout", options->timeout, "seconds for each `parallel`; default: 10")
      .Between(0.001, 1e6);
  regions.Flag("--json", options->json, "the regions as JSON on standard output");
  regions.Footer(
      "example: rondo infer regions examples/choreo/shuttle.rondo\n"
      "\n"
      "Prints where each thread is and `thread region ...` to paste there. Every motion of a thread is proved to keep to\n"
      "its region; `rondo prove` finds the same regions by itself.\n"
      "exit status: 0 every thread has a region now, 1 wrong input, 3 none was found for some");
  regions.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
