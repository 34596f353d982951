#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/stop.h"
#include "deploy/latencies.h"
#include "deploy/robot_log.h"
#include "platform/orders.h"
#include "platform/senses.h"
#include "transport/transport.h"

namespace rondo::deploy {

using runtime::rounds::Time;

/// Is what can be seen from outside of a robot that runs rounds.
struct RoundView {
  runtime::rounds::Phase phase = runtime::rounds::Phase::kOutside;
  runtime::rounds::Place place;
  bool active = false;
  uint64_t refused = 0, foreign = 0, strange = 0;  ///< datagrams: of them of other files, of other sessions
  std::vector<std::string> unheard;                ///< robots that it misses
  std::optional<Time> begun_at, stopped_at;        ///< the first round; every robot stopped
  uint64_t rounds = 0;                             ///< the latest that it knew to be final
  uint64_t fallbacks = 0, blind = 0, failed = 0;
  double median = 0, p99 = 0, most = 0;  ///< seconds from what it said to the end of the round
  std::string broken;                    ///< what the protocol found wrong with itself
};

/// Runs the rounds of one robot on the thread that calls `Run`: the core decides, orders and log get what comes of it. Waits
/// for nothing of the world but datagrams.
class RoundThread {
 public:
  /// @param log  nullptr: there is none. All outlive this.
  RoundThread(const sim::Fleet& fleet, uint32_t robot, Replica& replica, platform::Senses& senses,
              platform::Orders& orders, const platform::Clock& clock, LogWriter* log);

  /// Begins a life, and runs rounds until somebody asks for a stop.
  /// @param record  what an earlier life left on the disk.
  void Run(const runtime::rounds::Settings& settings, runtime::rounds::Disk* disk,
           const std::optional<runtime::codec::Bytes>& record, transport::Transport& way,
           const base::StopToken& stop);

  /// Return, to any thread, how it is, and what people should know since the last call, with levels as in ROS logs.
  RoundView View() const;
  std::vector<std::pair<std::string, uint8_t>> TakeNews();

 private:
  template <class Fill>
  void Log(history::Kind kind, runtime::rounds::Place at, const Fill& fill);
  koord::node::Node& Node() { return replica_.node(); }
  void News(std::string text, uint8_t level = 20) { news_.emplace_back(std::move(text), level); }
  void Look();
  void Do(const runtime::rounds::Send&) {}
  void Do(const runtime::rounds::Contributed& c);
  void Do(const runtime::rounds::Stored& stored);
  void Do(const runtime::rounds::Committed& c);
  void Do(const runtime::rounds::Act& act);
  void Do(const runtime::rounds::FallBack&);
  void Do(const runtime::rounds::Adopted& a);
  void Do(const runtime::rounds::Broken& broken);
  std::string Told(const koord::node::Failure& failed) const;
  void FallBack();
  void Give(const std::vector<koord::node::Cell>& cells, const std::vector<Word>& state, bool always);
  bool AllStopped();

  const sim::Fleet& fleet_;
  const uint32_t self_;
  Replica& replica_;
  platform::Senses& senses_;
  platform::Orders& orders_;
  const platform::Clock& clock_;
  LogWriter* log_;
  runtime::rounds::Settings settings_;
  std::unique_ptr<runtime::rounds::Core> core_;
  Time now_ = 0;
  runtime::rounds::Place contributed_;
  Time contributed_at_ = 0, looked_at_ = 0;
  uint64_t acted_ = 0;
  std::vector<sim::Point> path_;  // kept for its memory

  mutable std::mutex mutex_;  // of what others see
  RoundView view_;
  std::vector<bool> unheard_;  // by robot
  Latencies latencies_;
  std::vector<std::pair<std::string, uint8_t>> news_;
};

}  // namespace rondo::deploy
