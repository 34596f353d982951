#include "runs/run_trace.h"

#include <fmt/format.h>

#include <filesystem>

#include "trace/ros.h"
#include "trace/writer.h"

namespace rondo::runs {
namespace {

using nlohmann::json;

// The port that tells where robots are, in a state as JSON.
const json* Positions(const json& state) {
  for (const auto& [name, values] : state.items()) {
    if ((name.ends_with(".psn") || name.ends_with(".position")) && values.is_array()) return &values;
  }
  return nullptr;
}

}  // namespace

base::Result<bool> WriteRunTrace(const std::string& path, const RunFile& run,
                                 const workspace::Session& session) {
  auto opened = trace::Writer::Open(path);
  if (!opened.ok()) return opened.error();
  trace::Writer writer = std::move(opened).value();
  json robots = json::array();
  for (size_t r = 0; r < run.robots; ++r)
    robots.push_back({{"name", fmt::format("robot{}", r)}, {"radius", 0.2}});
  json record{{"format", "rondo-trace/1"},
              {"engine", run.engine},
              {"program_name", std::filesystem::path(run.program).filename().string()},
              {"program", ""},
              {"spec", ""},
              {"breaks", run.property},
              {"params", run.params},
              {"choices", run.choices},
              {"robots", robots}};
  for (size_t f = 0; f < session.sources.size(); ++f) {
    const diag::FileId id(f);
    record[session.sources.path(id) == run.program ? "program" : "spec"] = session.sources.text(id);
  }
  writer.Message(writer.Channel("/rondo/run", trace::kRecord, "json"), 0, record.dump());
  const uint16_t steps = writer.Channel("/rondo/step", trace::kRecord, "json");
  std::vector<uint16_t> poses;
  for (size_t k = 0; k < run.steps.size(); ++k) {
    const uint64_t time = k * 1'000'000'000;
    writer.Message(steps, time, run.steps[k].dump());
    const json* positions = Positions(run.steps[k]["state"]);
    for (size_t r = 0; positions != nullptr && r < positions->size(); ++r) {
      if (poses.size() <= r)
        poses.push_back(writer.Channel(fmt::format("/robot{}/pose", r), trace::kPoseStamped, "cdr"));
      const json& p = (*positions)[r];
      writer.Message(poses[r], time,
                     trace::PoseStamped(
                         time, {{p.value("x", 0.0), p.value("y", 0.0), p.value("z", 0.0)}, {0, 0, 0, 1}}));
    }
  }
  return writer.Finish();
}

}  // namespace rondo::runs
