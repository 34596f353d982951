#include "deploy/choreography/judge_sessions.h"

#include <fmt/format.h>

#include <algorithm>

#include "choreo/node/senses.h"
#include "expr/substitute.h"
#include "robot/values/value.h"
#include "sim/motions/places.h"

namespace rondo::deploy {

using choreo::Action;
using choreo::RobotId;

namespace {

class Judge {
 public:
  Judge(const std::vector<SessionLog>& logs, const choreo::Cast& cast)
      : graph_(*cast.graph),
        arena_(cast.declarations->evaluator().arena()),
        places_(cast),
        lines_(graph_.robots.size()) {
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
        report_.late = std::max(report_.late, e->late);
        if (e->missed > report_.worst.missed) report_.worst = missed();
        if (e->missed > lines_[robot].log->tolerance) report_.broken.push_back(missed());
        break;
      case Did::kLeaves:
        Leaves(robot, *e);
        break;
      default:
        break;
    }
    return true;
  }

  void Leaves(size_t robot, const SessionEvent& e) {
    const RobotId id(robot);
    if (lines_[robot].next < lines_[robot].log->events.size())
      report_.findings.push_back(fmt::format("`{}` does something after it left", e.robot));
    if (e.outcome != "over")
      report_.ends.push_back({e.robot, e.outcome, e.what});
    else if (!places_.MayEnd(id))
      report_.findings.push_back(fmt::format("`{}` says that it is at its end, and is not", e.robot));
  }

  // A message that is taken: the sender's next event is that it was.
  bool Together(size_t robot) {
    const SessionEvent* e = At(robot);
    const auto peer = e == nullptr ? std::nullopt : graph_.Find(e->peer);
    if (!peer) return false;
    if (e->did == Did::kSent) return Silent(peer->index()) && Message(robot, peer->index(), *e, robot);
    const SessionEvent* sent = At(peer->index());
    // Who goes before it has heard that its message was taken has sent it nevertheless.
    const bool open = Silent(peer->index()) || LeavesWithOne(peer->index());
    if (open) return Message(peer->index(), robot, *e, robot);
    if (sent == nullptr || sent->did != Did::kSent || sent->peer != e->robot || sent->what != e->what)
      return false;
    if (sent->values != e->values)
      report_.findings.push_back(
          fmt::format("`{}` took other values of `{}` than `{}` sent", e->robot, e->what, e->peer));
    ++lines_[peer->index()].next;
    return Message(peer->index(), robot, *e, robot);
  }

  bool LeavesWithOne(size_t robot) {
    const Line& line = lines_[robot];
    const bool left = At(robot) == nullptr && line.log != nullptr && !line.log->events.empty() &&
                      line.log->events.back().did == Did::kLeaves &&
                      line.log->events.back().outcome != "over";
    return left && left_.insert(robot).second;
  }

  // Goes on in the log of `teller`, which tells of it.
  bool Message(size_t from, size_t to, const SessionEvent& e, size_t teller) {
    ++lines_[teller].next;
    ++report_.messages;
    const RobotId sender(from), taker(to);
    const auto sent = places_.Says(sender, Action::Kind::kSend, taker, e.what);
    const auto taken = places_.Says(taker, Action::Kind::kReceive, sender, e.what);
    const std::string message =
        fmt::format("`{}` from `{}` to `{}`", e.what, graph_.NameOf(sender), graph_.NameOf(taker));
    if ((!Unknown(from) && sent.empty()) || (!Unknown(to) && taken.empty()))
      report_.findings.push_back(message + " is not what the choreography says comes next");
    const auto& nodes = sent.empty() ? taken : sent;
    if (!nodes.empty() &&
        std::ranges::none_of(nodes, [&](choreo::NodeId n) { return Carries(graph_[n], e.values); }))
      report_.findings.push_back(message + " does not carry what the choreography says");
    return true;
  }

  // Whether a message may have these values, as far as that does not depend on states.
  bool Carries(const choreo::Node& node, const std::vector<double>& values) const {
    expr::Numeric::Point point;
    std::vector<expr::TermId> told;
    expr::Substitution bools;
    size_t at = 0;
    for (const robot::Value& value : node.payload) {
      for (const expr::TermId t : value.terms) {
        if (at == values.size()) return false;
        const double v = values[at++];
        if (arena_.op(t) != expr::Op::kVariable) continue;
        told.push_back(t);
        if (arena_.sort_of(t) == arena_.Bool())
          bools.emplace(t, arena_.Constant(v != 0));
        else
          point.emplace(t, v);
      }
    }
    if (at != values.size()) return false;
    for (const expr::TermId t : robot::VariablesOf(arena_, {node.refinement})) {
      if (std::ranges::find(told, t) == told.end()) return true;
    }
    const expr::TermId wanted = expr::Substitute(arena_, node.refinement, bools);
    const double violation = expr::Numeric(arena_, point).Violation(wanted);
    return violation <= choreo::kRounding && !expr::Numeric::OnEdge(violation);
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
  expr::Arena& arena_;
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
    if (log.agreement != logs[0].agreement)
      return base::Error{fmt::format("`{}` and `{}` are of different choreographies, or versions of one",
                                     logs[0].path, log.path)};
    if (!cast.graph->Find(log.robot))
      return base::Error{fmt::format("`{}`: the choreography has no robot `{}`", log.path, log.robot)};
    if (!robots.insert(log.robot).second)
      return base::Error{
          fmt::format("there are two logs of `{}`: a robot that starts again does not go on", log.robot)};
  }
  return Judge(logs, cast).Run();
}

}  // namespace rondo::deploy
