#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "base/result.h"
#include "base/ring.h"
#include "deploy/choreography/session_event.h"
#include "trace/writer.h"

namespace rondo::deploy {

/// Writes what a robot of a choreography does as MCAP, on a thread of its own: `/rondo/run` says of what run it is, `/rondo/log` has
/// each event. What was said half a second ago is in the file, whatever happens.
class SessionLogWriter {
 public:
  /// @param head  the record of the choreography, with `robot` (its name), `session` and `life`.
  /// @error if the file cannot be written.
  static base::Result<std::unique_ptr<SessionLogWriter>> Open(const std::string& path,
                                                              const nlohmann::json& head);
  SessionLogWriter(const SessionLogWriter&) = delete;
  SessionLogWriter& operator=(const SessionLogWriter&) = delete;
  ~SessionLogWriter();

  void Put(const SessionEvent& event);
  /// Completes the file. @error if anything could not be written.
  base::Result<bool> Finish();

 private:
  explicit SessionLogWriter(trace::Writer writer) : writer_(std::move(writer)) {}
  void Run();

  trace::Writer writer_;
  uint16_t channel_ = 0;
  int64_t boot_ = 0, wall_ = 0;  // what clocks said in the beginning
  base::Ring<SessionEvent> events_{4096};
  std::thread thread_;
};

/// Returns the sum of what all robots must have in common: the texts of a choreography, wherever they lie, and who follows what.
/// The record is one of `runs::LogRecordOf`; what it lacks is reported as an exception of the library of JSON.
uint64_t AgreementOf(const nlohmann::json& record);

/// Is a log that was read.
struct SessionLog {  // NOLINT(bugprone-exception-escape): moving JSON checks itself
  std::string path;
  nlohmann::json run;
  std::string robot, session;
  std::vector<SessionEvent> events;
  uint64_t agreement = 0;
  double tolerance = 0;  ///< by which contracts may be missed
  bool complete = true;  ///< it has the end of its robot's part; else that was killed, or the log was cut
};

/// Reads the log of one robot, complete or not. @error if it is none.
base::Result<SessionLog> ReadSessionLog(const std::string& path);

}  // namespace rondo::deploy
