#include "deploy/choreography/judge_sessions.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/motions/places.h"

namespace rondo::deploy {

using choreo::Action;
using choreo::RobotId;

namespace {

class Judge {
 public:
  Judge(const std::vector<SessionLog>& logs, const choreo::Cast& cast)
      : graph_(*cast.graph), places_(cast), lines_(graph_.robots.size()) {
    for (const SessionLog& log : logs) {
      if (const auto robot = graph_.Find(log.robot)) lines_[robot->index()].log = &log;
    }
  }

  SessionsReport Run() {
    for (size_t r = 0; r < lines_.size(); ++r) {
      if (lines_[r].log == nullptr)
        report_.gaps.push_back(fmt::format("there is no log of `{}`", graph_.robots[r].text));
      else if (!lines_[r].log->complete)
        report_.gaps.push_back(fmt::format("the log of `{}` ends early", graph_.robots[r].text));
    }
    for (bool went = true; went;) {
      went = false;
      for (size_t r = 0; r < lines_.size(); ++r) {
        while (Alone(r)) went = true;
        went = Together(r) || went;
      }
    }
    for (size_t r = 0; r < lines_.size(); ++r) Left(r);
    return std::move(report_);
  }

 private:
  struct Line {
    const SessionLog* log = nullptr;
    size_t next = 0;
  };
  const SessionEvent* At(size_t robot) const {
    const Line& line = lines_[robot];
    return line.log == nullptr || line.next >= line.log->events.size() ? nullptr
                                                                       : &line.log->events[line.next];
  }

  // Nobody knows what it did at the end, or at all.
  bool Unknown(size_t robot) const { return lines_[robot].log == nullptr || !lines_[robot].log->complete; }
  // Nor what it did from here on.
  bool Silent(size_t robot) const { return At(robot) == nullptr && Unknown(robot); }

  // What a robot does by itself.
  bool Alone(size_t robot) {
    const SessionEvent* e = At(robot);
    if (e == nullptr || e->did == Did::kSent || e->did == Did::kTook) return false;
    ++lines_[robot].next;
    const auto missed = [&] { return SessionsReport::Miss{graph_.robots[robot].text, e->what, e->missed}; };
    switch (e->did) {
      case Did::kBegins:
        ++report_.motions;
        places_.Moves(RobotId(robot));
        break;
      case Did::kEnds:
        if (e->missed > report_.worst.missed) report_.worst = missed();
        break;
      case Did::kBreaks:
        report_.broken.push_back(missed());
        break;
      default:
        break;
    }
    return true;
  }

  // A message that is taken: the sender's next event is that it was.
  bool Together(size_t robot) {
    const SessionEvent* e = At(robot);
    const auto peer = e == nullptr ? std::nullopt : graph_.Find(e->peer);
    if (!peer) return false;
    if (e->did == Did::kSent) return Silent(peer->index()) && Message(robot, peer->index(), e->what, robot);
    const SessionEvent* sent = At(peer->index());
    // Who goes before it has heard that its message was taken has sent it nevertheless.
    const bool open = Silent(peer->index()) || LeavesWithOne(peer->index());
    if (open) return Message(peer->index(), robot, e->what, robot);
    if (sent == nullptr || sent->did != Did::kSent || sent->peer != e->robot || sent->what != e->what)
      return false;
    if (sent->values != e->values)
      report_.findings.push_back(
          fmt::format("`{}` took other values of `{}` than `{}` sent", e->robot, e->what, e->peer));
    ++lines_[peer->index()].next;
    return Message(peer->index(), robot, e->what, robot);
  }

  bool LeavesWithOne(size_t robot) {
    const Line& line = lines_[robot];
    const bool left = At(robot) == nullptr && line.log != nullptr && !line.log->events.empty() &&
                      line.log->events.back().did == Did::kLeaves;
    return left && left_.insert(robot).second;
  }

  // Goes on in the log of `teller`, which tells of it.
  bool Message(size_t from, size_t to, const std::string& what, size_t teller) {
    ++lines_[teller].next;
    ++report_.messages;
    const RobotId sender(from), taker(to);
    const bool sends = Unknown(from) || !places_.Says(sender, Action::Kind::kSend, taker, what).empty();
    const bool takes = Unknown(to) || !places_.Says(taker, Action::Kind::kReceive, sender, what).empty();
    if (!sends || !takes)
      report_.findings.push_back(
          fmt::format("`{}` from `{}` to `{}` is not what the choreography says comes next", what,
                      graph_.NameOf(sender), graph_.NameOf(taker)));
    return true;
  }

  // What has no counterpart.
  void Left(size_t robot) {
    const SessionEvent* e = At(robot);
    if (e == nullptr) return;
    const auto peer = graph_.Find(e->peer);
    const Line* other = peer ? &lines_[peer->index()] : nullptr;
    // The log of the other one would have said.
    if (other != nullptr && (other->log == nullptr || !other->log->complete)) return;
    report_.findings.push_back(
        e->did == Did::kSent
            ? fmt::format("`{}` says that `{}` took `{}`, which does not say so", e->robot, e->peer, e->what)
            : fmt::format("`{}` took `{}`, which `{}` did not send then", e->robot, e->what, e->peer));
  }

  const choreo::Graph& graph_;
  sim::motions::Places places_;
  std::vector<Line> lines_;  // by robot
  std::set<size_t> left_;    // who left with a message under way
  SessionsReport report_;
};

}  // namespace

base::Result<SessionsReport> JudgeSessions(const std::vector<SessionLog>& logs, const choreo::Cast& cast) {
  std::set<std::string> robots;
  for (const SessionLog& log : logs) {
    if (log.session != logs[0].session)
      return base::Error{fmt::format("`{}` and `{}` are of different runs", logs[0].path, log.path)};
    if (!cast.graph->Find(log.robot))
      return base::Error{fmt::format("`{}`: the choreography has no robot `{}`", log.path, log.robot)};
    if (!robots.insert(log.robot).second)
      return base::Error{
          fmt::format("there are two logs of `{}`: a robot that starts again does not go on", log.robot)};
  }
  return Judge(logs, cast).Run();
}

}  // namespace rondo::deploy
