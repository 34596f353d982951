#include "platform/orders.h"

#include <algorithm>
#include <chrono>

#include "ros/ackermann_msgs.h"
#include "ros/nav_msgs.h"
#include "transport/mailbox.h"

namespace rondo::platform {

using koord::semantics::ToFloat;
using sim::Point;

namespace {

using std::chrono::milliseconds;

// `goal` and `path` are kept by drivers for as long as they like.
constexpr ros::Qos kOrders{.depth = 1};
constexpr milliseconds kControl(20);  // the period of controllers

ros::geometry_msgs::Pose PoseAt(const Point& p) {
  ros::geometry_msgs::Pose pose;
  pose.position.x = p[0];
  pose.position.y = p[1];
  pose.position.z = p[2];
  pose.orientation.w = 1;
  return pose;
}

}  // namespace

Orders::Orders(const koord::Model& model, const sim::Fleet& fleet, const std::vector<sim::Port>& ports,
               size_t robot, Senses& senses)
    : model_(model), fleet_(fleet), senses_(senses) {
  for (const sim::Port& port : ports) {
    if (!sim::IsActuator(model, port)) continue;
    Line& line = lines_.emplace_back();
    line.port = &port;
    line.topic = *TopicOf(model, fleet, robot, port);
    if (!Drives(line.topic.carries)) continue;
    drives_ = true;
    line.body = fleet.robots[robot].make();
    line.body->Place(fleet.robots[robot].position, fleet.robots[robot].yaw);
  }
}

Orders::~Orders() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

base::Result<bool> Orders::Begin(dds::Participant& participant, size_t node) {
  for (Line& line : lines_) {
    auto publisher = participant.Publish(node, line.topic.name, TypeOf(line.topic.carries), kOrders);
    if (!publisher.ok()) return publisher.error();
    line.publisher = std::move(publisher).value();
  }
  thread_ = std::thread([this] { Run(); });
  return true;
}

void Orders::Extend(Time until) {
  const std::lock_guard lock(mutex_);
  until_ = until;
}

bool Orders::PathOf(size_t variable, const Heap& heap, const Word* at, std::vector<Point>& path) const {
  const auto line = std::ranges::find_if(lines_, [&](const Line& l) { return l.port->variable == variable; });
  if (line == lines_.end()) return false;
  if (line->port->role == sim::PortRole::kPath) {
    sim::DecodePath(heap, *at, path);
  } else if (line->port->role == sim::PortRole::kTarget) {
    path.assign(1, sim::ReadPoint(at));
  } else {
    return false;
  }
  return true;
}

void Orders::Give(size_t variable, const Heap& heap, const Word* at, bool always) {
  const auto line = std::ranges::find_if(lines_, [&](const Line& l) { return l.port->variable == variable; });
  if (line == lines_.end()) return;
  {
    const std::lock_guard lock(mutex_);
    const sim::PortRole role = line->port->role;
    if (role == sim::PortRole::kPath || role == sim::PortRole::kTarget) {
      if (!PathOf(variable, heap, at, line->path)) return;
    } else if (line->topic.carries == Carries::kBool) {
      line->numbers[0] = *at != 0 ? 1 : 0;
    } else if (line->topic.carries == Carries::kPoint) {
      line->numbers = sim::ReadPoint(at);
    } else {
      line->numbers[0] = ToFloat(*at);
    }
    line->due = true;
    line->always = always;
  }
  changed_.notify_all();
}

void Orders::Stay(const Point& position) {
  std::unique_lock lock(mutex_);
  for (Line& line : lines_) {
    if (line.port->role != sim::PortRole::kPath && line.port->role != sim::PortRole::kTarget) continue;
    line.path = {position};
    line.due = line.always = true;
  }
  changed_.notify_all();
  sent_.wait_for(lock, milliseconds(500), [&] { return std::ranges::none_of(lines_, &Line::due); });
}

uint64_t Orders::late() const {
  const std::lock_guard lock(mutex_);
  return late_;
}

// Nobody waits for a message to be sent: lines are taken out of the lock before.
void Orders::Run() {
  std::unique_lock lock(mutex_);
  const auto wanted = [this] { return ended_ || std::ranges::any_of(lines_, &Line::due); };
  while (true) {
    changed_.wait_for(lock, drives_ ? kControl : milliseconds(100), wanted);
    const bool last = ended_;
    for (Line& line : lines_) {
      const bool due = std::exchange(line.due, false);
      const bool again = line.body == nullptr && line.unheard && line.publisher->matched() > 0;
      const bool in_time = line.always || transport::BootTime() <= until_;
      if (due && !in_time) ++late_;
      if ((due || again) && in_time) {
        line.said = line.path;
        line.said_numbers = line.numbers;
        line.unheard = line.publisher->matched() == 0;
      } else if (line.body == nullptr) {
        continue;
      }
      lock.unlock();
      if (line.body != nullptr)
        Drive(line, due && in_time, last);
      else
        Send(line);
      lock.lock();
    }
    sent_.notify_all();
    if (last) return;
  }
}

// What was told in time holds until something else is told, as for drivers that have the controller themselves.
void Orders::Drive(Line& line, bool fresh, bool last) {
  if (fresh) line.body->Follow(line.said);
  const auto place = senses_.place();
  const bool blind = !place || !senses_.Unusable(transport::BootTime()).empty();
  if (last || blind) return Publish(line, {});
  line.body->Put(place->position, place->yaw);
  line.body->Decide(std::chrono::duration<double>(kControl).count());
  Publish(line, line.body->Told().value_or(sim::Twist()));
}

void Orders::Publish(const Line& line, const sim::Twist& twist) const {
  if (line.topic.carries == Carries::kAckermann) {
    ros::ackermann_msgs::AckermannDriveStamped m;
    m.header = HeaderOf("");
    m.drive.speed = static_cast<float>(twist.forward);
    m.drive.steering_angle = static_cast<float>(twist.steer);
    (void)line.publisher->Publish(m).ok();
    return;
  }
  ros::geometry_msgs::TwistStamped m;
  m.twist.linear.x = twist.forward;
  m.twist.linear.y = twist.left;
  m.twist.angular.z = twist.turn;
  if (line.topic.carries == Carries::kTwist) {
    (void)line.publisher->Publish(m.twist).ok();
    return;
  }
  m.header = HeaderOf("");
  (void)line.publisher->Publish(m).ok();
}

// What cannot be sent is lost, like anything on the way.
void Orders::Send(const Line& line) const {
  switch (line.topic.carries) {
    case Carries::kPose: {
      ros::geometry_msgs::PoseStamped m;
      m.header = HeaderOf(fleet_.ros.frame);
      m.pose = PoseAt(line.said.front());
      (void)line.publisher->Publish(m).ok();
      return;
    }
    case Carries::kPath: {
      ros::nav_msgs::Path m;
      m.header = HeaderOf(fleet_.ros.frame);
      for (const Point& p : line.said) {
        auto& pose = m.poses.emplace_back();
        pose.header = m.header;
        pose.pose = PoseAt(p);
      }
      (void)line.publisher->Publish(m).ok();
      return;
    }
    case Carries::kBool: {
      ros::std_msgs::Bool m;
      m.data = line.said_numbers[0] != 0;
      (void)line.publisher->Publish(m).ok();
      return;
    }
    case Carries::kNumber: {
      ros::std_msgs::Float64 m;
      m.data = line.said_numbers[0];
      (void)line.publisher->Publish(m).ok();
      return;
    }
    case Carries::kPoint: {
      (void)line.publisher->Publish(PoseAt(line.said_numbers).position).ok();
      return;
    }
    case Carries::kOdometry:
    case Carries::kScan:
    case Carries::kTwist:
    case Carries::kTwistStamped:
    case Carries::kAckermann:
      return;
  }
}

}  // namespace rondo::platform
