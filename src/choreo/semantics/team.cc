#include "choreo/semantics/team.h"

#include <fmt/format.h>

#include <algorithm>

namespace rondo::choreo {
namespace {

using Kind = MachineEdge::Kind;

std::vector<Duration> DurationsOf(const std::vector<Machine>& machines) {
  std::vector<Duration> durations;
  for (const Machine& m : machines) {
    for (const MachineState& s : m.states) {
      for (const MachineEdge& e : s.edges) {
        if (e.kind == Kind::kMove) durations.push_back(e.duration);
      }
    }
  }
  return durations;
}

}  // namespace

Team::Team(std::vector<Machine> machines) : machines_(std::move(machines)), ticks_(DurationsOf(machines_)) {}

const MachineEdge& Team::MotionOf(const Local& l, size_t robot) const {
  return machines_[robot].states[l.from].edges[l.edge];
}

// Between motions, or in one that may be interrupted by now.
bool Team::MayAct(const Local& l, size_t robot) const {
  if (!l.moving) return true;
  const Duration& d = MotionOf(l, robot).duration;
  return d.interruptible && l.clock >= ticks_.Least(d);
}

const MachineEdge* Team::FindMove(const MachineState& state) {
  const auto it = std::ranges::find(state.edges, Kind::kMove, &MachineEdge::kind);
  return it == state.edges.end() ? nullptr : &*it;
}

Team::Local Team::Begin(const Local& l, const MachineState& state, const MachineEdge& edge) {
  return {edge.to, true, l.at, static_cast<size_t>(&edge - state.edges.data()), 0};
}

bool Team::Ended(const State& state) const {
  for (size_t r = 0; r < state.size(); ++r) {
    if (!At(state[r], r).ends || !MayAct(state[r], r)) return false;
  }
  return true;
}

std::vector<Team::Step> Team::Next(const State& state) const {
  std::vector<Step> steps;
  Alone(state, steps);
  BeginTogether(state, steps);
  Messages(state, steps);
  Wait(state, steps);
  return steps;
}

// What a robot does by itself: the end of a motion that cannot be interrupted, a choice, the next motion.
void Team::Alone(const State& state, std::vector<Step>& steps) const {
  for (size_t r = 0; r < state.size(); ++r) {
    const Local& l = state[r];
    const MachineState& at = At(l, r);
    const auto step = [&](const Local& next) {
      Step s{"", state};
      s.state[r] = next;
      steps.push_back(std::move(s));
    };
    if (l.moving && !MotionOf(l, r).duration.interruptible &&
        l.clock >= ticks_.Least(MotionOf(l, r).duration))
      step({l.at, false, 0, 0, 0});
    if (!MayAct(l, r)) continue;
    for (const MachineEdge& e : at.edges) {
      if (e.kind != Kind::kChoose) continue;
      Local next = l;
      next.at = e.to;
      step(next);
    }
    // Where it listens, too, it moves only when time passes for all.
    const MachineEdge* move = FindMove(at);
    if (move != nullptr && at.edges.size() == 1) step(Begin(l, at, *move));
  }
}

// Those that listen begin to move when all others move or begin to.
void Team::BeginTogether(const State& state, std::vector<Step>& steps) const {
  Step step{"", state};
  bool changed = false;
  for (size_t r = 0; r < state.size(); ++r) {
    const Local& l = state[r];
    if (l.moving || At(l, r).ends) continue;
    const MachineEdge* move = FindMove(At(l, r));
    if (move == nullptr) return;
    step.state[r] = Begin(l, At(l, r), *move);
    changed = true;
  }
  if (changed) steps.push_back(std::move(step));
}

// Where a message leads who waits for it, perhaps in motions that may be interrupted from their beginning.
std::optional<size_t> Team::Hear(size_t robot, size_t at, size_t sender, const std::string& label) const {
  const std::vector<MachineState>& states = machines_[robot].states;
  for (size_t motions = 0; motions <= states.size(); ++motions) {
    for (const MachineEdge& e : states[at].edges) {
      if (e.kind == Kind::kReceive && e.peer.index() == sender && e.label == label) return e.to;
    }
    const MachineEdge* move = FindMove(states[at]);
    if (move == nullptr || !move->duration.interruptible || !move->duration.least.IsZero()) break;
    at = move->to;
  }
  return std::nullopt;
}

void Team::Messages(const State& state, std::vector<Step>& steps) const {
  for (size_t r = 0; r < state.size(); ++r) {
    if (!MayAct(state[r], r)) continue;
    for (const MachineEdge& send : At(state[r], r).edges) {
      const size_t peer = send.peer.index();
      if (send.kind != Kind::kSend || !MayAct(state[peer], peer)) continue;
      const std::optional<size_t> heard = Hear(peer, state[peer].at, r, send.label);
      if (!heard) continue;
      Step step{fmt::format("{}>{}:{}", r, peer, send.label), state};
      step.state[r] = {send.to, false, 0, 0, 0};
      step.state[peer] = {*heard, false, 0, 0, 0};
      steps.push_back(std::move(step));
    }
  }
}

// A tick, if everybody moves and nobody has to stop; who has come to an end does not count.
void Team::Wait(const State& state, std::vector<Step>& steps) const {
  Step step{"", state};
  bool moving = false;
  for (size_t r = 0; r < state.size(); ++r) {
    Local& l = step.state[r];
    if (!l.moving && At(l, r).ends) continue;
    if (!l.moving || l.clock >= ticks_.Most(MotionOf(l, r).duration)) return;
    l.clock = std::min(l.clock + 1, ticks_.enough());
    moving = true;
  }
  if (moving) steps.push_back(std::move(step));
}

}  // namespace rondo::choreo
