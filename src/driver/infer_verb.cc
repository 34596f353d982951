#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "driver/exit_status.h"
#include "driver/motion.h"
#include "driver/motion_report.h"
#include "driver/terminal.h"
#include "driver/verbs.h"

namespace rondo::driver {
namespace {

struct Options {
  std::vector<std::string> files;
  std::vector<std::string> admitted;
  double timeout = 10;
  bool json = false;
};

int Finish(const Options& options, const Session& session, const nlohmann::json& list, int status) {
  if (options.json) {
    PrintJson({{"command", "infer regions"},
               {"status", status},
               {"regions", list},
               {"diagnostics", DiagnosticsToJson(session.sources, session.diagnostics)}});
  } else {
    PrintDiagnostics(session.sources, session.diagnostics);
  }
  return status;
}

int Run(const Options& options) {
  Session session;
  nlohmann::json list = nlohmann::json::array();
  const auto motion = LoadMotion(options.files, options.admitted, session);
  if (motion == nullptr) return kRejected;
  const auto conditions = CheckStructure(*motion, session);
  if (!conditions || session.diagnostics.has_errors()) return Finish(options, session, list, kRejected);
  const base::StopToken stop;
  std::string text;
  for (choreo::Graph& graph : motion->graphs) {
    const choreo::Inference regions = FindRegions(graph, motion->arena, options.timeout, stop);
    text += RegionLines(regions, session.sources);
    for (const choreo::FoundRegion& r : regions.found)
      list.push_back({{"robots", r.robots}, {"region", r.text}});
    ReportRegions(regions, session.diagnostics);
  }
  if (!options.json)
    Print(text.empty() && !session.diagnostics.has_errors() ? "every thread has a region\n" : text);
  return Finish(options, session, list, session.diagnostics.has_errors() ? kUndecided : kEstablished);
}

}  // namespace

void AddInferVerb(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("infer", "find what would otherwise be written by hand");
  verb->require_subcommand(1);
  CLI::App* regions = verb->add_subcommand("regions", "regions for the threads that have none");
  regions
      ->add_option("FILE", options->files, "a choreography (`.rondo`), perhaps with `.chor` files behind it")
      ->required();
  regions->add_option("--option", options->admitted, "an option for every choreography: `equal_durations`")
      ->allow_extra_args(false);
  regions->add_option("--timeout", options->timeout, "seconds for each `parallel`; default: 10")
      ->check(CLI::Range(0.001, 1e6));
  regions->add_flag("--json", options->json, "the regions as JSON on standard output");
  regions->footer(
      "example: rondo infer regions examples/choreo/shuttle.rondo\n\n"
      "Prints where each thread is and `thread region ...` to paste there. Every motion of a thread is "
      "proved to "
      "keep to\nits region; `rondo prove` finds the same regions by itself.\n"
      "exit status: 0 every thread has a region now, 1 wrong input, 3 none was found for some");
  regions->callback([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
