#include "deploy/judge_logs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "koord/node/slow_calls.h"
#include "platform/ports.h"
#include "platform/topics.h"
#include "sim/monitor.h"
#include "transport/mailbox.h"

namespace rondo::deploy {

using history::Entry;
using history::Kind;
using history::Wrong;
using koord::semantics::Answer;
using transport::Seconds;

namespace {

// Functions answer what they answered on the robots; what is asked of no port is computed again.
class Answers final : public koord::semantics::Host {
 public:
  Answers(Replica& replica, const koord::Model& model, const FleetRecord& record)
      : replica_(replica), model_(model), record_(record) {}
  void About(uint64_t round) { round_ = round; }

  Answer Call(size_t f, size_t robot, std::span<const Word> arguments, std::span<Word> result) override {
    if (model_.functions[f].port < 0) return replica_.calls().Call(f, robot, arguments, result);
    const uint64_t question = koord::node::QuestionOf(replica_.team(), f, robot, arguments);
    const auto known = record_.answers.find({static_cast<uint32_t>(robot), question});
    if (known == record_.answers.end()) return Answer::kNone;
    const auto answer = std::ranges::find(known->second, round_, &FleetRecord::Answer::round);
    if (answer == known->second.end()) return Answer::kNone;
    runtime::codec::Reader reader(answer->value);
    std::vector<Word> words;
    koord::node::DecodeValue(model_.types, replica_.team().heap(), model_.functions[f].result, reader, words);
    if (!reader.Complete() || words.size() != result.size()) return Answer::kNone;
    std::ranges::copy(words, result.begin());
    return Answer::kValue;
  }
  void Log(size_t, size_t, std::span<const Word>) override {}

 private:
  Replica& replica_;
  const koord::Model& model_;
  const FleetRecord& record_;
  uint64_t round_ = 0;
};

class Teller {
 public:
  Teller(const FleetRecord& record, const sim::Fleet& fleet, LogsReport& report)
      : record_(record.record), fleet_(fleet), report_(report) {}

  void Run() {
    const auto& entries = record_.entries;
    report_.lines = entries.size();
    if (entries.empty()) return;
    start_ = entries.front().time;
    report_.length = Seconds(entries.back().time - start_);
    uint64_t epoch = 0;
    for (const Entry& e : entries) {
      if (e.kind == Kind::kContributed) said_[e.robot] = &e;
      if (e.kind == Kind::kCommitted) {
        report_.rounds = std::max(report_.rounds, e.round);
        const auto said = said_.find(e.robot);
        if (said != said_.end() && said->second->epoch == e.epoch && said->second->round + 1 == e.round)
          report_.waits.push_back(Seconds(e.time - said->second->time));
      }
      if (e.kind == Kind::kContributed) began_.insert({e.robot, e.incarnation});
      // Each life begins with its fallback.
      if (e.kind == Kind::kFellBack && began_.contains({e.robot, e.incarnation})) {
        ++report_.fallbacks;
        Say(e, fmt::format("{} falls back", NameOf(e.robot)));
      }
      if (e.kind != Kind::kAdopted || e.epoch <= epoch || e.what >= record_.members.size()) continue;
      epoch = e.epoch;
      std::vector<std::string> names;
      for (const history::Life& life : record_.members[e.what]) names.push_back(NameOf(life.robot));
      Say(e, fmt::format("the team is {}", fmt::join(names, ", ")));
    }
    std::ranges::sort(report_.waits);
  }

 private:
  std::string NameOf(uint32_t robot) const {
    return robot < fleet_.robots.size() ? fleet_.robots[robot].name : fmt::format("robot {}", robot);
  }
  void Say(const Entry& e, std::string what) {
    report_.story.emplace_back(Seconds(e.time - start_), std::move(what));
  }

  const history::Record& record_;
  const sim::Fleet& fleet_;
  LogsReport& report_;
  int64_t start_ = 0;
  std::map<uint32_t, const Entry*> said_;  // by robot: last
  std::set<history::Life> began_;
};

// What a log that is missing, or ends early, would have told is not held against the others, as long as its robot is one of
// their team: nothing is said of it.
void Excuse(history::Life life, int64_t from, const history::Record& record, LogsReport& report) {
  std::set<uint64_t> epochs;
  for (const Entry& e : record.entries) {
    if (e.kind != Kind::kAdopted || e.what >= record.members.size()) continue;
    if (std::ranges::find(record.members[e.what], life) != record.members[e.what].end())
      epochs.insert(e.epoch);
  }
  std::erase_if(report.findings, [&](const history::Finding& f) {
    const Entry& e = record.entries[f.entry];
    if (f.wrong == Wrong::kDiverged || f.wrong == Wrong::kTwice) return false;
    return f.wrong == Wrong::kLost || (epochs.contains(e.epoch) && e.time >= from);
  });
}

// Logs that are cut off, and lives of robots that have none.
void ExcuseMissing(const std::vector<RobotLog>& logs, const history::Record& record, const sim::Fleet& fleet,
                   LogsReport& report) {
  const int64_t start = record.entries.empty() ? 0 : record.entries.front().time;
  std::set<history::Life> there;
  for (const RobotLog& log : logs) {
    there.insert({log.robot, log.life});
    if (log.complete) continue;
    int64_t last = start;
    for (const Entry& e : record.entries) {
      if (e.robot == log.robot && e.incarnation == log.life) last = std::max(last, e.time);
    }
    Excuse({log.robot, log.life}, last, record, report);
    report.unchecked.push_back(
        fmt::format("what `{}` would tell of the time after {:.3f} s: it is cut off there", log.path,
                    Seconds(last - start)));
  }
  std::set<history::Life> missing;
  for (const auto& members : record.members) {
    for (const history::Life& life : members) {
      if (!there.contains(life)) missing.insert(life);
    }
  }
  for (const history::Life& life : missing) {
    Excuse(life, INT64_MIN, record, report);
    report.unchecked.push_back(
        fmt::format("what a life of {} would tell of which there is no log", fleet.robots[life.robot].name));
  }
}

// Without one clock, who was first cannot be told.
void ExcuseClocks(LogsReport& report) {
  std::erase_if(report.findings, [](const history::Finding& f) {
    return f.wrong == Wrong::kTooEarly || f.wrong == Wrong::kTooLate || f.wrong == Wrong::kTwoTeams ||
           f.wrong == Wrong::kLost || f.wrong == Wrong::kStarved;
  });
  report.unchecked.emplace_back("who acted when: the logs are of several machines, whose clocks are not one");
}

// Each final state, once, in order; and, as long as nobody fell back, what the sensors said at the start of the next round
// against what controllers promise of the time between.
void Monitored(const FleetRecord& record, Replica& replica, LogsReport& report,
               diag::Diagnostics& diagnostics) {
  koord::semantics::Team& team = replica.team();
  for (const auto& part : team.unchecked())
    report.unchecked.push_back(fmt::format("{}: {}", part.name, part.reason));
  const std::string last_long = ": on robots, rounds last as long as they take";
  for (const auto& response : team.responses()) report.unchecked.push_back(response.name + last_long);
  for (const auto& promise : team.promises()) {
    if (promise.at_end) report.unchecked.push_back(promise.name + last_long);
  }
  sim::Monitor monitor(team, diagnostics, [](const sim::Violation&, bool) {});
  std::map<std::pair<uint64_t, uint64_t>, size_t> stored;  // by place: images
  std::set<uint64_t> seen;
  std::pair<uint64_t, uint64_t> last;  // place
  std::vector<Word> settled;           // then; empty: something else happened since
  const auto& entries = record.record.entries;
  for (const Entry& e : entries) {
    if (e.kind == Kind::kFellBack) settled.clear();
    if (e.kind == Kind::kStored) stored[{e.epoch, e.round}] = e.what;
    const auto image = stored.find({e.epoch, e.round});
    if (e.kind != Kind::kCommitted || e.round == 0 || image == stored.end() ||
        image->second >= record.record.images.size() || !seen.insert(e.round).second)
      continue;
    std::vector<Word> state = history::StateOf(team, record.record.images[image->second]);
    if (state.empty()) continue;
    const double time = Seconds(e.time - entries.front().time);
    if (e.round == 1) monitor.Initially(state);
    if (!settled.empty() && last == std::pair(e.epoch, e.round - 1)) {
      std::vector<Word> now = settled;
      for (const koord::node::Cell cell : replica.node().cells().sensors()) {
        for (size_t r = 0; r < team.robots(); ++r) {
          const uint32_t at = replica.node().cells().Address(cell, r);
          std::copy_n(state.begin() + at, replica.node().cells().Width(cell), now.begin() + at);
        }
      }
      monitor.During(time, now, settled, false);
    }
    monitor.Settled(time, state, true);
    last = {e.epoch, e.round};
    settled = std::move(state);
  }
  monitor.Summary(report.length);
  report.violations = monitor.violations();
  if (seen.empty()) report.unchecked.emplace_back("the specification: no state was final");
  std::map<std::pair<std::string, uint32_t>, sim::Violation> faults;
  for (const FleetRecord::Fault& fault : record.faults) {
    auto [it, fresh] = faults.try_emplace({fault.what, fault.robot});
    if (fresh)
      it->second = {fault.what, static_cast<int>(fault.robot), Seconds(fault.time - entries.front().time), 0};
    ++it->second.count;
  }
  for (const auto& [_, violation] : faults) report.violations.push_back(violation);
}

}  // namespace

base::Result<LogsReport> JudgeLogs(const std::vector<RobotLog>& logs, const koord::Model& model,
                                   const sim::Fleet& fleet, const base::StopToken& stop,
                                   diag::Diagnostics& diagnostics) {
  if (logs.empty()) return base::Error{"there is no log"};
  std::set<history::Life> lives;
  for (const RobotLog& log : logs) {
    bool same = log.session == logs[0].session;
    for (const char* key : {"program", "spec", "fleet"})
      same = same && log.run.at(key) == logs[0].run.at(key);
    if (!same) {
      return base::Error{fmt::format("`{}` and `{}` are not of one run: their files or sessions differ",
                                     logs[0].path, log.path)};
    }
    if (!lives.insert({log.robot, log.life}).second)
      return base::Error{
          fmt::format("`{}` is there twice, or is the log of a robot that is there", log.path)};
  }
  const size_t before = diagnostics.errors();
  const std::vector<sim::Port> ports = platform::PortsOf(model, fleet, diagnostics);
  if (diagnostics.errors() != before) return base::Error{};
  const auto replica = Replica::Make(model, fleet, ports, 0, logs[0].seed, nullptr, diagnostics);
  if (replica == nullptr) return base::Error{};
  auto merged = Merged(logs, *replica);
  if (!merged.ok()) return merged.error();
  FleetRecord record = std::move(merged).value();
  const runtime::rounds::Settings settings = sim::SettingsOf(fleet);
  record.record.lease = settings.lease;
  record.record.stop_time = settings.stop_time;
  LogsReport report;
  Teller(record, fleet, report).Run();
  std::set<uint32_t> there;
  for (const RobotLog& log : logs) there.insert(log.robot);
  const bool lost = std::ranges::any_of(logs, [](const RobotLog& log) { return log.lost > 0; });
  Answers answers(*replica, model, record);
  replica->team().machine().SetHost(&answers);
  if (lost) {
    report.unchecked.emplace_back("the protocol: a robot could not keep up with its log");
  } else if (there.size() < record.record.robots) {
    report.unchecked.push_back(
        fmt::format("the protocol: there are logs of {} of {} robots", there.size(), record.record.robots));
  } else {
    history::Judge judge(replica->team(), [&](uint64_t, uint64_t round) { answers.About(round); });
    report.findings = judge.Check(record.record, stop);
    report.explained = judge.rounds();
    ExcuseMissing(logs, record.record, fleet, report);
    if (!record.one_clock) ExcuseClocks(report);
  }
  if (stop.StopRequested()) report.unchecked.emplace_back("what comes later: interrupted");
  Monitored(record, *replica, report, diagnostics);
  return report;
}

}  // namespace rondo::deploy
