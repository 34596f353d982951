#include "deploy/choreography/session_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "platform/topics.h"
#include "runtime/codec/bytes.h"
#include "trace/reader.h"
#include "transport/mailbox.h"

namespace rondo::deploy {

using nlohmann::json;

namespace {

// Texts of choreographies may have bytes that are no UTF-8.
std::string Dump(const json& j) { return j.dump(-1, ' ', false, json::error_handler_t::replace); }

}  // namespace

base::Result<std::unique_ptr<SessionLogWriter>> SessionLogWriter::Open(const std::string& path,
                                                                       const json& head) {
  auto writer = trace::Writer::Open(path);
  if (!writer.ok()) return base::Error{fmt::format("cannot write `{}`: {}", path, writer.error().message)};
  std::unique_ptr<SessionLogWriter> log(new SessionLogWriter(std::move(writer).value()));
  log->boot_ = transport::BootTime();
  log->wall_ = platform::WallTime();
  log->writer_.Message(log->writer_.Channel("/rondo/run", trace::kRecord, "json"),
                       static_cast<uint64_t>(log->wall_), Dump(head));
  log->channel_ = log->writer_.Channel("/rondo/log", trace::kRecord, "json");
  log->thread_ = std::thread([raw = log.get()] { raw->Run(); });
  return log;
}

SessionLogWriter::~SessionLogWriter() {
  events_.Close();
  if (thread_.joinable()) thread_.join();
}

void SessionLogWriter::Put(const SessionEvent& event) {
  events_.Put([&](SessionEvent& slot) { slot = event; });
}

void SessionLogWriter::Run() {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kKept(500);
  SessionEvent event;
  auto kept = Clock::now();
  while (true) {
    const bool came = events_.Take(kKept, event);
    if (came)
      writer_.Message(channel_, static_cast<uint64_t>(wall_ + std::max<int64_t>(0, event.time - boot_)),
                      Dump(ToJson(event)));
    if (Clock::now() - kept >= kKept) {
      writer_.Keep();
      kept = Clock::now();
    }
    if (!came && events_.closed()) return;
  }
}

base::Result<bool> SessionLogWriter::Finish() {
  events_.Close();
  if (thread_.joinable()) thread_.join();
  return writer_.Finish();
}

uint64_t AgreementOf(const nlohmann::json& record) {
  // Where the files lie does not matter.
  runtime::codec::Bytes bytes;
  runtime::codec::Writer writer(bytes);
  const auto add = [&](const std::string& text) {
    writer.Block({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  };
  add(record.at("choreography").get<std::string>());
  add(record.at("projections").dump());
  add(record.at("admitted").dump());
  std::vector<std::string> texts;
  for (const auto& text : record.at("texts")) texts.push_back(text.get<std::string>());
  std::ranges::sort(texts);
  for (const std::string& text : texts) add(text);
  return runtime::codec::Sum(bytes);
}

base::Result<SessionLog> ReadSessionLog(const std::string& path) {
  const auto bytes = trace::ReadTrace(path);
  if (!bytes.ok()) return bytes.error();
  SessionLog log;
  bool damaged = false;
  const auto visit = [&](const trace::Message& m) {
    const json j = json::parse(m.bytes, nullptr, false);
    if (m.topic == "/rondo/run") log.run = j;
    if (m.topic != "/rondo/log") return true;
    auto event = EventIn(j);
    damaged = damaged || !event;
    if (event) log.events.push_back(std::move(*event));
    return true;
  };
  if (!trace::ForEachMessage(bytes.value(), visit).ok()) {
    log = SessionLog();
    log.complete = damaged = false;
    const auto left = trace::ForEachMessageLeft(bytes.value(), visit);
    if (!left.ok()) return left.error();
  }
  log.path = path;
  try {
    if (damaged || log.run.at("engine").get<std::string>() != "session")
      return base::Error{"this is no log of a robot of a choreography"};
    log.run.at("robot").get_to(log.robot);
    log.run.at("session").get_to(log.session);
    log.run.at("tolerance").get_to(log.tolerance);
    log.agreement = AgreementOf(log.run);
  } catch (const json::exception&) {
    return base::Error{"this is no log of a robot of a choreography, or it is damaged"};
  }
  log.complete = log.complete && !log.events.empty() && log.events.back().did == Did::kLeaves;
  return log;
}

}  // namespace rondo::deploy
