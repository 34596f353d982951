#include "deploy/robot_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/hex.h"
#include "koord/semantics/story.h"
#include "platform/topics.h"
#include "trace/reader.h"
#include "transport/mailbox.h"

namespace rondo::deploy {

using history::Entry;
using history::Kind;
using nlohmann::json;

namespace {

constexpr std::array kKinds = {Kind::kStarted,   Kind::kCrashed, Kind::kContributed, Kind::kStored,
                               Kind::kCommitted, Kind::kActed,   Kind::kFellBack,    Kind::kAdopted};

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
           {"clock", {{"boot", start_}, {"wall", wall_}}},
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
  RobotLog log{path, {}, {}, true, 0};
  bool damaged = false;
  const auto visit = [&](const trace::Message& m) {
    if (m.encoding != "json") return true;
    json line = json::parse(m.bytes, nullptr, false);
    damaged |= !line.is_object();
    if (damaged) return false;
    if (m.topic == "/rondo/run") {
      log.run = std::move(line);
    } else if (line.contains("lost")) {
      log.lost = line.value("lost", uint64_t{1});
    } else {
      log.lines.push_back(std::move(line));
    }
    return true;
  };
  if (!trace::ForEachMessage(bytes.value(), visit).ok()) {
    log = {path, {}, {}, false, 0};
    const auto left = trace::ForEachMessageLeft(bytes.value(), visit);
    if (!left.ok()) return left.error();
  }
  if (damaged || !log.run.is_object() || log.run.value("engine", "") != "run")
    return base::Error{"this is no log of a robot"};
  return log;
}

namespace {

class Merger {
 public:
  Merger(const std::vector<RobotLog>& logs, Replica& replica) : logs_(logs), replica_(replica) {}

  base::Result<FleetRecord> Run() {
    try {
      const json& run = logs_.front().run;
      out_.record.robots = run.at("robots").size();
      out_.record.lease = run.at("lease").get<int64_t>();
      out_.record.stop_time = run.at("stop_time").get<int64_t>();
      for (const RobotLog& log : logs_) {
        // On one machine all clocks are the same one; on others, what the wall says has to do.
        const json& clock = log.run.at("clock");
        const json& first = run.at("clock");
        const int64_t apart = (clock.at("wall").get<int64_t>() - clock.at("boot").get<int64_t>()) -
                              (first.at("wall").get<int64_t>() - first.at("boot").get<int64_t>());
        const int64_t shift = std::abs(apart) < kSameClock ? 0 : apart;
        for (const json& line : log.lines) Add(line, shift);
      }
    } catch (const json::exception&) {
      return base::Error{"a line of a log makes no sense"};
    }
    if (!good_) return base::Error{"a log is none of this program and fleet"};
    std::ranges::stable_sort(out_.record.entries, {}, &Entry::time);
    std::ranges::stable_sort(out_.said, {}, &std::pair<int64_t, std::string>::first);
    return std::move(out_);
  }

 private:
  static constexpr int64_t kSameClock = 50'000'000;

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

  void Add(const json& line, int64_t shift) {
    Entry e;
    const auto did = line.at("did").get<std::string>();
    const auto kind = std::ranges::find_if(kKinds, [&](Kind k) { return history::Name(k) == did; });
    if (kind == kKinds.end()) {
      good_ = false;
      return;
    }
    e.kind = *kind;
    e.time = line.at("time").get<int64_t>() + shift;
    e.robot = line.at("robot").get<uint32_t>();
    e.incarnation = line.at("life").get<uint64_t>();
    e.epoch = line.at("epoch").get<uint64_t>();
    e.round = line.at("round").get<uint64_t>();
    e.what = history::kNothing;
    if (line.contains("store")) e.what = Image(line["store"]);
    if (line.contains("until")) e.until = line["until"].get<int64_t>() + shift;
    if (line.contains("said")) out_.said.emplace_back(e.time, line["said"].get<std::string>());
    if (e.kind == Kind::kContributed) {
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
        members.push_back({member.at("robot").get<uint32_t>(), member.at("life").get<uint64_t>()});
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
