#include "platform/orders.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "transport/mailbox.h"

namespace rondo::platform {

using koord::semantics::ToFloat;
using sim::Point;
using transport::Seconds;

namespace {

using std::chrono::milliseconds;

constexpr milliseconds kControl(20);  // the period of controllers

}  // namespace

Orders::Orders(const koord::Model& model, const sim::Fleet& fleet, const std::vector<sim::Port>& ports,
               size_t robot, Senses& senses, const Clock& clock)
    : model_(model), fleet_(fleet), robot_(robot), senses_(senses), clock_(clock) {
  for (const sim::Port& port : ports) {
    if (!sim::IsActuator(model, port)) continue;
    const Topic topic = *TopicOf(model, fleet, robot, port);
    const auto same = std::ranges::find_if(lines_, [&](const Line& l) {
      return topic.carries == Carries::kJointTrajectory && l.topic.carries == topic.carries &&
             l.topic.name == topic.name;
    });
    const auto sender = static_cast<size_t>(same - lines_.begin());
    Line& line = lines_.emplace_back();
    line.port = &port;
    line.topic = topic;
    line.sender = sender;
    if (Drives(topic.carries)) {
      line.body = fleet.robots[robot].make();
      line.body->Place(fleet.robots[robot].position, fleet.robots[robot].yaw);
    } else if (topic.carries == Carries::kPx4Setpoint) {
      line.offboard = std::make_unique<Offboard>(clock, *fleet.robots[robot].origin, topic.system);
    }
    ticks_ = ticks_ || line.ticks();
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
    if (auto begun = Begin(participant, node, line); !begun.ok()) return begun;
  }
  thread_ = std::thread([this] { Run(); });
  return true;
}

base::Result<bool> Orders::Begin(dds::Participant& participant, size_t node, Line& line) {
  const Topic& topic = line.topic;
  if (line.offboard != nullptr) return line.offboard->Begin(participant, node, topic.name);
  if (!topic.library.empty()) {
    auto actuator = MakeActuator(topic.library, {fleet_.robots[robot_].name, topic.port, topic.options});
    if (!actuator.ok()) return actuator.error();
    line.adapted = std::make_unique<AdaptedActuator>(std::move(actuator).value());
    return true;
  }
  if (&lines_[line.sender] != &line) return true;
  auto publisher = participant.Publish(node, topic.name, TypeOf(topic.carries), topic.qos);
  if (!publisher.ok()) return publisher.error();
  line.publisher = std::move(publisher).value();
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
    // A fallback lets nobody take off.
    if (always && line->offboard != nullptr && !line->told) return;
    if (role == sim::PortRole::kPath || role == sim::PortRole::kTarget) {
      if (!PathOf(variable, heap, at, line->path)) return;
      if (role == sim::PortRole::kTarget) line->numbers = line->path.front();
    } else if (line->topic.carries == Carries::kBool) {
      line->numbers[0] = *at != 0 ? 1 : 0;
    } else if (line->topic.carries == Carries::kPoint) {
      line->numbers = sim::ReadPoint(at);
    } else {
      line->numbers[0] = ToFloat(*at);
    }
    line->told = true;
    line->due = true;
    line->always = always;
  }
  changed_.notify_all();
}

void Orders::Stay(const Point& position) {
  std::unique_lock lock(mutex_);
  for (Line& line : lines_) {
    if (line.port->role != sim::PortRole::kPath && line.port->role != sim::PortRole::kTarget) continue;
    // A drone on the ground that was told nothing stays there.
    if (line.offboard != nullptr && !line.told) continue;
    line.path = {position};
    line.numbers = position;
    line.due = line.always = true;
  }
  changed_.notify_all();
  sent_.wait_for(lock, milliseconds(500), [&] { return std::ranges::none_of(lines_, &Line::due); });
}

std::string Orders::TakeProblem() {
  const std::lock_guard lock(mutex_);
  for (Line& line : lines_) {
    const std::string problem = line.adapted == nullptr ? "" : line.adapted->TakeProblem();
    if (!problem.empty()) return fmt::format("`{}`: {}: {}", line.topic.port, line.topic.name, problem);
    if (line.refused && !std::exchange(line.refusal_said, true))
      return fmt::format(
          "`{}`: the autopilot was asked ten times to listen and to arm, and does not: its checks before flight may fail, "
          "or its number not be {} (`system`)",
          line.topic.port, line.topic.system);
  }
  return {};
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
    changed_.wait_for(lock,
                      !ticks_              ? milliseconds(100)
                      : clock_.simulated() ? milliseconds(2)
                                           : kControl,
                      wanted);
    const bool last = ended_;
    const Time now = clock_.Now();
    constexpr double kPeriod = std::chrono::duration<double>(kControl).count();
    // By a clock that is simulated, a period may be over sooner than on the wall, or never.
    const bool ticks = ended_ || !clock_.simulated() || Seconds(now - ticked_) >= kPeriod;
    if (ticks) {
      period_ = clock_.simulated() ? std::min(Seconds(now - ticked_), 0.1) : kPeriod;
      ticked_ = now;
    }
    for (Line& line : lines_) {
      const bool due = std::exchange(line.due, false);
      const dds::Publisher* publisher = lines_[line.sender].publisher.get();
      const bool again = publisher != nullptr && !line.ticks() && line.unheard && publisher->matched() > 0;
      const bool in_time = line.always || now <= until_;
      if (due && !in_time) ++late_;
      // What is sent of one joint is sent of all.
      for (Line& other : lines_) other.due = other.due && (!due || !in_time || other.sender != line.sender);
      if ((due || again) && in_time) {
        line.said = line.path;
        line.said_numbers = line.numbers;
        line.unheard = publisher != nullptr && publisher->matched() == 0;
      } else if (!line.ticks() || !ticks) {
        continue;
      }
      const bool in_force = now <= until_;
      lock.unlock();
      if (line.ticks())
        Tick(line, {due && in_time, ticks, last, in_force});
      else
        Send(line);
      lock.lock();
    }
    sent_.notify_all();
    if (last) break;
  }
}

// What was told in time holds until something else is told, as for drivers that have the controller themselves.
void Orders::Tick(Line& line, const Moment& moment) {
  if (line.offboard != nullptr) {
    if (line.said.empty() || !moment.ticks) return;
    line.offboard->Fly(line.said.front(), senses_.autopilot(), moment.in_force);
    if (!line.offboard->refused()) return;
    const std::lock_guard lock(mutex_);
    line.refused = true;
    return;
  }
  if (moment.fresh) line.body->Follow(line.said);
  if (moment.ticks) Drive(line, moment.last);
}

void Orders::Drive(Line& line, bool last) {
  const auto place = senses_.place();
  const bool blind = !place || !senses_.Unusable().empty();
  sim::Twist twist;
  if (!last && !blind) {
    line.body->Put(place->position, place->yaw);
    line.body->Decide(period_);
    twist = line.body->Told().value_or(sim::Twist());
  }
  (void)line.publisher->Write(MessageOf(line.topic.carries, twist, HeaderOf("", clock_.Stamp()))).ok();
}

ros::std_msgs::Header Orders::Header() const { return HeaderOf(fleet_.ros.frame, clock_.Stamp()); }

// What cannot be sent is lost, like anything on the way.
void Orders::Send(const Line& line) {
  const Topic& topic = line.topic;
  const bool goes = topic.carries == Carries::kPose || topic.carries == Carries::kPath;
  if (line.adapted != nullptr) {
    const size_t parts = topic.carries == Carries::kPoint ? 3 : 1;
    line.adapted->Write({line.said_numbers.begin(), line.said_numbers.begin() + parts});
  } else if (topic.carries == Carries::kJointTrajectory) {
    // A driver that is told of some joints may let the others be where they are.
    std::vector<JointGoal> goals;
    {
      const std::lock_guard lock(mutex_);
      for (const Line& other : lines_) {
        if (other.sender == line.sender && other.told)
          goals.push_back({other.topic.joint, other.numbers[0], other.topic.within});
      }
    }
    // At once, whatever the clock of the driver says: a stamp of zero.
    (void)lines_[line.sender].publisher->Write(MessageOf(goals, HeaderOf(fleet_.ros.frame, 0))).ok();
  } else {
    const std::string bytes =
        goes ? MessageOf(topic.carries, line.said, Header()) : MessageOf(topic, line.said_numbers, Header());
    (void)line.publisher->Write(bytes).ok();
  }
}

}  // namespace rondo::platform
