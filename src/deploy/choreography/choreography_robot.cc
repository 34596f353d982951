#include "deploy/choreography/choreography_robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "deploy/announcer.h"
#include "deploy/choreography/session_log.h"
#include "deploy/log_name.h"
#include "platform/topics.h"
#include "ros/names.h"
#include "transport/dds/way.h"
#include "transport/mailbox.h"
#include "transport/sessions.h"

namespace rondo::deploy {

using runtime::sessions::Member;
using runtime::sessions::Outcome;
using runtime::sessions::Phase;
using transport::Seconds;

namespace {

class PlayerProcess {
 public:
  PlayerProcess(const choreo::Cast& cast, const PlayerOptions& options)
      : cast_(cast), options_(options), name_(cast.graph->NameOf(options.robot)) {}

  base::Result<bool> Prepare() {
    auto participant = dds::Participant::Open(options_.network);
    if (!participant.ok()) return participant.error();
    participant_ = std::move(participant).value();
    if (auto begun = Connect(); !begun.ok()) return begun;
    if (options_.log.empty()) return true;
    nlohmann::json head = options_.record;
    head["engine"] = "session";
    head["robot"] = name_;
    head["tolerance"] = options_.precision.tolerance;
    head["session"] = fmt::format("{:016x}", options_.session);
    report_.log = UnusedLogName(options_.log);
    auto log = SessionLogWriter::Open(report_.log, head);
    if (!log.ok()) return log.error();
    log_ = std::move(log).value();
    return true;
  }

  PlayerReport Run() {
    if (WaitForSensors()) Play();
    SessionEvent last;
    last.did = Did::kLeaves;
    last.outcome = Name(report_.outcome);
    last.what = report_.why;
    Say(std::move(last));
    player_->Stop();
    return report_;
  }

  base::Result<bool> Finish() { return log_ == nullptr ? base::Result<bool>(true) : log_->Finish(); }

 private:
  base::Result<bool> Connect() {
    const robot::World& world = *cast_.graph->world;
    const expr::Arena& arena = cast_.declarations->evaluator().arena();
    const sim::motions::SceneState scene(world);
    if (const std::string both = platform::Collision(world, arena, scene); !both.empty())
      return base::Error{both};
    // Who stands on another robot has to know where that is.
    std::vector<size_t> heard;
    for (std::optional<size_t> r = options_.robot.index(); r; r = world.bodies[*r].parent)
      heard.push_back(*r);
    std::vector<platform::BodyTopics> bodies;
    for (const size_t r : heard) bodies.push_back(platform::TopicsOf(world, r, arena, scene));
    std::vector<platform::Signal> signals = bodies[0].signals;
    for (platform::Signal& s : platform::EnvironmentOf(world, arena, scene)) signals.push_back(std::move(s));
    const std::string space = "/" + bodies[0].node_namespace;
    const size_t node = participant_->AddNode({space, "rondo"});
    const std::string events = bodies[0].Full("events");
    orders_.emplace(bodies[0]);
    senses_.emplace(std::move(bodies), signals, options_.max_age);
    if (auto begun = senses_->Begin(*participant_, node); !begun.ok()) return begun;
    if (auto begun = orders_->Begin(*participant_, node); !begun.ok()) return begun;
    auto said = participant_->Publish(node, events, ros::std_msgs::String::kMessage, {.depth = 1000});
    if (!said.ok()) return said.error();
    events_ = std::move(said).value();
    announcer_.emplace(space.substr(1), options_.tell);
    if (auto begun = announcer_->Begin(*participant_, node); !begun.ok()) return begun;
    std::vector<std::string> names;
    for (const choreo::Name& robot : cast_.graph->robots) names.push_back(ros::Plain(robot.text));
    auto way = transport::dds::Connect(*participant_, node,
                                       {ros::Plain(options_.program), names, options_.robot.value});
    if (!way.ok()) return way.error();
    way_ = std::move(way).value();
    player_.emplace(cast_, options_.robot, options_.precision, options_.seed, heard, *senses_, *orders_,
                    [this](SessionEvent event) { Say(std::move(event)); });
    return true;
  }

  void Say(SessionEvent event) {
    event.time = transport::BootTime();
    event.robot = name_;
    ros::std_msgs::String m;
    m.data = ToJson(event).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    (void)events_->Publish(m).ok();
    if (log_ != nullptr) log_->Put(event);
  }

  // A person, and whoever listens: once for each reason, and neither for a moment's wait nor all the time.
  void Waits(const std::string& why, int64_t since) {
    constexpr double kMoment = 0.5, kAgain = 2;
    const int64_t now = transport::BootTime();
    if (why == waited_for_ || Seconds(now - since) < kMoment || Seconds(now - told_) < kAgain) return;
    waited_for_ = why;
    told_ = now;
    announcer_->Tell("waiting: " + why, Announcer::Level::kWarning, platform::WallTime());
    SessionEvent event;
    event.did = Did::kWaits;
    event.what = why;
    Say(std::move(event));
  }

  bool WaitForSensors() {
    const int64_t since = transport::BootTime();
    for (std::string why = senses_->Unusable(); !why.empty(); why = senses_->Unusable()) {
      if (options_.stop.StopRequested()) return false;
      Waits(why, since);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    player_->Begin();
    return true;
  }

  void Play() {
    runtime::sessions::MemberSettings settings;
    settings.session = options_.session;
    settings.agreement = options_.agreement;
    // Greater than in any life before, as long as the clock on the wall goes forward between lives.
    settings.incarnation = static_cast<uint64_t>(platform::WallTime());
    settings.self = options_.robot.value;
    settings.robots = cast_.graph->robots.size();
    settings.patience = static_cast<int64_t>(options_.patience * 1e9);
    Member member(settings, player_->program(), player_->motions());
    const int64_t since = transport::BootTime();
    int64_t begun = 0;
    const base::StopToken stop;
    transport::Drive(member, *way_, stop, [&](int64_t now) {
      if (member.outcome() != Outcome::kOpen) {
        player_->Stop();
        return;
      }
      const bool gathers = member.phase() == Phase::kGathering;
      if (gathers) Waits(Awaited(member), since);
      if (!gathers && begun == 0) {
        begun = now;
        SessionEvent event;
        event.did = Did::kStarts;
        Say(std::move(event));
      }
      report_.time_over = options_.duration > 0 && begun > 0 && Seconds(now - begun) >= options_.duration;
      if (options_.stop.StopRequested() || report_.time_over) stop.RequestStop();
      if (const std::string blind = senses_->Unusable(); !blind.empty() && report_.why.empty()) {
        report_.why = "its sensors: " + blind;
        stop.RequestStop();
        return;
      }
      player_->Step(now);
    });
    report_.begun = begun > 0;
    report_.time = report_.begun ? Seconds(transport::BootTime() - begun) : 0;
    report_.outcome = member.outcome();
    if (!report_.why.empty() && report_.outcome == Outcome::kLeft) report_.outcome = Outcome::kFailed;
    if (report_.why.empty())
      report_.why = report_.outcome == Outcome::kFailed && !player_->trouble().empty()
                        ? player_->trouble()
                        : member.Why([&](uint32_t r) {
                            return fmt::format("`{}`", cast_.graph->NameOf(choreo::RobotId(r)));
                          });
    report_.messages = player_->messages();
    report_.motions = player_->motions_made();
    report_.missed = player_->missed();
    report_.missed_by = player_->missed_by();
    report_.late = player_->late();
    report_.broken = player_->broken();
  }

  std::string Awaited(const Member& member) const {
    if (member.foreign() > 0) return "somebody runs another choreography, or another version of it";
    if (member.strange() > 0) return "the others are in another session (`--session`)";
    std::vector<std::string> names;
    for (const uint32_t r : member.Missing())
      names.push_back(fmt::format("`{}`", cast_.graph->NameOf(choreo::RobotId(r))));
    return fmt::format("for {}", fmt::join(names, ", "));
  }

  const choreo::Cast& cast_;
  const PlayerOptions& options_;
  const std::string name_;
  std::unique_ptr<dds::Participant> participant_;
  std::unique_ptr<dds::Publisher> events_;
  std::optional<Announcer> announcer_;
  std::optional<platform::StateOrders> orders_;
  std::optional<platform::StateSenses> senses_;
  std::unique_ptr<transport::Transport> way_;
  std::unique_ptr<SessionLogWriter> log_;
  std::optional<Player> player_;
  std::string waited_for_;
  int64_t told_ = 0;
  PlayerReport report_;
};

}  // namespace

base::Result<PlayerReport> RunPlayer(const choreo::Cast& cast, const PlayerOptions& options) {
  PlayerProcess process(cast, options);
  if (const auto prepared = process.Prepare(); !prepared.ok()) return prepared.error();
  const PlayerReport report = process.Run();
  if (const auto finished = process.Finish(); !finished.ok())
    return base::Error{fmt::format("cannot write `{}`: {}", options.log, finished.error().message)};
  return report;
}

}  // namespace rondo::deploy
