#include "platform/senses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "platform/messages.h"
#include "ros/action_msgs.h"
#include "transport/mailbox.h"

namespace rondo::platform {

using koord::semantics::FromFloat;
using sim::Point;
using sim::Port;
using sim::PortRole;
using transport::Seconds;

namespace {

constexpr size_t kMostRays = 100'000;

bool IsSensor(const koord::Model& model, const Port& port) { return !sim::IsActuator(model, port); }

}  // namespace

std::vector<Topic> SensedTopics(const koord::Model& model, const sim::Fleet& fleet,
                                const std::vector<Port>& ports, size_t robot,
                                std::vector<std::optional<size_t>>& of_port) {
  std::vector<Topic> topics;
  of_port.assign(ports.size(), std::nullopt);
  for (size_t p = 0; p < ports.size(); ++p) {
    if (!IsSensor(model, ports[p])) continue;
    const auto topic = TopicOf(model, fleet, robot, ports[p]);
    if (!topic) continue;
    // Libraries are asked for each port by itself.
    const auto same = std::ranges::find_if(topics, [&](const Topic& t) {
      return t.name == topic->name && t.carries == topic->carries && t.joint == topic->joint &&
             topic->library.empty();
    });
    of_port[p] = static_cast<size_t>(same - topics.begin());
    if (same == topics.end())
      topics.push_back(*topic);
    else
      same->max_age = std::min(same->max_age, topic->max_age);
  }
  // Who asks whether it is where it was told to go has to know where it is; so has a scan.
  const bool needs_place = std::ranges::any_of(ports, [&](const Port& port) {
    return port.role == PortRole::kScans ||
           (port.role == PortRole::kReached && !TopicOf(model, fleet, robot, port));
  });
  const bool has_place = std::ranges::any_of(topics, [](const Topic& t) { return SaysPlace(t.carries); });
  if (needs_place && !has_place) topics.push_back(OdometryOf(fleet, robot));
  return topics;
}

Senses::Senses(const koord::Model& model, const sim::Fleet& fleet, const std::vector<Port>& ports,
               size_t robot, const sim::Body& body, Heap& heap, const Clock& clock)
    : model_(model),
      fleet_(fleet),
      ports_(ports),
      robot_(robot),
      heap_(heap),
      clock_(clock),
      tolerance_{body.Value("tolerance"), body.Value("waypoint_tolerance"), body.Value("dwell"),
                 body.flies()} {
  way_.Begin({fleet.robots[robot].position}, tolerance_);
  for (Topic& topic : SensedTopics(model, fleet, ports, robot, of_port_))
    heard_.emplace_back().topic = std::move(topic);
  for (size_t p = 0; p < ports.size(); ++p) {
    if (ports[p].role == PortRole::kPosition && of_port_[p] && !heard_[*of_port_[p]].topic.library.empty())
      adapted_place_ = of_port_[p];
  }
}

base::Result<dds::Subscription*> Senses::Listen(dds::Participant& participant, size_t node,
                                                const std::string& topic, const ros::Message& type,
                                                const ros::Qos& qos, dds::Receive receive) {
  auto subscription = participant.Subscribe(node, topic, type, qos, std::move(receive));
  if (!subscription.ok()) return subscription.error();
  subscriptions_.push_back(std::move(subscription).value());
  return subscriptions_.back().get();
}

base::Result<bool> Senses::Begin(dds::Participant& participant, size_t node) {
  for (size_t i = 0; i < heard_.size(); ++i) {
    const Topic& topic = heard_[i].topic;
    if (!topic.library.empty()) {
      auto sensor = MakeSensor(topic.library, {fleet_.robots[robot_].name, topic.port, topic.options});
      if (!sensor.ok()) return sensor.error();
      heard_[i].adapted = std::make_unique<AdaptedSensor>(std::move(sensor).value(),
                                                          topic.carries == Carries::kPoint ? 3 : 1, clock_);
      continue;
    }
    if (topic.carries == Carries::kTransform) continue;  // heard below
    const auto subscription =
        Listen(participant, node, topic.name, TypeOf(topic.carries), topic.qos,
               [this, i](std::string_view bytes, const dds::Received&) { Hear(i, bytes); });
    if (!subscription.ok()) return subscription.error();
    heard_[i].subscription = subscription.value();
  }
  const Topic odometry = OdometryOf(fleet_, robot_);
  pilots_ = odometry.carries == Carries::kPx4Odometry;
  if (pilots_) {
    if (auto begun = ListenToPilot(participant, node, odometry.name); !begun.ok()) return begun;
  }
  for (const bool fixed : {false, true}) {
    ros::Qos qos = ros::kTransforms;
    qos.transient_local = fixed;
    const auto subscription =
        Listen(participant, node, fixed ? "/tf_static" : "/tf", ros::tf2_msgs::TFMessage::kMessage, qos,
               [this](std::string_view bytes, const dds::Received&) {
                 ros::tf2_msgs::TFMessage message;
                 if (!ros::Parse(bytes, message)) return;
                 HearFrames(message);
               });
    if (!subscription.ok()) return subscription.error();
  }
  return true;
}

base::Result<bool> Senses::ListenToPilot(dds::Participant& participant, size_t node,
                                         const std::string& odometry) {
  const auto listens =
      Listen(participant, node, Beside(odometry, kControlMode), ros::px4_msgs::VehicleControlMode::kMessage,
             {.reliable = false, .depth = 1}, [this](std::string_view bytes, const dds::Received&) {
               ros::px4_msgs::VehicleControlMode m;
               if (ros::Parse(bytes, m))
                 HearPilot({m.flag_armed, m.flag_control_offboard_enabled, clock_.Now()});
             });
  if (!listens.ok()) return listens.error();
  return true;
}

void Senses::HearFrames(const ros::tf2_msgs::TFMessage& message) {
  const Time now = clock_.Now();
  const std::lock_guard lock(mutex_);
  frames_.Hear(message);
  for (Heard& heard : heard_) {
    if (heard.topic.carries != Carries::kTransform) continue;
    // Names of frames may have a `/` in front, as in older versions.
    const bool said = std::ranges::any_of(message.transforms, [&](const auto& t) {
      return t.child_frame_id == heard.topic.frame || "/" + t.child_frame_id == heard.topic.frame;
    });
    if (!said) continue;
    heard.at = now;
    heard.wrong.clear();
    ros::geometry_msgs::Pose here;
    here.orientation.w = 1;
    HearPlace(heard, PlaceOf(heard.topic.frame, here, frames_, fleet_.ros.frame, std::nullopt), now);
  }
}

void Senses::HearPilot(const Autopilot& pilot) {
  const std::lock_guard lock(mutex_);
  pilot_ = pilot;
  flew_ = flew_ || pilot.armed;
}

void Senses::Hear(size_t number, std::string_view bytes) {
  const Time now = clock_.Now();
  const auto with = [&](auto message, const auto& take) {
    const bool good = ros::Parse(bytes, message);
    const std::lock_guard lock(mutex_);
    Heard& heard = heard_[number];
    heard.at = now;
    heard.wrong = good ? "" : "what it says cannot be read";
    if (good) take(heard, message);
  };
  const Topic& topic = heard_[number].topic;
  const std::optional<sim::Origin>& origin = fleet_.robots[robot_].origin;
  switch (topic.carries) {
    case Carries::kOdometry:
      return with(ros::nav_msgs::Odometry(), [&](Heard& heard, const auto& m) {
        HearPlace(heard, PlaceOf(m, frames_, fleet_.ros.frame, origin), now);
      });
    case Carries::kPoseSeen:
      return with(ros::geometry_msgs::PoseStamped(), [&](Heard& heard, const auto& m) {
        HearPlace(heard, PlaceOf(m.header.frame_id, m.pose, frames_, fleet_.ros.frame, origin), now);
      });
    case Carries::kCovariance:
      return with(ros::geometry_msgs::PoseWithCovarianceStamped(), [&](Heard& heard, const auto& m) {
        HearPlace(heard, PlaceOf(m.header.frame_id, m.pose.pose, frames_, fleet_.ros.frame, origin), now);
      });
    case Carries::kPx4Odometry:
      return with(ros::px4_msgs::VehicleOdometry(), [&](Heard& heard, const auto& m) {
        HearPlace(heard, PlaceOf(m, origin.value_or(sim::Origin())), now);
      });
    case Carries::kScan:
      return with(ros::sensor_msgs::LaserScan(),
                  [&](Heard& heard, const auto& m) { HearScan(heard, m, now); });
    case Carries::kGoalStatus:
      return with(ros::action_msgs::GoalStatusArray(), [&](Heard&, const auto& m) { goals_.Hear(m); });
    default:
      break;
  }
  const auto numbers = NumbersIn(topic, bytes);
  // Others may say on the same topic where other joints are.
  if (!numbers && topic.carries == Carries::kJointState) return;
  const std::lock_guard lock(mutex_);
  Heard& heard = heard_[number];
  heard.at = now;
  heard.wrong = numbers ? "" : "what it says cannot be read";
  if (numbers && Finite(*numbers))
    heard.numbers = *numbers;
  else if (numbers)
    heard.wrong = "it says a number that is not finite";
}

void Senses::HearPlace(Heard& heard, const std::variant<Place, std::string>& place, Time now) {
  if (const auto* why = std::get_if<std::string>(&place)) {
    heard.wrong = *why;
    return;
  }
  const Place& there = std::get<Place>(place);
  if (place_) {
    way_.Next(there.position);
    way_.Pass(there.position, Seconds(now - place_at_));
  }
  place_ = there;
  place_at_ = now;
}

// What a beam says (REP-117): something at a distance, something nearer than it can tell, nothing in range, nothing at all.
double Senses::DistanceOf(float range, const ros::sensor_msgs::LaserScan& m) {
  if (std::isnan(range)) return -1;
  if (range > m.range_max) return INFINITY;
  return std::isfinite(range) ? std::max(0.0, static_cast<double>(range)) : static_cast<double>(m.range_min);
}

void Senses::HearScan(Heard& heard, const ros::sensor_msgs::LaserScan& m, Time now) {
  const auto odometry =
      std::ranges::find_if(heard_, [](const Heard& h) { return SaysPlace(h.topic.carries); });
  if (!place_ || Seconds(now - place_at_) > odometry->topic.max_age) {
    heard.wrong = "it cannot be placed: nobody has said lately where the robot is";
    return;
  }
  if (m.ranges.empty()) return;
  if (m.ranges.size() > kMostRays ||
      !std::isfinite(m.angle_min + m.angle_increment + m.range_max + m.range_min) || m.angle_increment == 0) {
    heard.wrong = "it says a number that is not finite, no angles, or too many";
    return;
  }
  Seen seen{now, place_->position, {}};
  for (const float range : m.ranges) seen.rays.distances.push_back(DistanceOf(range, m));
  seen.rays.first = place_->yaw + m.angle_min;
  seen.rays.step = m.angle_increment;
  seen.rays.range = m.range_max;
  if (m.angle_increment < 0) {  // clockwise
    std::ranges::reverse(seen.rays.distances);
    seen.rays.first += seen.rays.step * static_cast<double>(m.ranges.size() - 1);
    seen.rays.step = -seen.rays.step;
  }
  const auto round = static_cast<Time>(fleet_.delta * 1e9);
  std::erase_if(seen_, [&](const Seen& s) { return s.at <= now - round; });
  seen_.push_back(std::move(seen));
}

std::string Senses::Wrong(const Heard& heard, Time now) const {
  const Topic& topic = heard.topic;
  // What became of goals is said when something becomes of them.
  if (topic.carries == Carries::kGoalStatus)
    return heard.subscription->matched() > 0 ? "" : fmt::format("nobody sends on {}", topic.name);
  AdaptedSensor::Said said{heard.at, heard.numbers, heard.wrong};
  if (heard.adapted != nullptr) said = heard.adapted->said();
  if (!said.wrong.empty() && (said.at || heard.adapted != nullptr))
    return fmt::format("{}: {}", topic.name, said.wrong);
  if (!said.at) return fmt::format("nothing has come on {} yet", topic.name);
  if (Seconds(now - *said.at) > topic.max_age)
    return fmt::format("nothing has come on {} for {:.1f} s", topic.name, Seconds(now - *said.at));
  return {};
}

std::string Senses::Unusable() {
  if (!clock_.begun()) return "nothing has come on /clock yet";
  const Time now = clock_.Now();
  const std::lock_guard lock(mutex_);
  for (const Heard& heard : heard_) {
    const std::string why = Wrong(heard, now);
    if (!why.empty()) return fmt::format("`{}`: {}", heard.topic.port, why);
  }
  return WrongPilot(now);
}

// Whether it is ours to fly. Before the first order it stands, and nobody has to say anything.
std::string Senses::WrongPilot(Time now) const {
  constexpr double kSilent = 2;  // seconds
  if (!pilots_) return {};
  if (!pilot_) return "nobody says who steers: is the autopilot there?";
  if (Seconds(now - pilot_->at) > kSilent) return "the autopilot does not say any more who steers";
  if (pilot_->taken()) return "a pilot flies it, or the autopilot does by itself";
  if (flew_ && !pilot_->armed) return "it has landed, or was switched off: start it again by hand";
  return {};
}

// Where a library says that it is.
void Senses::FindPlace() {
  if (!adapted_place_) return;
  Heard& heard = heard_[*adapted_place_];
  const AdaptedSensor::Said said = heard.adapted->said();
  if (!said.at || (place_ && *said.at <= place_at_)) return;
  HearPlace(heard, Place{said.numbers, {}, 0}, *said.at);
}

// A status may be of the goal before, whose end was told late: then the robot is somewhere else.
bool Senses::NearGoal() const {
  constexpr double kNear = 0.5;  // metres
  if (!place_) return true;
  Point away = place_->position;
  for (size_t i = 0; i < 3; ++i) away[i] -= way_.path().back()[i];
  if (!tolerance_.flies) away[2] = 0;
  return std::hypot(away[0], away[1], away[2]) <= std::max(kNear, tolerance_.last);
}

bool Senses::Usable(size_t, uint64_t) { return Unusable().empty(); }

void Senses::Read(size_t robot, uint64_t, koord::node::Cell cell, std::span<Word> words) {
  if (robot != robot_) return;
  const auto port = std::ranges::find(ports_, cell.variable, &Port::variable);
  if (port == ports_.end()) return;
  const std::lock_guard lock(mutex_);
  FindPlace();
  // What came before the first round is no stay at the end of a way.
  if (!std::exchange(began_, true)) way_.Begin({place_ ? place_->position : fleet_.robots[robot_].position});
  const auto heard = of_port_[static_cast<size_t>(port - ports_.begin())];
  if (port->role == PortRole::kReached && !heard) {
    words[0] = static_cast<Word>(way_.reached());
    return;
  }
  if (!heard) return;
  Heard& from = heard_[*heard];
  if (from.topic.carries == Carries::kGoalStatus) {
    words[0] = static_cast<Word>(goals_.reached() ? *goals_.reached() && NearGoal() : way_.reached());
    return;
  }
  if (from.adapted != nullptr) {
    const AdaptedSensor::Said said = from.adapted->said();
    from.at = said.at;
    from.numbers = said.numbers;
  }
  if (!from.at) return;
  const Numbers& numbers = from.numbers;
  switch (from.topic.carries) {
    case Carries::kOdometry:
    case Carries::kPx4Odometry:
    case Carries::kPoseSeen:
    case Carries::kCovariance:
    case Carries::kTransform:
      if (!place_) return;
      if (port->role == PortRole::kPosition) sim::WritePoint(place_->position, words.data());
      if (port->role == PortRole::kVelocity) sim::WritePoint(place_->velocity, words.data());
      if (port->role == PortRole::kHeading) words[0] = FromFloat(place_->yaw + 0.0);
      return;
    case Carries::kScan:
      words_.clear();
      for (const Seen& seen : seen_) {
        for (const double x : seen.from) words_.push_back(FromFloat(x + 0.0));
        words_.push_back(sim::EncodeRays(heap_, seen.rays));
      }
      words[0] = heap_.Intern(words_);
      seen_.clear();
      return;
    case Carries::kBool:
      words[0] = static_cast<Word>(numbers[0] != 0);
      return;
    case Carries::kNumber:
    case Carries::kJointState:
      words[0] = FromFloat(numbers[0] + 0.0);
      return;
    case Carries::kPoint:
      return sim::WritePoint(numbers, words.data());
    default:
      return;
  }
}

void Senses::GoesAlong(const std::vector<Point>& path) {
  const std::lock_guard lock(mutex_);
  goals_.Begin(clock_.Stamp());
  if (path.empty()) return way_.Begin({place_ ? place_->position : fleet_.robots[robot_].position});
  way_.Copy(path);
}

std::optional<Place> Senses::place() {
  const std::lock_guard lock(mutex_);
  FindPlace();
  return place_;
}

std::optional<Autopilot> Senses::autopilot() {
  const Time now = clock_.Now();
  const std::lock_guard lock(mutex_);
  if (pilot_ && Seconds(now - pilot_->at) > 1) return std::nullopt;
  return pilot_;
}

}  // namespace rondo::platform
