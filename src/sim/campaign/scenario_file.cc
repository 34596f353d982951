#include "sim/campaign/scenario_file.h"

#include <fmt/format.h>

#include <sstream>

#include "sim/cores/fault_file.h"
#include "sim/fleet/round_words.h"
#include "sim/fleet/tables.h"

namespace rondo::sim::campaign {

namespace {

class Reader : Tables {
 public:
  Reader(const diag::SourceSet& sources, diag::FileId file, diag::Diagnostics& diagnostics)
      : Tables(sources, file, diagnostics), file_(file), diagnostics_(diagnostics) {}

  std::vector<Scenario> Run() {
    const size_t before = diagnostics_.errors();
    const toml::table root = Root();
    if (diagnostics_.errors() != before) return {};
    Known(root, {"scenario"}, "a file of scenarios");
    ForEach(root, "scenario", [&](const toml::table& t) { scenarios_.push_back(Read(t)); });
    if (scenarios_.empty() && diagnostics_.errors() == before)
      diagnostics_.Report(diag::Kind::kFleetValue, {file_, 0, 1}, "there is no scenario")
          .Help("add one: `[[scenario]]`");
    return std::move(scenarios_);
  }

 private:
  Scenario Read(const toml::table& t) {
    Known(t,
          {"seed", "robots", "rounds", "on_loss", "exchange", "disks", "delta", "lease", "stop_time",
           "patience", "fault"},
          "a scenario");
    Scenario s;
    s.seed = Whole(t, "seed", 1, 0, 9e15);
    s.robots = Whole(t, "robots", 3, 1, static_cast<double>(kMostRobots));
    s.rounds = Whole(t, "rounds", 30, 1, 1e6);
    s.on_loss = ReadOnLoss(*this, t, s.on_loss, s.robots);
    s.exchange = ReadExchange(*this, t, s.exchange);
    s.disks = Flag(t, "disks", false);
    const auto seconds = [&](const char* name, Time usual) {
      return cores::Nanoseconds(Number(t, name, static_cast<double>(usual) * 1e-9, 1e-3, 1e4));
    };
    s.delta = seconds("delta", s.delta);
    s.lease = seconds("lease", s.lease);
    s.stop_time = seconds("stop_time", s.stop_time);
    s.patience = seconds("patience", s.patience);
    if (s.patience < 2 * s.delta && (t.get("patience") != nullptr || t.get("delta") != nullptr))
      Wrong(At(t), "`patience` must be at least two rounds (`delta`): robots are silent between rounds");
    ForEach(t, "fault", [&](const toml::table& fault) {
      s.faults.push_back(cores::ReadFault(*this, fault, s.robots, {}));
    });
    return s;
  }

  static constexpr size_t kMostRobots = 64;

  diag::FileId file_;
  diag::Diagnostics& diagnostics_;
  std::vector<Scenario> scenarios_;
};

}  // namespace

std::vector<Scenario> ReadScenarios(const diag::SourceSet& sources, diag::FileId file,
                                    diag::Diagnostics& diagnostics) {
  return Reader(sources, file, diagnostics).Run();
}

std::string WriteScenario(const Scenario& s, const std::string& comment) {
  std::string text;
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);) text += "# " + line + "\n";
  text += fmt::format(
      "[[scenario]]\nseed = {}\nrobots = {}\nrounds = {}\non_loss = \"{}\"\nexchange = \"{}\"\ndisks = {}\ndelta = {:.9f}\nlease = {:.9f}\n"
      "stop_time = {:.9f}\npatience = {:.9f}\n",
      s.seed, s.robots, s.rounds, Name(s.on_loss), Name(s.exchange), s.disks, cores::Seconds(s.delta),
      cores::Seconds(s.lease), cores::Seconds(s.stop_time), cores::Seconds(s.patience));
  for (const Fault& f : s.faults) text += "\n[[scenario.fault]]\n" + cores::WriteFault(f);
  return text;
}

}  // namespace rondo::sim::campaign
