#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "driver/exit_status.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "sim/draw/plots.h"
#include "sim/fleet/fleet.h"
#include "trace/reader.h"

namespace rondo::driver {
namespace {

struct Options {
  std::string trace;
  std::string svg;
  bool paths = false;
  bool distances = false;
  bool map = false;
};

int Run(const Options& options) {
  const auto bytes = trace::ReadTrace(options.trace);
  if (!bytes.ok()) {
    PrintFailure(fmt::format("cannot read `{}`: {}", options.trace, bytes.error().message));
    return kRejected;
  }
  const auto history = sim::ReadHistory(bytes.value());
  if (!history.ok()) {
    PrintFailure(fmt::format("`{}`: {}", options.trace, history.error().message));
    return kRejected;
  }
  diag::SourceSet sources;
  diag::Diagnostics ignored;  // it could be read when the trace was made
  const diag::FileId file = sources.Add("fleet", sim::TextOf(history.value().run, "fleet"));
  const sim::World world = sim::ReadFleet(sources, file, ignored).world;
  if (options.map && history.value().map.cells.empty()) {
    PrintFailure(fmt::format("`{}` has no map", options.trace));
    return kRejected;
  }
  const std::string svg = options.map         ? sim::DrawMap(history.value(), world)
                          : options.distances ? sim::DrawDistances(history.value(), world)
                                              : sim::DrawPaths(history.value(), world);
  return WritePicture(options.svg, svg);
}

}  // namespace

void AddPlotVerb(CLI::App& app, int& status) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("plot", "draw a simulated run");
  verb->add_option("TRACE", options->trace, "what `rondo simulate --trace` wrote")->required();
  verb->add_option("--svg", options->svg, "where to write the picture")->required();
  auto* paths = verb->add_flag("--paths", options->paths, "where the robots went, from above (the default)");
  auto* distances =
      verb->add_flag("--distances", options->distances, "how near robots and obstacles came, over time");
  auto* map = verb->add_flag("--map", options->map, "the map that the robots drew, and the world as it is");
  paths->excludes(distances)->excludes(map);
  distances->excludes(map);
  verb->footer(
      "examples:\n  rondo simulate examples/koord/lineform --trace line.mcap\n"
      "  rondo plot line.mcap --svg paths.svg\n"
      "  rondo plot line.mcap --distances --svg distances.svg");
  verb->callback([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
