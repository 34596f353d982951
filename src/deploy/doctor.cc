#include "deploy/doctor.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include "dds/participant.h"
#include "deploy/echo.h"
#include "platform/ports.h"
#include "platform/topics.h"
#include "ros/nav_msgs.h"
#include "ros/sensor_msgs.h"
#include "transport/mailbox.h"

namespace rondo::deploy {

using platform::Carries;
using platform::Topic;
using transport::Seconds;

namespace {

// One topic of a robot, and what was heard on it.
struct Watched {
  size_t robot;
  Topic topic;
  bool sensor;
  size_t count = 0;
  std::optional<int64_t> first, last;  // BOOTTIME
  std::optional<double> behind;        // seconds by which stamps are behind the clock here
};

class Examination {
 public:
  Examination(const koord::Model& model, const sim::Fleet& fleet, const std::string& agreement)
      : model_(model), fleet_(fleet), agreement_(agreement), echoes_(fleet.robots.size()) {}

  base::Result<Health> Run(const dds::Network& network, double seconds, const base::StopToken& stop,
                           diag::Diagnostics& diagnostics) {
    const size_t before = diagnostics.errors();
    ports_ = platform::PortsOf(model_, fleet_, diagnostics);
    if (diagnostics.errors() != before) return base::Error{};
    auto participant = dds::Participant::Open(network);
    if (!participant.ok()) return participant.error();
    const auto begun = Listen(*participant.value());
    if (!begun.ok()) return begun.error();
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    for (uint32_t number = 0; std::chrono::steady_clock::now() < end && !stop.StopRequested(); ++number) {
      for (const auto& publisher : questions_)
        (void)publisher->Write(Encoded({number, platform::WallTime(), 0})).ok();
      ++asked_;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    // What was asked last is on its way.
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const auto endpoints = participant.value()->Endpoints();
    nodes_ = participant.value()->Nodes();
    const dds::Guid self = participant.value()->guid();
    subscriptions_.clear();
    questions_.clear();
    domain_ = network.domain;
    Robots();
    if (fleet_.ros.use_sim_time) Clocks(endpoints, self);
    Topics(endpoints, self);
    Qualities(endpoints, self);
    return std::move(health_);
  }

 private:
  void Wrong(std::string of, std::string what, std::string help) {
    health_.troubles.push_back({true, std::move(of), std::move(what), std::move(help)});
  }

  base::Result<bool> Listen(dds::Participant& participant) {
    const size_t node = participant.AddNode({"/", "rondo_doctor"});
    const auto subscribe = [&](const std::string& topic, const ros::Message& type, const ros::Qos& qos,
                               dds::Receive receive) -> base::Result<bool> {
      auto subscription =
          participant.Subscribe(node, topic, type, qos, std::move(receive), dds::From::kOthers);
      if (!subscription.ok()) return subscription.error();
      subscriptions_.push_back(std::move(subscription).value());
      return true;
    };
    if (auto done =
            subscribe("/diagnostics", ros::diagnostic_msgs::DiagnosticArray::kMessage, {.depth = 1000},
                      [this](std::string_view bytes, const dds::Received&) { Hear(bytes); });
        !done.ok())
      return done;
    for (size_t r = 0; r < fleet_.robots.size(); ++r) {
      const EchoTopics topics = EchoTopicsOf(fleet_, r);
      auto publisher = participant.Publish(node, topics.questions, EchoMessage(), kEchoes);
      if (!publisher.ok()) return publisher.error();
      questions_.push_back(std::move(publisher).value());
      if (auto done =
              subscribe(topics.answers, EchoMessage(), kEchoes,
                        [this, r](std::string_view bytes, const dds::Received&) { Answered(r, bytes); });
          !done.ok())
        return done;
      for (const sim::Port& port : ports_) {
        const auto topic = platform::TopicOf(model_, fleet_, r, port);
        if (!topic || !topic->library.empty()) continue;
        const bool known =
            std::ranges::any_of(watched_, [&](const Watched& w) { return w.topic.name == topic->name; });
        if (!known) watched_.push_back({r, *topic, !sim::IsActuator(model_, port), 0, {}, {}, {}});
      }
    }
    for (size_t i = 0; i < watched_.size(); ++i) {
      if (!watched_[i].sensor) continue;
      const Topic& topic = watched_[i].topic;
      if (auto done =
              subscribe(topic.name, platform::TypeOf(topic.carries), topic.qos,
                        [this, i](std::string_view bytes, const dds::Received&) { Sensed(i, bytes); });
          !done.ok())
        return done;
    }
    return true;
  }

  void Hear(std::string_view bytes) {
    ros::diagnostic_msgs::DiagnosticArray message;
    if (!ros::Parse(bytes, message)) return;
    const std::lock_guard lock(mutex_);
    for (RobotStatus& status : StatusesOf(message)) statuses_[status.robot] = std::move(status);
  }

  void Answered(size_t robot, std::string_view bytes) {
    const int64_t now = platform::WallTime();
    const auto echo = Decoded(bytes);
    if (!echo || echo->answered == 0) return;
    const std::lock_guard lock(mutex_);
    echoes_[robot].push_back({Seconds(now - echo->asked), Seconds(echo->answered - (echo->asked + now) / 2)});
  }

  void Sensed(size_t i, std::string_view bytes) {
    std::optional<ros::builtin_interfaces::Time> stamp;
    if (watched_[i].topic.carries == Carries::kOdometry) {
      ros::nav_msgs::Odometry m;
      if (ros::Parse(bytes, m)) stamp = m.header.stamp;
    } else if (watched_[i].topic.carries == Carries::kScan) {
      ros::sensor_msgs::LaserScan m;
      if (ros::Parse(bytes, m)) stamp = m.header.stamp;
    }
    const std::lock_guard lock(mutex_);
    Watched& w = watched_[i];
    ++w.count;
    w.last = transport::BootTime();
    if (!w.first) w.first = w.last;
    if (stamp) w.behind = Seconds(platform::WallTime()) - stamp->sec - 1e-9 * stamp->nanosec;
  }

  // What robots say of themselves, and the way to them.
  void Robots() {
    for (size_t r = 0; r < fleet_.robots.size(); ++r) {
      const std::string& name = fleet_.robots[r].name;
      const auto known = statuses_.find(name);
      if (known == statuses_.end()) {
        Wrong(
            name, fmt::format("nobody says anything of it in domain {}", domain_),
            fmt::format(
                "on its machine: `rondo run PROGRAM --robot {}`, with the same ROS_DOMAIN_ID; is its network up, and, on a radio, "
                "its `address` in the fleet file right?",
                name));
        continue;
      }
      const RobotStatus& s = known->second;
      health_.robots.push_back(s);
      if (!agreement_.empty() && s.agreement != agreement_)
        Wrong(name, "it runs another program, specification or fleet than these files",
              "copy the same three files to all robots, and start it again");
      if (!s.sensors.empty())
        Wrong(name, s.sensors,
              "look at the driver: is it running, and is its topic the one of `[ports]` in the fleet file?");
      if (s.foreign > 0)
        Wrong(name, "it hears somebody who runs another program, specification or fleet",
              "copy the same three files to all robots");
      if (s.phase == "outside" && s.strange > 0)
        Wrong(name, "it hears robots of another session",
              "start all robots with the same `--session`, or all without");
      else if (s.phase == "outside" && s.unheard.empty())
        Wrong(name, "it has not begun, though it hears all others",
              "its disk, or that of others, may be of another run: another `--session` for all");
      if (s.phase == "halted")
        Wrong(name, "it lost the others and does not act any more",
              "start all robots again; `on_loss` in the fleet file says what happens then");
      else if (!s.unheard.empty())
        Wrong(
            name, fmt::format("it does not hear {}", fmt::join(s.unheard, ", ")),
            "are they running? If they are, nothing comes from there to here: look at the network, firewalls, domains");
      if (s.late > 0)
        health_.troubles.push_back({false, name, fmt::format("{} orders came too late to be sent", s.late),
                                    "a longer `lease` or a longer `delta` may help"});
      if (s.phase != "halted") Way(r);
    }
  }

  void Way(size_t r) {
    WayTo way{fleet_.robots[r].name, asked_, echoes_[r].size()};
    std::vector<double> trips, ahead;
    for (const auto& [trip, clock] : echoes_[r]) {
      trips.push_back(trip);
      ahead.push_back(clock);
    }
    if (trips.empty()) {
      Wrong(way.robot, "it is heard, and does not answer",
            "does it hear this machine? Look at firewalls, and at `peers` on a radio");
      return;
    }
    std::ranges::sort(trips);
    std::ranges::sort(ahead);
    way.median = trips[trips.size() / 2];
    way.most = trips.back();
    way.ahead = ahead[ahead.size() / 2];
    health_.ways.push_back(way);
    const double lost = 1 - static_cast<double>(way.answered) / static_cast<double>(way.asked);
    if (lost > 0.3)
      Wrong(way.robot, fmt::format("{:.0f} of 100 questions and answers are lost", 100 * lost),
            "a radio that loses so much makes rounds slow: move the access point, or use another channel");
    if (std::fabs(way.ahead) > 0.05)
      Wrong(
          way.robot,
          fmt::format("its clock is {:.3f} s {} of the one here", std::fabs(way.ahead),
                      way.ahead > 0 ? "ahead" : "behind"),
          "rounds do not need clocks that agree, but stamps of sensors and logs do: run chrony on all machines");
    if (way.median > fleet_.delta / 4)
      Wrong(way.robot,
            fmt::format("an answer takes {:.0f} ms, and a round is to take {:.0f} ms", 1e3 * way.median,
                        1e3 * fleet_.delta),
            "a longer `delta` in the fleet file");
  }

  static bool Heard(const dds::Endpoint& e, const Watched& w) { return e.topic == w.topic.name; }

  // One has to say what time it is, and not two.
  void Clocks(const std::vector<dds::Endpoint>& endpoints, const dds::Guid& self) {
    const auto clocks = std::ranges::count_if(endpoints, [&](const dds::Endpoint& e) {
      return e.writes && e.topic == "/clock" && e.participant != self;
    });
    if (clocks == 0)
      Wrong("", "nobody sends on /clock, and the fleet has `use_sim_time`", "is the simulator running?");
    if (clocks > 1)
      Wrong("", fmt::format("{} send on /clock", clocks), "time jumps between them: end all but one");
  }

  // Topics that nobody says anything on, or that are something else.
  void Topics(const std::vector<dds::Endpoint>& endpoints, const dds::Guid& self) {
    for (const Watched& w : watched_) {
      const std::string& name = fleet_.robots[w.robot].name;
      size_t others = 0;
      for (const dds::Endpoint& e : endpoints) {
        if (e.topic != w.topic.name || e.participant == self) continue;
        const std::string type(platform::TypeOf(w.topic.carries).name);
        if (e.type != type)
          Wrong(name,
                fmt::format("{} carries `{}`, and `{}` needs `{}`", w.topic.name, e.type, w.topic.port, type),
                "name another topic in `[ports]` of the fleet file");
        others += e.writes == w.sensor ? 1 : 0;
      }
      if (others == 0) {
        Wrong(name, fmt::format("nobody {} {}", w.sensor ? "sends on" : "listens to", w.topic.name),
              fmt::format("is the driver running? Or is `{}` on another topic: `[ports]` in the fleet file",
                          w.topic.port));
      } else if (w.sensor && w.count == 0 && w.topic.carries != Carries::kGoalStatus) {
        Silent(name, w, endpoints);
      } else if (!fleet_.ros.use_sim_time && w.behind &&
                 std::fabs(*w.behind) > std::max(0.1, w.topic.max_age)) {
        Wrong(name,
              fmt::format("stamps on {} are {:.1f} s {} the clock here", w.topic.name, std::fabs(*w.behind),
                          *w.behind > 0 ? "behind" : "ahead of"),
              "the clock of the driver is wrong, or it sends old data");
      }
    }
  }

  // Nodes with a life cycle say on a topic of their own when they change, and send nothing before they are active.
  void Silent(const std::string& name, const Watched& w, const std::vector<dds::Endpoint>& endpoints) {
    for (const dds::Endpoint& e : endpoints) {
      if (!e.writes || !Heard(e, w)) continue;
      const std::string node = NodeOf(nodes_, e);
      const bool lives = std::ranges::any_of(endpoints, [&](const dds::Endpoint& o) {
        return o.writes && o.topic == node + "/transition_event";
      });
      if (!lives) continue;
      return Wrong(
          name,
          fmt::format("nothing comes on {}: {} is a lifecycle node, and not active", w.topic.name, node),
          fmt::format("`ros2 lifecycle set {} activate`, or `configure` before it", node));
    }
    Wrong(name, fmt::format("nothing comes on {}, though somebody would send there", w.topic.name),
          "a sensor that stands still, or a network that lets nothing through");
  }

  // Readers that no writer can serve.
  void Qualities(const std::vector<dds::Endpoint>& endpoints, const dds::Guid& self) {
    std::set<std::string> said;
    for (const dds::Endpoint& w : endpoints) {
      const bool ours =
          std::ranges::any_of(watched_, [&](const Watched& watched) { return Heard(w, watched); });
      if (!w.writes || !ours || w.participant == self) continue;
      for (const dds::Endpoint& r : endpoints) {
        if (r.writes || r.topic != w.topic || r.type != w.type || r.participant == self) continue;
        std::string why;
        if (r.qos.reliable && !w.qos.reliable)
          why = "the reader wants every message, and the writer sends each once (reliability)";
        if (r.qos.transient_local && !w.qos.transient_local)
          why = "the reader wants earlier messages, and the writer keeps none (durability)";
        const std::string what =
            fmt::format("{}: {} does not hear {}: {}", w.topic, NodeOf(nodes_, r), NodeOf(nodes_, w), why);
        if (!why.empty() && said.insert(what).second)
          Wrong("", what, "give both the same quality of service");
      }
    }
  }

  static std::string NodeOf(const std::vector<dds::Participant::Node>& nodes, const dds::Endpoint& e) {
    for (const auto& node : nodes) {
      const auto& list = e.writes ? node.writers : node.readers;
      if (std::ranges::find(list, e.guid) != list.end())
        return (node.name.node_namespace == "/" ? "" : node.name.node_namespace) + "/" + node.name.name;
    }
    return "somebody";
  }

  const koord::Model& model_;
  const sim::Fleet& fleet_;
  const std::string& agreement_;
  std::vector<sim::Port> ports_;
  std::vector<dds::Participant::Node> nodes_;
  uint32_t domain_ = 0;
  size_t asked_ = 0;
  Health health_;
  std::mutex mutex_;
  std::map<std::string, RobotStatus> statuses_;
  std::vector<std::vector<std::pair<double, double>>>
      echoes_;  // by robot: there and back, and how far its clock is ahead
  std::vector<Watched> watched_;
  std::vector<std::unique_ptr<dds::Publisher>> questions_;
  std::vector<std::unique_ptr<dds::Subscription>>
      subscriptions_;  // last: nothing arrives any more when the others go
};

}  // namespace

bool Health::healthy() const { return std::ranges::none_of(troubles, &Trouble::wrong); }

base::Result<Health> Examine(const koord::Model& model, const sim::Fleet& fleet, const dds::Network& network,
                             const std::string& agreement, double seconds, const base::StopToken& stop,
                             diag::Diagnostics& diagnostics) {
  return Examination(model, fleet, agreement).Run(network, seconds, stop, diagnostics);
}

}  // namespace rondo::deploy
