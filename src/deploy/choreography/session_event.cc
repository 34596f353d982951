#include "deploy/choreography/session_event.h"

#include <array>
#include <limits>
#include <nlohmann/json.hpp>

namespace rondo::deploy {

namespace {

constexpr std::array kAll = {Did::kWaits, Did::kStarts, Did::kBegins, Did::kEnds,
                             Did::kSent,  Did::kTook,   Did::kBreaks, Did::kLeaves};

}  // namespace

std::string_view Name(Did did) {
  switch (did) {
    case Did::kWaits:
      return "waits";
    case Did::kStarts:
      return "starts";
    case Did::kBegins:
      return "begins";
    case Did::kEnds:
      return "ends";
    case Did::kSent:
      return "sent";
    case Did::kTook:
      return "took";
    case Did::kBreaks:
      return "breaks";
    case Did::kLeaves:
      return "leaves";
  }
  return "";
}

nlohmann::json ToJson(const SessionEvent& e) {
  nlohmann::json j{{"did", Name(e.did)}, {"time", e.time}, {"robot", e.robot}, {"what", e.what}};
  if (e.did == Did::kSent || e.did == Did::kTook) {
    j["peer"] = e.peer;
    j["values"] = e.values;
  }
  if (e.did == Did::kEnds || e.did == Did::kBreaks) j["missed"] = e.missed;
  if (e.did == Did::kEnds) j["late"] = e.late;
  if (e.did == Did::kLeaves) j["outcome"] = e.outcome;
  return j;
}

std::optional<SessionEvent> EventIn(const nlohmann::json& j) {
  try {
    SessionEvent e;
    const auto name = j.at("did").get<std::string>();
    for (const Did did : kAll) {
      if (Name(did) != name) continue;
      e.did = did;
      e.time = j.at("time").get<int64_t>();
      j.at("robot").get_to(e.robot);
      j.at("what").get_to(e.what);
      e.peer = j.value("peer", "");
      e.values = j.value("values", std::vector<double>());
      e.late = j.value("late", 0.0);
      // JSON has no infinity: of what has no value.
      if (j.contains("missed"))
        e.missed =
            j["missed"].is_null() ? std::numeric_limits<double>::infinity() : j["missed"].get<double>();
      e.outcome = j.value("outcome", "");
      return e;
    }
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace rondo::deploy
