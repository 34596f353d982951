#include "deploy/robot_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "base/hex.h"
#include "koord/semantics/story.h"
#include "platform/topics.h"
#include "runtime/codec/messages.h"
#include "trace/reader.h"
#include "transport/mailbox.h"

namespace rondo::deploy {

using history::Entry;
using history::Kind;
using nlohmann::json;

namespace {

constexpr std::array kKinds = {Kind::kStarted,   Kind::kCrashed, Kind::kContributed, Kind::kStored,
                               Kind::kCommitted, Kind::kActed,   Kind::kFellBack,    Kind::kAdopted};

// Tells apart machines, and their lives: clocks of one are one clock.
std::string MachineLife() {
  std::ifstream file("/proc/sys/kernel/random/boot_id");
  std::string text;
  file >> text;
  return text;
}

// Numbers as they were written; others would be cut.
int64_t Whole(const json& j) {
  if (!j.is_number_integer()) throw json::other_error::create(501, "no whole number", nullptr);
  return j.get<int64_t>();
}
template <class T>
T Least(const json& j, T most) {
  const int64_t number = Whole(j);
  if (number < 0 || (most != 0 && static_cast<uint64_t>(number) > static_cast<uint64_t>(most)))
    throw json::other_error::create(501, "out of range", nullptr);
  return static_cast<T>(number);
}

// Texts of programs and robots may have bytes that are no UTF-8.
std::string Dump(const json& j) { return j.dump(-1, ' ', false, json::error_handler_t::replace); }

}  // namespace

base::Result<std::unique_ptr<LogWriter>> LogWriter::Open(const std::string& path, const LogHead& head,
                                                         std::unique_ptr<Replica> replica) {
  auto writer = trace::Writer::Open(path);
  if (!writer.ok()) return base::Error{fmt::format("cannot write `{}`: {}", path, writer.error().message)};
  return std::unique_ptr<LogWriter>(new LogWriter(std::move(writer).value(), head, std::move(replica)));
}

LogWriter::LogWriter(trace::Writer writer, const LogHead& head, std::unique_ptr<Replica> replica)
    : writer_(std::move(writer)),
      head_(head),
      replica_(std::move(replica)),
      start_(transport::BootTime()),
      wall_(platform::WallTime()) {
  json robots = json::array();
  for (size_t r = 0; r < head_.names.size(); ++r)
    robots.push_back({{"name", head_.names[r]}, {"radius", replica_->body(r).radius()}});
  json run{{"format", "rondo-trace/1"},
           {"engine", "run"},
           {"robot", head_.robot},
           {"life", head_.incarnation},
           {"session", fmt::format("{:016x}", head_.session)},
           {"seed", head_.seed},
           {"lease", head_.lease},
           {"stop_time", head_.stop_time},
           {"clock", {{"boot", start_}, {"wall", wall_}, {"machine", MachineLife()}}},
           {"robots", robots},
           {"program_name", head_.program_name},
           {"program", head_.program},
           {"spec", head_.spec},
           {"fleet", head_.fleet}};
  if (!head_.files.is_null()) run["files"] = head_.files;
  writer_.Message(writer_.Channel("/rondo/run", trace::kRecord, "json"), static_cast<uint64_t>(wall_),
                  Dump(run));
  channel_ = writer_.Channel("/rondo/log", trace::kRecord, "json");
  thread_ = std::thread([this] { Run(); });
}

LogWriter::~LogWriter() {
  lines_.Close();
  if (thread_.joinable()) thread_.join();
}

void LogWriter::Run() {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kKept(500);
  LogLine line;
  auto kept = Clock::now();
  size_t lost = 0;
  while (true) {
    const bool came = lines_.Take(kKept, line);
    if (came) Write(line);
    if (const size_t now = lines_.lost(); now != lost) {
      lost = now;
      writer_.Message(channel_, static_cast<uint64_t>(line.stamp),
                      Dump({{"robot", head_.robot}, {"lost", lost}}));
    }
    if (Clock::now() - kept >= kKept) {
      writer_.Keep();
      kept = Clock::now();
    }
    if (!came && lines_.closed()) return;
  }
}

void LogWriter::Write(const LogLine& line) {
  json j{{"robot", head_.robot}, {"life", head_.incarnation}, {"did", history::Name(line.kind)},
         {"epoch", line.epoch},  {"round", line.round},       {"time", line.time}};
  const bool stores = line.kind == Kind::kStored || (line.kind == Kind::kFellBack && !line.bytes.empty());
  if (stores) {
    j["store"] = base::Hex(line.bytes);
    if (const auto state = replica_->StateOf(line.bytes))
      j["state"] = koord::semantics::StateToJson(replica_->team(), *state);
  }
  if (line.kind == Kind::kContributed) {
    j["frame"] = base::Hex(line.bytes);
    if (!line.waits.empty()) j["waits"] = line.waits;
    if (line.skips) j["skips"] = true;
    for (const CallAnswer& call : line.calls)
      j["calls"].push_back(
          {{"question", fmt::format("{:016x}", call.question)}, {"answer", base::Hex(call.value)}});
  }
  if (line.kind == Kind::kActed) j["until"] = line.until;
  if (line.clock) j["clock"] = *line.clock;
  if (!line.said.empty()) j["said"] = line.said;
  for (const history::Life& life : line.members)
    j["members"].push_back({{"robot", life.robot}, {"life", life.incarnation}});
  // Other clocks may step; the time of a file does not.
  writer_.Message(channel_, static_cast<uint64_t>(wall_ + std::max<int64_t>(0, line.time - start_)), Dump(j));
}

base::Result<bool> LogWriter::Finish() {
  lines_.Close();
  if (thread_.joinable()) thread_.join();
  return writer_.Finish();
}

base::Result<RobotLog> ReadRobotLog(const std::string& path) {
  const auto bytes = trace::ReadTrace(path);
  if (!bytes.ok()) return bytes.error();
  RobotLog log;
  log.path = path;
  bool damaged = false;
  const auto visit = [&](const trace::Message& m) {
    if (m.encoding != "json") return true;
    json line = json::parse(m.bytes, nullptr, false);
    damaged |= !line.is_object();
    if (damaged) return false;
    if (m.topic == "/rondo/run") {
      log.run = std::move(line);
    } else if (line.contains("lost")) {
      ++log.lost;
    } else {
      log.lines.push_back(std::move(line));
    }
    return true;
  };
  if (!trace::ForEachMessage(bytes.value(), visit).ok()) {
    log = RobotLog();
    log.path = path;
    log.complete = false;
    damaged = false;
    const auto left = trace::ForEachMessageLeft(bytes.value(), visit);
    if (!left.ok()) return left.error();
  }
  try {
    if (damaged || log.run.at("engine").get<std::string>() != "run")
      return base::Error{"this is no log of a robot"};
    log.robot = Least<uint32_t>(log.run.at("robot"), runtime::codec::kMostRobots);
    log.life = Least<uint64_t>(log.run.at("life"), 0);
    log.seed = Least<uint64_t>(log.run.at("seed"), 0);
    log.session = log.run.at("session").get<std::string>();
    log.boot = Whole(log.run.at("clock").at("boot"));
    log.wall = Whole(log.run.at("clock").at("wall"));
    log.machine = log.run.at("clock").at("machine").get<std::string>();
    for (const char* text : {"program", "spec", "fleet", "program_name"})
      (void)log.run.at(text).get<std::string>();
  } catch (const json::exception&) {
    return base::Error{"this is no log of a robot, or it is damaged"};
  }
  return log;
}

namespace {

class Merger {
 public:
  Merger(const std::vector<RobotLog>& logs, Replica& replica) : logs_(logs), replica_(replica) {}

  base::Result<FleetRecord> Run() {
    out_.record.robots = replica_.team().robots();
    for (const RobotLog& log : logs_) {
      // On one machine all clocks are the same one; on others, what the wall says has to do.
      const bool same = log.machine == logs_[0].machine;
      out_.one_clock = out_.one_clock && same;
      const int64_t shift = same ? 0 : (log.wall - log.boot) - (logs_[0].wall - logs_[0].boot);
      try {
        for (const json& line : log.lines) Add(line, log, shift);
      } catch (const json::exception&) {
        good_ = false;
      }
      if (!good_) return base::Error{fmt::format("a line of `{}` makes no sense", log.path)};
    }
    if (out_.one_clock) {
      std::ranges::stable_sort(out_.record.entries, {}, &Entry::time);
    } else {
      // By what has to come first: what is said in a round, what it leads to.
      const auto step = [](const Entry& e) {
        const bool said = e.kind == Kind::kContributed || e.kind == Kind::kFellBack;
        return std::tuple(e.epoch, 2 * e.round + (said ? 1 : 0), e.time);
      };
      std::ranges::stable_sort(out_.record.entries, {}, step);
    }
    return std::move(out_);
  }

 private:
  static constexpr uint64_t kMostRounds = uint64_t{1} << 48;

  runtime::codec::Bytes Bytes(const json& text) {
    auto bytes = base::FromHex(text.get<std::string>());
    good_ = good_ && bytes.has_value();
    return bytes.value_or(runtime::codec::Bytes());
  }

  size_t Image(const json& store) {
    const auto [it, fresh] = images_.emplace(store.get<std::string>(), out_.record.images.size());
    if (!fresh) return it->second;
    const auto state = replica_.StateOf(Bytes(store));
    good_ = good_ && state.has_value();
    out_.record.images.push_back(state ? history::ImageOf(replica_.team(), *state) : history::Image());
    return it->second;
  }

  void Add(const json& line, const RobotLog& log, int64_t shift) {
    Entry e;
    const auto did = line.at("did").get<std::string>();
    const auto kind = std::ranges::find_if(kKinds, [&](Kind k) { return history::Name(k) == did; });
    good_ = good_ && kind != kKinds.end();
    if (!good_) return;
    e.kind = *kind;
    constexpr int64_t kLatest = int64_t{1} << 61;
    e.time = Least<int64_t>(line.at("time"), kLatest) + shift;
    e.robot = Least<uint32_t>(line.at("robot"), static_cast<uint32_t>(out_.record.robots - 1));
    e.incarnation = Least<uint64_t>(line.at("life"), 0);
    e.epoch = Least<uint64_t>(line.at("epoch"), kMostRounds);
    e.round = Least<uint64_t>(line.at("round"), kMostRounds);
    good_ = good_ && e.robot == log.robot && e.incarnation == log.life;
    e.what = history::kNothing;
    if (line.contains("store")) e.what = Image(line["store"]);
    good_ = good_ && (e.kind != Kind::kStored || line.contains("store"));
    // A simulated clock is the same on all machines.
    if (line.contains("clock")) e.clock = Least<int64_t>(line["clock"], kLatest);
    if (e.kind == Kind::kActed) e.until = Least<int64_t>(line.at("until"), kLatest) + (e.clock ? 0 : shift);
    const std::string said = line.contains("said") ? line["said"].get<std::string>() : std::string();
    if (e.kind == Kind::kContributed) {
      if (!said.empty()) out_.faults.push_back({e.time, e.robot, said});
      e.what = out_.record.texts.size();
      out_.record.texts.push_back(Bytes(line.at("frame")));
      e.waits = line.value("waits", std::vector<uint32_t>());
      e.skips = line.value("skips", false);
      for (const json& call : line.value("calls", json::array())) {
        uint64_t question = 0;
        for (const uint8_t byte : Bytes(call.at("question"))) question = question << 8 | byte;
        out_.answers[{e.robot, question}].push_back({e.round, Bytes(call.at("answer"))});
      }
    }
    if (e.kind == Kind::kAdopted) {
      e.what = out_.record.members.size();
      auto& members = out_.record.members.emplace_back();
      for (const json& member : line.value("members", json::array()))
        members.push_back({Least<uint32_t>(member.at("robot"), static_cast<uint32_t>(out_.record.robots - 1)),
                           Least<uint64_t>(member.at("life"), 0)});
    }
    out_.record.entries.push_back(std::move(e));
  }

  const std::vector<RobotLog>& logs_;
  Replica& replica_;
  FleetRecord out_;
  std::map<std::string, size_t> images_;  // by what frames have
  bool good_ = true;
};

}  // namespace

base::Result<FleetRecord> Merged(const std::vector<RobotLog>& logs, Replica& replica) {
  return Merger(logs, replica).Run();
}

}  // namespace rondo::deploy
