#include "sim/campaign/campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace rondo::sim::campaign {

std::string Trial::What() const {
  if (!findings.empty()) return findings.front().text;
  return other;
}

Trial Try(Fleet& fleet, koord::semantics::Team& team, const Scenario& scenario, CampaignReport* report) {
  Outcome outcome = fleet.Run(scenario);
  // Whatever decides a run is in the scenario.
  const bool same = fleet.Run(scenario).digest == outcome.digest;
  history::Judge judge(team);
  const auto begin = std::chrono::steady_clock::now();
  std::vector<history::Finding> findings = judge.Check(outcome.record);
  if (report != nullptr) {
    ++report->runs;
    report->judging += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    report->rounds += judge.rounds();
    report->datagrams += outcome.datagrams;
    report->recovery = std::max(report->recovery, outcome.recovery);
    report->seconds += static_cast<double>(outcome.time) * 1e-9;
    report->visited.insert(outcome.visited.begin(), outcome.visited.end());
  }
  std::string other = !outcome.broken.empty() ? outcome.broken : outcome.stuck;
  if (!same) other = "the same run ends differently each time";
  return Trial{scenario, std::move(findings), std::move(other), std::move(outcome)};
}

namespace {

// Do two runs fail for the same reason?
bool Alike(const Trial& a, const Trial& b) {
  if (a.findings.empty() != b.findings.empty()) return false;
  return a.findings.empty() || a.findings.front().wrong == b.findings.front().wrong;
}

}  // namespace

Trial Shrink(Fleet& fleet, koord::semantics::Team& team, Trial failure, const base::StopToken& stop) {
  const auto accept = [&](const Scenario& smaller) {
    if (stop.StopRequested()) return false;
    Trial other = Try(fleet, team, smaller);
    if (!other.failed() || !Alike(failure, other)) return false;
    failure = std::move(other);
    return true;
  };
  bool again = true;
  while (again && !stop.StopRequested()) {
    again = false;
    for (size_t i = failure.scenario.faults.size(); i-- > 0;) {
      Scenario smaller = failure.scenario;
      smaller.faults.erase(smaller.faults.begin() + static_cast<ptrdiff_t>(i));
      again = accept(smaller) || again;
    }
    for (size_t i = 0; i < failure.scenario.faults.size(); ++i) {
      Scenario smaller = failure.scenario;
      if (smaller.faults[i].length < 20'000'000) continue;
      smaller.faults[i].length /= 2;
      again = accept(smaller) || again;
    }
    Scenario shorter = failure.scenario;
    shorter.rounds /= 2;
    if (shorter.rounds > 0) again = accept(shorter) || again;
  }
  return failure;
}

CampaignReport Search(Fleet& fleet, const Fleet::MakeTeam& make, const CampaignOptions& options) {
  CampaignReport report;
  std::vector<std::unique_ptr<koord::semantics::Team>> judges;
  const uint64_t runs = options.scenarios.empty() ? options.runs : options.scenarios.size();
  for (uint64_t i = 0; i < runs; ++i) {
    if (options.stop.StopRequested()) {
      report.stopped = true;
      break;
    }
    Scenario scenario = options.scenarios.empty() ? Draw(options.seed + i, options.least, options.most)
                                                  : options.scenarios[i];
    if (options.scenarios.empty()) scenario.rounds = options.rounds;
    if (judges.size() <= scenario.robots) judges.resize(scenario.robots + 1);
    auto& judge = judges[scenario.robots];
    if (judge == nullptr) judge = make(scenario.robots);
    Trial trial = Try(fleet, *judge, scenario, &report);
    if (options.each) options.each(trial, *judge);
    if (trial.failed()) {
      report.failure =
          options.shrink ? Shrink(fleet, *judge, std::move(trial), options.stop) : std::move(trial);
      break;
    }
    if (options.progress) options.progress(i + 1);
  }
  return report;
}

std::string Story(const Trial& failure) {
  const Scenario& s = failure.scenario;
  std::string text =
      fmt::format("{} robots, on_loss = \"{}\", exchange = \"{}\", {} disks, seed {}\n", s.robots,
                  Name(s.on_loss), Name(s.exchange), s.disks ? "with" : "without", s.seed);
  for (const Fault& fault : s.faults) text += "  " + Tell(fault) + "\n";
  if (!failure.other.empty()) text += failure.other + "\n";
  constexpr size_t kMost = 5, kAround = 12;
  for (size_t i = 0; i < failure.findings.size() && i < kMost; ++i) {
    const history::Finding& f = failure.findings[i];
    text += fmt::format("{}: {}\n", history::Meaning(f.wrong), f.text);
  }
  if (failure.findings.empty()) return text;
  constexpr const char* kDid[] = {"starts",      "crashes", "says what it does in", "has the state of",
                                  "calls final", "acts on", "falls back",           "joins the team of"};
  const auto& entries = failure.outcome.record.entries;
  const size_t last = std::min(failure.findings.front().entry, entries.size() - 1);
  text += "before that:\n";
  for (size_t i = last < kAround ? 0 : last - kAround; i <= last; ++i) {
    const history::Entry& e = entries[i];
    text += fmt::format("  {:9.4f} s  robot {} {} round {} (epoch {})\n", static_cast<double>(e.time) * 1e-9,
                        e.robot, kDid[static_cast<size_t>(e.kind)], e.round, e.epoch);
  }
  return text;
}

}  // namespace rondo::sim::campaign
