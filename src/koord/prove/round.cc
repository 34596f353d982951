#include "koord/prove/round.h"

#include <fmt/format.h>

#include <algorithm>

#include "expr/substitute.h"

namespace rondo::koord {

Round::Round(Vocabulary& vocabulary, Executor& executor, Kind kind)
    : vocabulary_(vocabulary), arena_(vocabulary.arena()), model_(vocabulary.model()), kind_(kind) {
  const bool init = kind == Kind::kInit;
  start_ = vocabulary.MakeView(init ? " declared" : "");
  // The state that `init` leaves is the start of the first round.
  end_ = vocabulary.MakeView(init ? "" : "'");
  settled_ = end_;
  settled_.planner_suffix = start_.planner_suffix;
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    if (model_.variables[v].kind == VariableKind::kSensor) settled_.value[v] = start_.value[v];
  }
  moved_ = init ? arena_.False() : arena_.Variable(arena_.Declare("environment moved", {}, arena_.Bool()));
  self_ = arena_.FreshConstant("self", arena_.Int());
  if (init) {
    actions_ = {"init"};
    effects_.push_back(executor.RunInit(start_, self_));
  } else {
    actions_ = {"skip"};
    effects_.emplace_back();
    for (const EventDef* event : model_.events) {
      actions_.push_back(event->name);
      effects_.push_back(executor.Run(*event, start_, self_));
    }
  }
  action_sort_ = arena_.Enum(init ? "init action" : "action", actions_);
  act_ = arena_.Declare(init ? "acts initially" : "acts", {arena_.Int()}, action_sort_);
  turn_ = arena_.Declare("turn", {arena_.Int()}, arena_.Int());
}

TermId Round::Acts(TermId robot, size_t action) {
  return arena_.Eq(arena_.Apply(act_, {robot}), arena_.Member(action_sort_, static_cast<uint32_t>(action)));
}

const Effect& Round::EffectOf(size_t action, TermId robot) {
  const auto [it, fresh] = instances_.try_emplace({action, robot});
  if (!fresh) return it->second;
  const expr::Substitution map{{self_, robot}};
  const auto at = [&](TermId t) { return t.valid() ? Substitute(arena_, t, map) : t; };
  const Effect& general = effects_[action];
  Effect& effect = it->second;
  effect.enabled = at(general.enabled);
  effect.locks = at(general.locks);
  effect.stops = at(general.stops);
  for (const TermId v : general.value) effect.value.push_back(at(v));
  for (const SharedWrite& w : general.writes)
    effect.writes.push_back({w.variable, at(w.condition), at(w.index)});
  for (const DefinednessCheck& c : general.checks)
    effect.checks.push_back({c.kind, c.span, at(c.reached), at(c.holds)});
  for (const ReadRecord& r : general.reads)
    effect.reads.push_back({r.variable, at(r.index), at(r.value), at(r.reached)});
  return effect;
}

void Round::Participate(TermId robot) {
  if (std::find(participants_.begin(), participants_.end(), robot) == participants_.end())
    participants_.push_back(robot);
}

// Which robots' cells, which shared variables does the goal read at the end?
void Round::FindReads(TermId goal) {
  std::unordered_set<TermId> seen;
  const auto last_writer = [&](size_t variable, TermId cell) {
    const bool known = std::any_of(writers_.begin(), writers_.end(), [&](const LastWriter& w) {
      return w.variable == variable && w.cell == cell;
    });
    if (known) return;
    const TermId robot =
        arena_.FreshConstant("last writer of " + model_.variables[variable].name, arena_.Int());
    writers_.push_back({variable, cell, robot});
    Participate(robot);
  };
  expr::VisitPostorder(arena_, goal, seen, [&](TermId t) {
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      const Variable& variable = model_.variables[v];
      const bool array =
          variable.kind == VariableKind::kAllwrite && model_.types.Is(variable.type, lang::TypeKind::kArray);
      const bool selects =
          arena_.op(t) == expr::Op::kSelect && arena_.arg(t, 0) == end_.value[v] && !arena_.IsOpen(t);
      if (selects && variable.PerRobot()) Participate(arena_.arg(t, 1));
      if (selects && array) last_writer(v, arena_.arg(t, 1));
      if (variable.kind == VariableKind::kAllwrite && !array && t == end_.value[v]) last_writer(v, {});
    }
  });
}

// The value that the robot's action decides.
TermId Round::ByAction(TermId robot, const std::function<TermId(const Effect&)>& value, TermId otherwise) {
  TermId result = otherwise;
  for (size_t a = kind_ == Kind::kInit ? 0 : 1; a < actions_.size(); ++a) {
    result = arena_.Ite(Acts(robot, a), value(EffectOf(a, robot)), result);
  }
  return result;
}

TermId Round::Wrote(TermId robot, const LastWriter& last) {
  return ByAction(
      robot,
      [&](const Effect& effect) {
        std::vector<TermId> any;
        for (const SharedWrite& w : effect.writes) {
          if (w.variable != last.variable) continue;
          const TermId here =
              w.index.valid() && last.cell.valid() ? arena_.Eq(w.index, last.cell) : arena_.True();
          any.push_back(arena_.And(w.condition, here));
        }
        return arena_.Or(any);
      },
      arena_.False());
}

TermId Round::Written(TermId robot, const LastWriter& last) {
  const auto part = [&](TermId whole) { return last.cell.valid() ? arena_.Select(whole, last.cell) : whole; };
  return ByAction(
      robot, [&](const Effect& effect) { return part(effect.value[last.variable]); },
      part(start_.value[last.variable]));
}

// What one robot does, and what that makes of its own part of the state.
TermId Round::StateOf(TermId r) {
  std::vector<TermId> facts{vocabulary_.IsRobot(r)};
  for (size_t a = 0; a < actions_.size(); ++a) {
    if (a == 0 && kind_ == Kind::kEvents) continue;
    facts.push_back(arena_.Implies(Acts(r, a), EffectOf(a, r).enabled));
  }
  if (kind_ == Kind::kEvents) facts.push_back(Urgency(r));
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    const Variable& variable = model_.variables[v];
    if (!variable.PerRobot() || variable.function >= 0) continue;
    const TermId before = arena_.Select(start_.value[v], r);
    const TermId after = arena_.Select(end_.value[v], r);
    if (variable.kind == VariableKind::kSensor) {
      facts.push_back(arena_.Or(moved_, arena_.Eq(after, before)));
    } else {
      facts.push_back(arena_.Eq(after, ByAction(
                                           r, [&](const Effect& e) { return e.value[v]; }, before)));
    }
  }
  const TermId stopped = arena_.Select(start_.stopped, r);
  if (vocabulary_.robots_stop())
    facts.push_back(
        arena_.Eq(arena_.Select(end_.stopped, r),
                  arena_.Or(stopped, ByAction(
                                         r, [](const Effect& e) { return e.stops; }, arena_.False()))));
  return arena_.And(facts);
}

// An urgent event that is enabled must be run, instead of any other, before the environment moves. A robot
// that has not run yet skips so far, and an event that needs a lock may fail to get it.
TermId Round::Urgency(TermId r) {
  std::vector<TermId> facts;
  for (size_t u = 1; u < actions_.size(); ++u) {
    if (!model_.events[u - 1]->urgent) continue;
    const Effect& urgent = EffectOf(u, r);
    const TermId waits = arena_.Not(urgent.enabled);
    if (urgent.locks == arena_.False())
      facts.push_back(arena_.Or({arena_.Not(moved_), arena_.Not(Acts(r, 0)), waits}));
    for (size_t a = 1; a < actions_.size(); ++a) {
      if (!model_.events[a - 1]->urgent) facts.push_back(arena_.Or(arena_.Not(Acts(r, a)), waits));
    }
  }
  return arena_.And(facts);
}

// At most one robot holds the lock of an event.
TermId Round::Locks() {
  std::vector<TermId> facts;
  for (size_t a = 0; a < actions_.size(); ++a) {
    for (size_t i = 0; i < participants_.size(); ++i) {
      for (size_t j = 0; j < i; ++j) {
        const TermId r = participants_[i];
        const TermId s = participants_[j];
        const auto holds = [&](TermId robot) {
          const TermId locks = effects_[a].locks.valid() ? EffectOf(a, robot).locks : arena_.False();
          return arena_.And(Acts(robot, a), locks);
        };
        facts.push_back(arena_.Or({arena_.Not(holds(r)), arena_.Not(holds(s)), arena_.Eq(r, s)}));
      }
    }
  }
  return arena_.And(facts);
}

// The variable has the value of its last writer, or is unchanged if nobody wrote.
TermId Round::WriterOf(const LastWriter& last) {
  const TermId wrote = Wrote(last.robot, last);
  const auto part = [&](TermId whole) { return last.cell.valid() ? arena_.Select(whole, last.cell) : whole; };
  std::vector<TermId> facts{
      arena_.Eq(part(end_.value[last.variable]),
                arena_.Ite(wrote, Written(last.robot, last), part(start_.value[last.variable])))};
  const auto turn = [&](TermId robot) { return arena_.Apply(turn_, {robot}); };
  for (const TermId r : participants_) {
    if (r == last.robot) continue;
    const TermId before = arena_.Or(arena_.Eq(r, last.robot), arena_.Lt(turn(r), turn(last.robot)));
    facts.push_back(arena_.Implies(Wrote(r, last), arena_.And(wrote, before)));
  }
  return arena_.And(facts);
}

std::vector<solve::Assertion> Round::Relate(TermId goal, const std::vector<TermId>& everyone) {
  participants_.clear();
  writers_.clear();
  for (const TermId r : everyone) Participate(r);
  FindReads(goal);
  // Of a round that is told in full, every shared variable matters.
  for (size_t v = 0; !everyone.empty() && v < model_.variables.size(); ++v) {
    if (model_.variables[v].kind == VariableKind::kAllwrite) FindReads(end_.value[v]);
  }
  std::vector<solve::Assertion> result;
  for (const TermId r : participants_) result.push_back({StateOf(r), ""});
  result.push_back({Locks(), ""});
  for (const LastWriter& last : writers_) result.push_back({WriterOf(last), ""});
  return result;
}

}  // namespace rondo::koord
