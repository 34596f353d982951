#include <algorithm>
#include <string>

#include "choreo/obligations/facts.h"
#include "choreo/obligations/solve_for.h"
#include "choreo/obligations/statements.h"
#include "expr/substitute.h"

namespace rondo::choreo {

using expr::Rational;
using expr::TermId;

namespace {

// A motion may begin no farther from its `during` than this: 1 cm, 1 degree.
Rational BridgeOf(lang::Dimension dimension) {
  if (dimension == robot::kLength) return Rational(1) / Rational(100);
  if (dimension == robot::kAngle) return *Rational::Parse("0.0174533");
  return Rational(0);
}

// What a state is when a step begins.
TermId StartOf(expr::Arena& arena, TermId state) {
  const std::string name = "start of " + arena.symbol(arena.symbol_of(state)).name;
  return arena.Variable(arena.Declare(name, {}, arena.Real()));
}

// One formula that says all of what is asked, each part with a name of its own, so that different questions
// differ.
TermId NameOf(Statements& s, const Keeping& k) {
  expr::Arena& arena = s.arena();
  std::vector<TermId> parts;
  const auto formula = [&](const std::string& name, TermId f) {
    parts.push_back(arena.Or(arena.Variable(arena.Declare("part " + name, {}, arena.Bool())), f));
  };
  const auto number = [&](const std::string& name, const Rational& value) {
    parts.push_back(
        arena.Eq(arena.Variable(arena.Declare("value " + name, {}, arena.Real())), s.Number(value)));
  };
  formula("given", k.given);
  formula("during", k.during);
  formula("post", k.post);
  for (size_t i = 0; i < k.starts.size(); ++i) formula("start " + std::to_string(i), k.starts[i]);
  for (size_t i = 0; i < k.moving.size(); ++i)
    number("bridge of " + arena.symbol(arena.symbol_of(k.moving[i])).name, k.bridges[i]);
  number("least", k.least);
  if (k.most) number("most", *k.most);
  if (k.ends) number("ends", Rational(k.chooses ? 2 : 1));
  return arena.And(parts);
}

}  // namespace

Bridge BridgeInto(Statements& s, const Node& n, const Facts& facts, std::vector<TermId> known) {
  // Who may be interrupted at once would never have got there.
  if (StepOf(n).least.IsZero()) return {};
  expr::Arena& arena = s.arena();
  const std::set<TermId> moving = ModifiedIn(s.graph(), n);
  for (const Part& p : n.parts) known.push_back(s.graph().instances[p.instance].contract.pre);
  const Conjunction always = Conjuncts(arena, arena.And(known));
  known.push_back(ToTerm(arena, facts));
  // Most motions begin exactly where the one before has ended.
  const auto is_said = [&](TermId part) {
    return always.contains(part) ||
           std::ranges::all_of(facts, [&](const Conjunction& way) { return way.contains(part); });
  };
  Bridge result;
  std::vector<TermId>& bridge = result.states;
  expr::Substitution earlier;
  for (const Part& p : n.parts) {
    const Instance& i = s.graph().instances[p.instance];
    const auto& states = s.graph().BodyOf(p.robot).states;
    const TermId share =
        arena.Variable(arena.Declare("bridge of " + s.graph().NameOf(p.robot), {}, arena.Real()));
    const size_t before = bridge.size();
    for (const TermId part : Conjuncts(arena, s.AtClock(i.contract.during, 0))) {
      if (is_said(part)) continue;
      for (size_t k = 0; k < states.size(); ++k) {
        const TermId v = states[k].term;
        if (!i.contract.modifies[k] || earlier.contains(v)) continue;
        const auto to = SolveFor(arena, part, v);
        const auto variables = to ? robot::VariablesOf(arena, {*to}) : std::set<TermId>();
        if (!to || std::ranges::any_of(variables, [&](TermId w) { return moving.contains(w); })) continue;
        const TermId from = StartOf(arena, v);
        earlier[v] = from;
        result.bridged.insert(v);
        const TermId way = arena.Sub(*to, from);
        const TermId most = s.Number(BridgeOf(states[k].dimension));
        bridge.insert(bridge.end(), {arena.Eq(v, arena.Add(from, arena.Mul(share, way))),
                                     arena.Le(arena.Neg(most), way), arena.Le(way, most)});
        break;
      }
    }
    if (bridge.size() == before) continue;
    bridge.push_back(arena.Le(s.Number(Rational(0)), share));
    bridge.push_back(arena.Le(share, s.Number(Rational(1))));
  }
  if (earlier.empty()) return result;
  for (const TermId formula : known) bridge.push_back(expr::Substitute(arena, formula, earlier));
  bridge.push_back(arena.Eq(s.graph().world->clock, s.Number(Rational(0))));
  return result;
}

void StateKeeping(Statements& s, const Node& n, const std::string& what, const Facts& facts,
                  const std::vector<TermId>& assumptions, const std::set<TermId>& bridged,
                  const std::set<std::string>& proved) {
  expr::Arena& arena = s.arena();
  Keeping keeping;
  const Duration step = StepOf(n);
  keeping.least = step.least;
  keeping.most = step.most;
  std::vector<TermId> during, post, pre, given = assumptions;
  Conjunction ranges;
  size_t keeping_something = 0;
  expr::Substitution earlier;
  const auto before = [&](TermId v) { return earlier[v] = StartOf(arena, v); };
  for (const Part& p : n.parts) {
    const Instance& i = s.graph().instances[p.instance];
    const robot::Body& body = s.graph().BodyOf(p.robot);
    if (proved.contains(body.type->name.text + "." + i.motion->name.text)) {
      // Its controller keeps it; the others take what it promises.
      given.push_back(i.contract.during);
      continue;
    }
    pre.push_back(i.contract.pre);
    during.push_back(i.contract.during);
    if (i.contract.during != arena.True()) {
      ++keeping_something;
      keeping.chooses = !p.duration.interruptible;
    }
    keeping.ends = keeping.ends || !p.duration.interruptible;
    if (!p.duration.interruptible) post.push_back(i.contract.post);
    for (size_t k = 0; k < body.states.size(); ++k) {
      const robot::Variable& v = body.states[k];
      if (!i.contract.modifies[k]) continue;
      keeping.moving.push_back(v.term);
      keeping.before.push_back(before(v.term));
      keeping.bridges.push_back(bridged.contains(v.term) ? BridgeOf(v.dimension) : Rational(0));
      during.push_back(s.RangeOf(v.term));
      ranges.merge(Conjuncts(arena, during.back()));
    }
  }
  keeping.chooses = keeping.ends && (keeping_something == 0 || (keeping_something == 1 && keeping.chooses));
  keeping.during = arena.And(during);
  keeping.post = arena.And(post);
  // Whoever may stay where it is keeps everything.
  const bool asks = std::ranges::any_of(n.parts, [&](const Part& p) {
    const robot::Contract& c = s.graph().instances[p.instance].contract;
    return c.during != arena.True() || (c.post != arena.True() && !p.duration.interruptible);
  });
  if (!asks) return;
  // Others may have moved on since the beginning.
  for (const TermId v : ChangingIn(s.graph(), n)) {
    if (earlier.contains(v)) continue;
    keeping.others.push_back(v);
    keeping.others_before.push_back(before(v));
  }
  std::vector<TermId> roots = keeping.moving;
  roots.insert(roots.end(), {keeping.during, keeping.post});
  // That the moving states stay in their ranges is to be shown, and not given.
  Conjunction known = Conjuncts(arena, s.Related(roots, given));
  std::erase_if(known, [&](TermId part) { return ranges.contains(part); });
  keeping.given = arena.And(std::vector<TermId>(known.begin(), known.end()));
  for (const Conjunction& way : facts) {
    std::vector<TermId> facts_of_way(way.begin(), way.end());
    facts_of_way.insert(facts_of_way.end(), pre.begin(), pre.end());
    const TermId start = s.Related(roots, facts_of_way);
    keeping.starts.push_back(expr::Substitute(arena, start, earlier));
  }
  const TermId name = NameOf(s, keeping);
  s.Keep(n.span, {"a continuous motion that keeps " + what, "nothing that moves continuously keeps " + what},
         name, std::move(keeping));
}

}  // namespace rondo::choreo
