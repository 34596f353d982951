#include "koord/prove/obligations/round.h"

#include <fmt/format.h>

#include <algorithm>

#include "expr/substitute.h"

namespace rondo::koord {

Round::Round(Vocabulary& vocabulary, Executor& executor, Kind kind, CutOffLimits limits)
    : vocabulary_(vocabulary),
      arena_(vocabulary.arena()),
      model_(vocabulary.model()),
      kind_(kind),
      limits_(limits) {
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
  if (kind == Kind::kCutOff) CanBeCutOff(executor);
  std::vector<std::string> members;  // an event may be called `skip`
  for (const std::string& action : actions_)
    members.push_back((members.empty() ? "no event " : "event ") + action);
  action_sort_ = arena_.Enum(init ? "action at the start" : "action of a round", std::move(members));
  act_ = arena_.Declare(init ? "acts at the start" : "acts in a round", {arena_.Int()}, action_sort_);
  turn_ = arena_.Declare("place in the interleaving", {arena_.Int()}, arena_.Int());
}

void Round::CanBeCutOff(Executor& executor) {
  const View then = vocabulary_.MakeView(" then");
  then_ = settled_;
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    if (model_.variables[v].kind == VariableKind::kSensor || model_.FallsBack(v))
      then_.value[v] = then.value[v];
  }
  const auto predicate = [&](const char* name) {
    return arena_.Declare(name, {arena_.Int()}, arena_.Bool());
  };
  waits_ = predicate("waits to act");
  changes_ = predicate("changes its mind");
  falls_back_ = predicate("falls back");
  for (const FallbackDef* def : model_.fallbacks) {
    const Effect effect = executor.Run(def->code, then_, self_);
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      const Variable& variable = model_.variables[v];
      if (variable.kind == VariableKind::kActuator && variable.module == def->module)
        fallback_[v] = effect.value[v];
    }
  }
}

// What an actuator with a fallback is at the end, if the robot's event leaves `acted` to it.
TermId Round::ActuatorOf(size_t v, TermId r, TermId acted) {
  const TermId before = arena_.Select(start_.value[v], r);
  const TermId then = arena_.Select(then_.value[v], r);
  const TermId after = arena_.Select(end_.value[v], r);
  const TermId fallback = Substitute(arena_, fallback_.at(v), expr::Substitution{{self_, r}});
  return arena_.And(
      arena_.Eq(then, arena_.Ite(Waits(r), before, acted)),
      arena_.Eq(after, arena_.Ite(Changes(r), arena_.Ite(FallsBack(r), fallback, acted), then)));
}

TermId Round::Still(const View& from, const View& to, TermId r) {
  std::vector<TermId> same;
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    const Variable& variable = model_.variables[v];
    if (variable.kind != VariableKind::kSensor || variable.function >= 0) continue;
    same.push_back(arena_.Eq(arena_.Select(from.value[v], r), arena_.Select(to.value[v], r)));
  }
  return arena_.And(same);
}

std::vector<Round::Leg> Round::Legs(TermId r) {
  const TermId no_move = arena_.Not(moved_);
  if (kind_ != Kind::kCutOff) return {{no_move, settled_, end_}};
  // Until the actuators of this robot change, they are what they are then.
  View first = settled_;
  View second = then_;
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    if (!model_.FallsBack(v)) continue;
    first.value[v] = then_.value[v];
    second.value[v] = end_.value[v];
  }
  const TermId constant = arena_.Not(Changes(r));
  return {{arena_.Or(no_move, Changes(r)), settled_, end_},
          {arena_.Or(constant, Still(first, then_, r)), first, then_},
          {arena_.Or(constant, Still(second, end_, r)), second, end_}};
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
  effect.chosen = at(general.chosen);
  for (const TermId v : general.value) effect.value.push_back(at(v));
  for (const SharedWrite& w : general.writes) {
    effect.writes.push_back({w.variable, at(w.condition), {}});
    for (const TermId index : w.indices) effect.writes.back().indices.push_back(at(index));
  }
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
  expr::VisitPostorder(arena_, goal, seen, [&](TermId t) {
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      const Variable& variable = model_.variables[v];
      const bool selects =
          arena_.op(t) == expr::Op::kSelect && arena_.arg(t, 0) == end_.value[v] && !arena_.IsOpen(t);
      if (selects && variable.PerRobot()) Participate(arena_.arg(t, 1));
    }
    if (arena_.op(t) == expr::Op::kSelect && arena_.arg(t, 0) == end_.stopped && !arena_.IsOpen(t))
      Participate(arena_.arg(t, 1));
  });
  FindCells(goal);
}

// What every robot may write: whole variables, and cells of arrays, however deep. (Of an array that is read
// as a whole nothing is known at the end: nothing can be concluded from it.)
void Round::FindCells(TermId goal) {
  std::unordered_set<TermId> seen;
  expr::VisitPostorder(arena_, goal, seen, [&](TermId t) {
    if (arena_.IsOpen(t)) return;
    std::vector<TermId> cell;
    TermId root = t;
    for (; arena_.op(root) == expr::Op::kSelect; root = arena_.arg(root, 0))
      cell.insert(cell.begin(), arena_.arg(root, 1));
    for (size_t v = 0; v < model_.variables.size(); ++v) {
      if (model_.variables[v].kind != VariableKind::kAllwrite || root != end_.value[v]) continue;
      if (arena_.sort(arena_.sort_of(t)).kind == expr::SortKind::kArray) continue;
      const bool known = std::any_of(writers_.begin(), writers_.end(),
                                     [&](const LastWriter& w) { return w.variable == v && w.cell == cell; });
      if (known) continue;
      const TermId robot = arena_.FreshConstant("last writer of " + model_.variables[v].name, arena_.Int());
      writers_.push_back({v, std::move(cell), robot});
      Participate(robot);
      return;
    }
  });
}

TermId Round::PartOf(TermId whole, const LastWriter& last) {
  for (const TermId index : last.cell) whole = arena_.Select(whole, index);
  return whole;
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
          // A write of a part of an array writes all cells of the part.
          std::vector<TermId> here{w.condition};
          for (size_t i = 0; i < std::min(w.indices.size(), last.cell.size()); ++i)
            here.push_back(arena_.Eq(w.indices[i], last.cell[i]));
          any.push_back(arena_.And(here));
        }
        return arena_.Or(any);
      },
      arena_.False());
}

TermId Round::Written(TermId robot, const LastWriter& last) {
  return ByAction(
      robot, [&](const Effect& effect) { return PartOf(effect.value[last.variable], last); },
      PartOf(start_.value[last.variable], last));
}

// What one robot does, and what that makes of its own part of the state.
TermId Round::StateOf(TermId r) {
  std::vector<TermId> facts;
  for (size_t a = 0; a < actions_.size(); ++a) {
    if (a == 0 && kind_ != Kind::kInit) continue;
    const Effect& effect = EffectOf(a, r);
    facts.push_back(arena_.Implies(Acts(r, a), arena_.And(effect.enabled, effect.chosen)));
  }
  if (kind_ == Kind::kEvents) facts.push_back(Urgency(r));
  if (kind_ == Kind::kCutOff) facts.push_back(MayChange(r));
  for (size_t v = 0; v < model_.variables.size(); ++v) {
    const Variable& variable = model_.variables[v];
    if (!variable.PerRobot() || variable.function >= 0) continue;
    const TermId before = arena_.Select(start_.value[v], r);
    const TermId after = arena_.Select(end_.value[v], r);
    if (variable.kind == VariableKind::kSensor) {
      facts.push_back(arena_.Or(moved_, arena_.Eq(after, before)));
      if (kind_ == Kind::kCutOff)
        facts.push_back(arena_.Or(moved_, arena_.Eq(arena_.Select(then_.value[v], r), before)));
      continue;
    }
    const TermId acted = ByAction(
        r, [&](const Effect& e) { return e.value[v]; }, before);
    const bool apart = kind_ == Kind::kCutOff && model_.FallsBack(v);
    facts.push_back(apart ? ActuatorOf(v, r, acted) : arena_.Eq(after, acted));
  }
  const TermId stopped = arena_.Select(start_.stopped, r);
  if (vocabulary_.robots_stop())
    facts.push_back(
        arena_.Eq(arena_.Select(end_.stopped, r),
                  arena_.Or(stopped, ByAction(
                                         r, [](const Effect& e) { return e.stops; }, arena_.False()))));
  // A goal may read `x[i + 1]` behind a condition: that there is such a robot is not known.
  return arena_.Implies(vocabulary_.IsRobot(r), arena_.And(facts));
}

// An urgent event that is enabled must be run, instead of any other, before the environment moves. A robot
// that has not run yet skips so far, and an event that needs a lock may fail to get it.
TermId Round::Urgency(TermId r) {
  std::vector<TermId> facts;
  for (size_t u = 1; u < actions_.size(); ++u) {
    if (!model_.events[u - 1]->urgent) continue;
    const Effect& urgent = EffectOf(u, r);
    const TermId waits = arena_.Not(urgent.enabled);
    // Another robot may hold the lock; of a whole team it is known whether one does.
    std::vector<TermId> holders;
    for (const TermId other : participants_) {
      if (whole_team_ && other != r) holders.push_back(arena_.And(Acts(other, u), EffectOf(u, other).locks));
    }
    const TermId held = whole_team_ ? arena_.Or(holders) : arena_.True();
    facts.push_back(
        arena_.Or({arena_.Not(moved_), arena_.Not(Acts(r, 0)), waits, arena_.And(urgent.locks, held)}));
    for (size_t a = 1; a < actions_.size(); ++a) {
      if (!model_.events[a - 1]->urgent) facts.push_back(arena_.Or(arena_.Not(Acts(r, a)), waits));
    }
  }
  return arena_.And(facts);
}

// When the actuators of a robot change in the middle of a round: it falls back, or what its event wrote comes late.
TermId Round::MayChange(TermId r) {
  std::vector<TermId> facts;
  std::vector<TermId> late{arena_.Not(Changes(r)), FallsBack(r)};
  for (size_t a = 1; a < actions_.size() && !limits_.acts_at_once; ++a) {
    const auto writes = [&](size_t v) {
      return model_.FallsBack(v) && effects_[a].value[v] != arena_.Select(start_.value[v], self_);
    };
    bool any = false;
    for (size_t v = 0; v < model_.variables.size(); ++v) any = any || writes(v);
    if (any) late.push_back(arena_.And(Acts(r, a), Waits(r)));
  }
  facts.push_back(arena_.Or(late));
  if (limits_.runs_urgent) {
    facts.push_back(Urgency(r));
    for (size_t u = 1; u < actions_.size(); ++u) {
      if (model_.events[u - 1]->urgent)
        facts.push_back(arena_.Or(arena_.Not(Acts(r, u)), arena_.Not(Waits(r))));
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
  std::vector<TermId> facts{
      vocabulary_.IsRobot(last.robot),
      arena_.Eq(PartOf(end_.value[last.variable], last),
                arena_.Ite(wrote, Written(last.robot, last), PartOf(start_.value[last.variable], last)))};
  const auto turn = [&](TermId robot) { return arena_.Apply(turn_, {robot}); };
  for (const TermId r : participants_) {
    if (r == last.robot) continue;
    const TermId before = arena_.Or(arena_.Eq(r, last.robot), arena_.Lt(turn(r), turn(last.robot)));
    facts.push_back(arena_.Implies(Wrote(r, last), arena_.And(wrote, before)));
  }
  return arena_.And(facts);
}

std::vector<solve::Assertion> Round::Relate(TermId goal, const std::vector<TermId>& everyone,
                                            const std::vector<TermId>& others) {
  participants_.clear();
  writers_.clear();
  whole_team_ = !everyone.empty();
  for (const TermId r : everyone) Participate(r);
  FindReads(goal);
  // Of a round that is told in full, every shared variable matters.
  for (size_t v = 0; !everyone.empty() && v < model_.variables.size(); ++v) {
    if (model_.variables[v].kind == VariableKind::kAllwrite) FindReads(end_.value[v]);
  }
  readers_ = participants_;
  for (const TermId r : others) Participate(r);
  std::vector<solve::Assertion> result;
  for (const TermId r : participants_) result.push_back({StateOf(r), ""});
  result.push_back({Locks(), ""});
  for (const LastWriter& last : writers_) result.push_back({WriterOf(last), ""});
  return result;
}

}  // namespace rondo::koord
