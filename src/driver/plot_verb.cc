#include <fmt/format.h>

#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "runs/choreography_scene.h"
#include "runs/fleet_files.h"
#include "sim/draw/plots.h"
#include "sim/draw/timeline.h"
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
  bool timeline = false;
  double scene = -1;
};

// Runs of choreographies have pictures of their own.
ExitStatus PlotChoreography(const Options& options, const std::string& bytes) {
  const auto history = sim::ReadStageHistory(bytes);
  if (!history.ok()) {
    PrintFailure(fmt::format("`{}`: {}", options.trace, history.error().message));
    return ExitStatus::kRejected;
  }
  if (options.scene < 0) return WritePicture(options.svg, sim::DrawTimeline(history.value()));
  workspace::Session session;
  const auto scene = runs::DrawRunScene(history.value(), options.scene, session);
  if (scene.ok()) return WritePicture(options.svg, scene.value());
  PrintDiagnostics(session.sources, session.diagnostics);
  PrintFailure(fmt::format("`{}`: {}", options.trace, scene.error().message));
  return ExitStatus::kRejected;
}

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
  const bool choreography = sim::TextOf(history.value().run, "engine") == "choreography";
  if (choreography && !options.paths && !options.distances && !options.map)
    return PlotChoreography(options, bytes.value());
  if (options.timeline || options.scene >= 0) {
    PrintFailure(fmt::format("`{}` is no run of a choreography: `--timeline` and `--scene` are for those",
                             options.trace));
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
  CommandOption timeline = verb.Flag("--timeline", options->timeline,
                                     "messages and motions of a choreography over time (its default)");
  CommandOption scene =
      verb.Option("--scene", options->scene,
                  "where everything is after so many seconds of a choreography, from above and from the side")
          .Between(0.0, 1e9);
  paths.Excludes(distances).Excludes(map).Excludes(timeline).Excludes(scene);
  distances.Excludes(map).Excludes(timeline).Excludes(scene);
  timeline.Excludes(map).Excludes(scene);
  scene.Excludes(map);
  verb.Footer(
      "examples:\n"
      "  rondo simulate examples/koord/lineform --trace line.mcap\n"
      "  rondo plot line.mcap --svg paths.svg\n"
      "  rondo plot line.mcap --distances --svg distances.svg\n"
      "  rondo simulate examples/choreo/handover.rondo --trace handover.mcap\n"
      "  rondo plot handover.mcap --svg timeline.svg\n"
      "  rondo plot handover.mcap --scene 7.5 --svg scene.svg");
  verb.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
