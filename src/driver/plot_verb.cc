#include <fmt/format.h>

#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "runs/fleet_files.h"
#include "sim/draw/plots.h"
#include "trace/reader.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::string trace;
  std::string svg;
  bool paths = false;
  bool distances = false;
  bool map = false;
};

ExitStatus Run(const Options& options) {
  const auto bytes = trace::ReadTrace(options.trace);
  if (!bytes.ok()) {
    PrintFailure(fmt::format("cannot read `{}`: {}", options.trace, bytes.error().message));
    return ExitStatus::kRejected;
  }
  const auto history = sim::ReadHistory(bytes.value());
  if (!history.ok()) {
    PrintFailure(fmt::format("`{}`: {}", options.trace, history.error().message));
    return ExitStatus::kRejected;
  }
  workspace::Session session;  // it could be read when the trace was made
  const diag::FileId file = session.sources.Add("fleet", sim::TextOf(history.value().run, "fleet"));
  const nlohmann::json none = nlohmann::json::object();
  const auto kept = runs::FilesFromJson(history.value().run.value("files", none));
  const sim::World world = runs::FleetFiles(kept.value_or(runs::FileContents{}), session).Read(file).world;
  if (options.map && history.value().map.cells.empty()) {
    PrintFailure(fmt::format("`{}` has no map", options.trace));
    return ExitStatus::kRejected;
  }
  const std::string svg = options.map         ? sim::DrawMap(history.value(), world)
                          : options.distances ? sim::DrawDistances(history.value(), world)
                                              : sim::DrawPaths(history.value(), world);
  return WritePicture(options.svg, svg);
}

}  // namespace

void AddPlotVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "plot", "draw a simulated run");
  verb.Option("TRACE", options->trace, "what `rondo simulate --trace` wrote").Required();
  verb.Option("--svg", options->svg, "where to write the picture").Required();
  CommandOption paths =
      verb.Flag("--paths", options->paths, "where the robots went, from above (the default)");
  CommandOption distances =
      verb.Flag("--distances", options->distances, "how near robots and obstacles came, over time");
  const CommandOption map =
      verb.Flag("--map", options->map, "the map that the robots drew, and the world as it is");
  paths.Excludes(distances).Excludes(map);
  distances.Excludes(map);
  verb.Footer(
      "examples:\n"
      "  rondo simulate examples/koord/lineform --trace line.mcap\n"
      "  rondo plot line.mcap --svg paths.svg\n"
      "  rondo plot line.mcap --distances --svg distances.svg");
  verb.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
