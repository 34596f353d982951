#include "sim/network.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/codec/messages.h"
#include "sim/cores/fault_file.h"
#include "sim/fleet/tables.h"

namespace rondo::sim {

NetworkFaults ReadNetwork(const diag::SourceSet& sources, diag::FileId file, const Fleet& fleet,
                          diag::Diagnostics& diagnostics) {
  Tables tables(sources, file, diagnostics);
  NetworkFaults network;
  const size_t before = diagnostics.errors();
  const toml::table root = tables.Root();
  if (diagnostics.errors() != before) return network;
  tables.Known(root, {"network", "fault"}, "a network file");
  if (fleet.robots.size() > runtime::codec::kMostRobots)
    tables.Wrong({file, 0, 1}, fmt::format("{} robots are more than can agree over a network ({})",
                                           fleet.robots.size(), runtime::codec::kMostRobots));
  if (const toml::table* t = tables.Table(root, "network")) {
    tables.Known(*t, {"loss", "duplicate", "corrupt", "delay"}, "`network`");
    auto& c = network.conditions;
    c.loss = tables.Number(*t, "loss", 0, 0, 1);
    c.duplicate = tables.Number(*t, "duplicate", 0, 0, 1);
    c.corrupt = tables.Number(*t, "corrupt", 0, 0, 1);
    const double most = tables.Number(*t, "delay", cores::Seconds(c.most), 0, 1000);
    c.most = cores::Nanoseconds(most);
    c.least = std::min(c.least, c.most);
  }
  std::vector<std::string> names;
  for (const FleetRobot& robot : fleet.robots) names.push_back(robot.name);
  tables.ForEach(root, "fault", [&](const toml::table& t) {
    network.faults.push_back(cores::ReadFault(tables, t, names.size(), names));
  });
  return network;
}

}  // namespace rondo::sim
