#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "base/result.h"
#include "base/ring.h"
#include "deploy/replica.h"
#include "history/record.h"
#include "trace/writer.h"

namespace rondo::deploy {

/// Is a line of a robot's log, as its thread hands it on. Memory is kept.
struct LogLine {
  history::Kind kind = history::Kind::kStarted;
  int64_t time = 0;              ///< CLOCK_BOOTTIME, nanoseconds
  int64_t stamp = 0;             ///< since 1970
  std::optional<int64_t> clock;  ///< of the clock by which it runs, if that is simulated
  int64_t until = 0;             ///< kActed: on the clock by which it runs
  uint64_t epoch = 0, round = 0;
  runtime::codec::Bytes bytes;  ///< kStored, kFellBack: a state; kContributed: what was said
  std::vector<uint32_t> waits;
  bool skips = false;
  std::vector<CallAnswer> calls;
  std::vector<history::Life> members;
  std::string said;  ///< kActed: what the robot says to streams; kContributed: an operation that has no value
};

/// Says of which robot a log is, and of what run.
struct LogHead {
  uint32_t robot = 0;
  uint64_t incarnation = 0, session = 0, seed = 0;
  int64_t lease = 0, stop_time = 0;  ///< nanoseconds
  std::vector<std::string> names;    ///< of the robots
  std::string program_name, program, spec, fleet;
  nlohmann::json files;
};

/// Writes what a robot does as MCAP, on a thread of its own: `/rondo/run` says of what run it is, `/rondo/log` has each line.
/// What was said half a second ago is in the file, whatever happens. If it cannot keep up, lines are lost, and it says how
/// many.
class LogWriter {
 public:
  /// @param replica  only the log uses it.
  /// @error if the file cannot be written.
  static base::Result<std::unique_ptr<LogWriter>> Open(const std::string& path, const LogHead& head,
                                                       std::unique_ptr<Replica> replica);
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;
  ~LogWriter();

  /// Hands on a line: `fill` writes it over an old one, whose memory it may use.
  template <class Fill>
  void Put(const Fill& fill) {
    lines_.Put(fill);
  }
  /// Completes the file. @error if anything could not be written.
  base::Result<bool> Finish();

 private:
  LogWriter(trace::Writer writer, const LogHead& head, std::unique_ptr<Replica> replica);
  void Run();
  void Write(const LogLine& line);

  trace::Writer writer_;
  uint16_t channel_ = 0;
  const LogHead head_;
  std::unique_ptr<Replica> replica_;
  int64_t start_ = 0;  // what BOOTTIME said when the wall said `wall_`
  int64_t wall_ = 0;
  base::Ring<LogLine> lines_{4096};
  std::thread thread_;
};

/// Is a log that was read.
struct RobotLog {  // NOLINT(bugprone-exception-escape): moving JSON checks itself
  std::string path;
  nlohmann::json run;
  std::vector<nlohmann::json> lines;
  bool complete = true;  ///< else its robot was killed
  uint64_t lost = 0;     ///< how often it could not keep up
  uint32_t robot = 0;
  uint64_t life = 0, seed = 0;
  std::string session;
  int64_t boot = 0, wall = 0;  ///< what clocks said when it began, nanoseconds
  std::string machine;         ///< the same for logs of one machine, as long as it is not started again
};

/// Reads the log of one robot, complete or not. @error if it is none.
base::Result<RobotLog> ReadRobotLog(const std::string& path);

/// Is what a fleet did, and what its functions answered.
struct FleetRecord {
  history::Record record;
  struct Answer {
    uint64_t round;
    runtime::codec::Bytes value;
  };
  std::map<std::pair<uint32_t, uint64_t>, std::vector<Answer>> answers;  ///< by robot and question
  struct Fault {
    int64_t time;
    uint32_t robot;
    std::string what;  ///< an operation of an event has no value
  };
  std::vector<Fault> faults;
  bool one_clock = true;  ///< all logs are of one machine; else times are as good as the clocks on the walls
};

/// Puts logs together: those of one machine in order of time, others in order of rounds. `lease` and `stop_time` of the record
/// are to be set. @error if a line makes no sense.
base::Result<FleetRecord> Merged(const std::vector<RobotLog>& logs, Replica& replica);

}  // namespace rondo::deploy
