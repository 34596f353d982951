#include "choreo/obligations/obligations.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "choreo/obligations/facts.h"
#include "expr/defined.h"
#include "expr/substitute.h"

namespace rondo::choreo {
namespace {

using expr::Arena;
using expr::Rational;
using expr::TermId;
using robot::Shape;

/// What holds in a thread besides its own facts: assumptions of all threads around, what has to be
/// guaranteed, and the region that is its own.
struct Context {
  std::vector<TermId> assumptions;
  std::vector<std::pair<TermId, diag::Span>> guarantees;
  std::optional<TermId> region;
};

/// In words: what holds, and what is the matter if it does not.
struct Claim {
  std::string title, failure;
};

Claim Noun(const std::string& title) { return {title, title + " may not hold"}; }
Claim State(const std::string& state) { return {"a state " + state, "there is no state " + state}; }

class Builder {
 public:
  Builder(const Graph& graph, Arena& arena) : graph_(graph), arena_(arena), facts_(FactsOf(graph, arena)) {}

  Obligations Run(const std::vector<SideCondition>& conditions) {
    const auto range = [&](const robot::Variable& v) {
      std::vector<TermId>& bounds = ranges_[v.term];
      if (v.least) bounds.push_back(arena_.Le(*v.least, v.term));
      if (v.most) bounds.push_back(arena_.Le(v.term, *v.most));
    };
    for (const robot::Body& body : graph_.world->bodies) {
      std::ranges::for_each(body.states, range);
      std::ranges::for_each(body.inputs, range);
    }
    std::ranges::for_each(graph_.world->environment, range);
    for (const robot::Body& body : graph_.world->bodies) {
      if (!body.body || !body.hull) continue;
      Apart(ObligationKind::kHull, body.type->name.span, {fmt::format("the hull of `{}`", body.name.text),
             fmt::format("the hull of `{}` does not contain its body", body.type->name.text)},
            {arena_.True(), {*body.body}, arena_.True(), *body.hull});
    }
    Sat(graph_.source->span, State("in which it begins"), {graph_.initially}, ObligationKind::kInitial);
    Solid();
    Initial();
    for (size_t i = 0; i < graph_.instances.size(); ++i) {
      instances_ = {i};
      Contract(graph_.instances[i]);
    }
    instances_.clear();
    Thread(graph_.start, NodeId(), {});
    for (const SideCondition& c : conditions) Condition(c);
    return std::move(result_);
  }

 private:
  // -- stating

  // The last formula, with those that share variables with it, directly or over others.
  void Unsat(ObligationKind kind, diag::Span span, const Claim& claim, const std::vector<TermId>& formulas) {
    std::vector<TermId> others(formulas.begin(), formulas.end() - 1);
    const TermId known = Related({formulas.back()}, others);
    Add({kind, span, claim.title, claim.failure, false, arena_.And(known, formulas.back()), arena_.And(others),
         {}, {}, {}});
  }

  // No point is in all these shapes.
  void Apart(ObligationKind kind, diag::Span span, const Claim& claim, robot::Meeting meeting) {
    std::vector<TermId> others{meeting.configuration};
    meeting.configuration = arena_.True();
    meeting.configuration = Related({robot::Formula(arena_, graph_.world->point, meeting)}, others);
    const TermId formula = robot::Formula(arena_, graph_.world->point, meeting);
    Add({kind, span, claim.title, claim.failure, false, formula, arena_.And(others), std::move(meeting), {}, {}});
  }

  void Sat(diag::Span span, const Claim& claim, std::vector<TermId> formulas,
           ObligationKind kind = ObligationKind::kContract) {
    std::vector<TermId> others;
    formulas.push_back(Related(formulas, others));
    Add({kind, span, claim.title, claim.failure, true, arena_.And(formulas), arena_.True(), {}, {}, {}});
  }

  void Add(Obligation obligation) {
    obligation.node = node_;
    obligation.instances = instances_;
    const TermId formula = obligation.formula;
    if (formula == arena_.Constant(obligation.satisfiable) || !known_.insert(formula).second) return;
    result_.all.push_back(std::move(obligation));
  }

  // Takes out of `formulas` what is about the variables of `roots`, or about variables that such formulas
  // mention, and so on; with the ranges of all these variables.
  TermId Related(const std::vector<TermId>& roots, std::vector<TermId>& formulas) {
    std::vector<std::pair<TermId, std::set<TermId>>> open;
    for (const TermId f : formulas) {
      for (const TermId part : Conjuncts(arena_, f)) open.emplace_back(part, robot::VariablesOf(arena_, {part}));
    }
    std::set<TermId> variables = robot::VariablesOf(arena_, roots);
    std::vector<TermId> related;
    for (bool grown = true; grown;) {
      grown = false;
      std::erase_if(open, [&](const auto& entry) {
        const auto& [part, own] = entry;
        if (!own.empty() && std::ranges::none_of(own, [&](TermId v) { return variables.contains(v); }))
          return false;
        related.push_back(part);
        variables.insert(own.begin(), own.end());
        return grown = true;
      });
    }
    formulas.clear();
    for (const auto& [part, own] : open) formulas.push_back(part);
    std::ranges::sort(related);
    for (const TermId v : variables) {
      const auto it = ranges_.find(v);
      if (it != ranges_.end()) related.insert(related.end(), it->second.begin(), it->second.end());
    }
    return arena_.And(related);
  }

  void Lacks(diag::Span span, std::string what, bool region = false) {
    const bool said = std::ranges::any_of(result_.missing, [&](const Missing& m) { return m.what == what; });
    if (!said) result_.missing.push_back({span, std::move(what), region});
  }

  TermId In(const Shape& shape) { return robot::Contains(arena_, shape, graph_.world->point); }
  const std::string& NameOf(RobotId r) const { return graph_.NameOf(r); }

  const Shape* BodyOf(RobotId r) {
    const auto& body = graph_.BodyOf(r).body;
    if (!body)
      Lacks(graph_.BodyOf(r).type->name.span,
            fmt::format("the body of `{}`", graph_.BodyOf(r).type->name.text));
    return body ? &*body : nullptr;
  }

  // Where a formula is not true.
  TermId Fails(TermId formula) { return expr::Complement(arena_, formula); }
  TermId NoneOf(const std::vector<TermId>& formulas) {
    std::vector<TermId> all;
    for (const TermId f : formulas) all.push_back(Fails(f));
    return arena_.And(all);
  }

  // -- the whole

  // A shape that has no value, or no points, would be in nobody's way.
  void Solid() {
    for (const robot::Body& b : graph_.world->bodies) {
      if (b.body) Exists(b.type->name.span, fmt::format("the body of `{}`", b.name.text), *b.body, arena_.True());
    }
    for (const robot::Obstacle& o : graph_.world->obstacles)
      Exists(o.name.span, fmt::format("the obstacle `{}`", o.name.text), o.shape, arena_.True());
  }

  void Exists(diag::Span span, const std::string& what, const Shape& shape, TermId when) {
    Unsat(ObligationKind::kBody, span, {what + " has points, whatever the state is", what + " may have no points"},
          {when, robot::MayBeEmpty(arena_, shape)});
    Sat(span, {what + " has points", what + " has no points"}, {when, In(shape)}, ObligationKind::kBody);
  }

  void Initial() {
    for (size_t i = 0; i < graph_.robots.size(); ++i) {
      const Shape* a = BodyOf(RobotId(i));
      if (a == nullptr) continue;
      for (size_t j = i + 1; j < graph_.robots.size(); ++j) {
        const Shape* b = BodyOf(RobotId(j));
        if (b == nullptr) continue;
        const std::string both = fmt::format("`{}` and `{}`", NameOf(RobotId(i)), NameOf(RobotId(j)));
        Apart(ObligationKind::kInitial, graph_.source->span,
              {both + " are apart initially", both + " may touch initially"},
              {graph_.initially, {*a, *b}, arena_.True(), {}});
      }
      for (const robot::Obstacle& o : graph_.world->obstacles) {
        const std::string both = fmt::format("`{}` and the obstacle `{}`", NameOf(RobotId(i)), o.name.text);
        Apart(ObligationKind::kInitial, graph_.source->span,
              {both + " are apart initially", both + " may touch initially"},
              {graph_.initially, {*a, o.shape}, arena_.True(), {}});
      }
    }
  }

  // A contract that nothing can keep would prove everything.
  void Contract(const Instance& i) {
    const diag::Span span = i.motion->name.span;
    const std::string who = fmt::format("`{}: {}`", NameOf(i.robot), i.text);
    const robot::Contract& c = i.contract;
    Sat(span, State("in which " + who + " may begin"),
        {c.pre, arena_.And(c.assume, AtClock(c.during, Number(0)))});
    // What the motion leaves as it is stays as it was required to be.
    const TermId during = arena_.And({c.during, c.assume, Unchanged(i)});
    Sat(span, State("during " + who), {during, Elapsed(i.duration)});
    for (const Rational& t : Instants(i.duration.least, c.during))
      Sat(span, State(fmt::format("{:.3g} s after {} has begun", t.ToDouble(), who)), {AtClock(during, Seconds(t))});
    if (i.duration.interruptible && c.post != arena_.True()) {
      Unsat(ObligationKind::kInterrupted, span,
            {"what " + who + " promises whenever it may be interrupted",
             "what " + who + " promises may not hold when a message ends it"},
            {c.during, c.assume, Ended(i.duration), Fails(c.post)});
    }
    // At the latest, if that can be; or some time before.
    const TermId late = i.duration.most ? Seconds(*i.duration.most) : Seconds(i.duration.least);
    const TermId ends = arena_.And({c.post, during, Ended(i.duration)});
    Sat(span, State("in which " + who + " ends"), {arena_.Or(AtClock(ends, late), ends)});
    if (c.footprint) {
      Unsat(ObligationKind::kBody, span,
            {"the footprint of " + who + " has a value", "the footprint of " + who + " may have no value"},
            {c.during, c.assume, Elapsed(i.duration), robot::Undefined(arena_, *c.footprint)});
    }
  }

  // Some moments up to `least`, if the formula depends on the clock. There has to be a state at each of them.
  std::vector<Rational> Instants(const Rational& least, TermId during) const {
    std::vector<Rational> instants;
    if (!robot::VariablesOf(arena_, {during}).contains(graph_.world->clock)) return instants;
    constexpr int kInstants = 4;
    for (int k = 0; k <= kInstants && !(least.IsZero() && k > 0); ++k)
      instants.push_back(least * Rational(k) / Rational(kInstants));
    return instants;
  }

  // The part of a precondition about states that a motion does not modify.
  TermId Unchanged(const Instance& i) {
    std::set<TermId> changing;
    const robot::Body& body = graph_.BodyOf(i.robot);
    for (size_t k = 0; k < body.states.size(); ++k) {
      if (i.contract.modifies[k]) changing.insert(body.states[k].term);
    }
    for (const auto& v : body.inputs) changing.insert(v.term);
    for (const auto& v : graph_.world->environment) changing.insert(v.term);
    std::vector<TermId> kept;
    for (const TermId part : Conjuncts(arena_, i.contract.pre)) {
      const auto variables = robot::VariablesOf(arena_, {part});
      if (std::ranges::none_of(variables, [&](TermId v) { return changing.contains(v); })) kept.push_back(part);
    }
    return arena_.And(kept);
  }

  TermId Number(int64_t n) { return arena_.Number(arena_.Real(), Rational(n)); }
  TermId Seconds(const Rational& r) { return arena_.Number(arena_.Real(), r); }

  TermId AtClock(TermId formula, TermId time) {
    return expr::Substitute(arena_, formula, {{graph_.world->clock, time}});
  }

  // 0 <= clock <= most
  TermId Elapsed(const Duration& d) {
    const TermId clock = graph_.world->clock;
    const TermId from = arena_.Le(Number(0), clock);
    return d.most ? arena_.And(from, arena_.Le(clock, Seconds(*d.most))) : from;
  }

  // least <= clock <= most
  TermId Ended(const Duration& d) {
    return arena_.And(Elapsed(d), arena_.Le(Seconds(d.least), graph_.world->clock));
  }

  // -- along the graph

  // All nodes of a thread, up to its join.
  void Thread(NodeId start, NodeId join, const Context& context) {
    std::set<NodeId> seen;
    std::vector<NodeId> todo{start};
    while (!todo.empty()) {
      const NodeId id = todo.back();
      todo.pop_back();
      if (id == join || !seen.insert(id).second) continue;
      const Node& n = graph_[id];
      node_ = id;
      instances_.clear();
      switch (n.kind) {
        case NodeKind::kMotion:
          Motion(id, n, context);
          break;
        case NodeKind::kMessage:
          Message(id, n, context);
          break;
        case NodeKind::kChoice:
          Choice(id, n, context);
          break;
        case NodeKind::kFork:
          Fork(n, context);
          todo.push_back(n.join);
          continue;
        case NodeKind::kMerge:
        case NodeKind::kJoin:
        case NodeKind::kEnd:
          break;
      }
      todo.insert(todo.end(), n.next.begin(), n.next.end());
    }
  }

  std::vector<TermId> Known(NodeId id, const Context& context) {
    std::vector<TermId> known = context.assumptions;
    known.push_back(ToTerm(arena_, facts_[id.index()]));
    return known;
  }

  void Choice(NodeId id, const Node& n, const Context& context) {
    auto formulas = Known(id, context);
    formulas.push_back(NoneOf(n.guard_terms));
    Unsat(ObligationKind::kTotalChoice, n.span,
          {fmt::format("some alternative of `{}` is open", NameOf(n.chooser)),
           fmt::format("`{}` may have no alternative", NameOf(n.chooser))}, std::move(formulas));
  }

  // What is sent is some value as promised, or the value that is stated; the guard holds.
  // No value among those that come into question is as promised: what the payload is said to equal, what
  // bounds it, and between. In every state one of them has to do, since receivers rely on the promise.
  TermId NoPayload(const Node& n) {
    // Where a way fails: it is not true, or the promise has no value.
    struct Try {
      TermId holds, undefined;
    };
    std::vector<Try> ways{{n.refinement, expr::Undefined(arena_, n.refinement)}};
    std::set<TermId> carried;
    for (size_t i = 0; i < n.payload.size(); ++i) {
      if (i < n.names.size() && !n.names[i].empty()) carried.merge(robot::VariablesOf(arena_, n.payload[i].terms));
    }
    for (const TermId v : carried) {
      std::vector<Try> next;
      for (const Try& way : ways) {
        for (const TermId candidate : Candidates(way.holds, v)) {
          next.push_back({expr::Substitute(arena_, way.holds, {{v, candidate}}),
                          expr::Substitute(arena_, way.undefined, {{v, candidate}})});
        }
      }
      constexpr size_t kMostWays = 64;
      if (next.size() > kMostWays) next.resize(kMostWays);
      ways = std::move(next);
    }
    std::vector<TermId> fails;
    for (const Try& way : ways) fails.push_back(arena_.Or(Fails(way.holds), way.undefined));
    return arena_.And(fails);
  }

  // Values of `v` at which comparisons change.
  std::vector<TermId> Candidates(TermId formula, TermId v) {
    if (arena_.sort_of(v) == arena_.Bool()) return {arena_.True(), arena_.False()};
    std::vector<TermId> bounds;
    std::unordered_set<TermId> seen;
    const TermId zero = Number(0), one = Number(1);
    expr::VisitPostorder(arena_, formula, seen, [&](TermId t) {
      const expr::Op op = arena_.op(t);
      if (op != expr::Op::kLe && op != expr::Op::kLt && op != expr::Op::kEq) return;
      if (arena_.sort_of(arena_.arg(t, 0)) == arena_.Bool()) return;
      // a + b v = 0
      const TermId difference = arena_.Sub(arena_.arg(t, 0), arena_.arg(t, 1));
      const TermId a = expr::Substitute(arena_, difference, {{v, zero}});
      const TermId b = arena_.Sub(expr::Substitute(arena_, difference, {{v, one}}), a);
      if (robot::VariablesOf(arena_, {a, b}).contains(v) || b == zero) return;
      bounds.push_back(arena_.Neg(arena_.Divide(a, b)));
    });
    std::vector<TermId> values;
    const TermId half = arena_.Number(arena_.Real(), Rational(1) / Rational(2));
    for (size_t i = 0; i < bounds.size() && i < 4; ++i) {
      values.insert(values.end(), {bounds[i], arena_.Add(bounds[i], one), arena_.Sub(bounds[i], one)});
      for (size_t j = 0; j < i; ++j) values.push_back(arena_.Mul(half, arena_.Add(bounds[i], bounds[j])));
    }
    if (values.empty()) values.push_back(zero);
    return values;
  }

  void Message(NodeId id, const Node& n, const Context& context) {
    auto formulas = Known(id, context);
    formulas.push_back(Fails(n.when));
    if (n.when != arena_.True())
      Unsat(ObligationKind::kMessage, n.span, Noun(fmt::format("the guard of `{}`", n.label)), std::move(formulas));
    if (n.refinement == arena_.True()) return;
    formulas.back() = NoPayload(n);
    Unsat(ObligationKind::kMessage, n.span,
          {fmt::format("something that `{}` may carry", n.label),
           fmt::format("there may be nothing that `{}` can carry as promised", n.label)},
          std::move(formulas));
  }

  // How long a step takes at most: no longer than any of its motions.
  static Duration StepOf(const Node& n) {
    Duration step{Rational(0), std::nullopt, true};
    for (const Part& p : n.parts) {
      if (p.duration.most && (!step.most || *p.duration.most < *step.most)) step.most = p.duration.most;
    }
    return step;
  }

  void Motion(NodeId id, const Node& n, const Context& context) {
    std::vector<TermId> during = context.assumptions;
    for (const Part& p : n.parts) during.push_back(graph_.instances[p.instance].contract.during);
    during.push_back(Elapsed(StepOf(n)));
    // What nothing changes stays as it was.
    const TermId kept = Kept(graph_, n, facts_[id.index()], arena_);
    during.push_back(kept);
    Rational least(0);
    for (const Part& p : n.parts) {
      if (!p.duration.interruptible && least < p.duration.least) least = p.duration.least;
    }
    const TermId together = arena_.And(during);
    for (const Rational& t : Instants(least, together)) {
      Sat(n.span, State(fmt::format("{:.3g} s after {} has begun", t.ToDouble(), TextOf(n))),
          {AtClock(together, Seconds(t))});
    }
    for (const Part& p : n.parts) {
      instances_ = {p.instance};
      Alone(id, p, during, context);
      Assumption(n, p, kept, context);
    }
    instances_.clear();
    for (const Part& p : n.parts) instances_.push_back(p.instance);
    auto begins = Known(id, context);
    for (const Part& p : n.parts) begins.push_back(graph_.instances[p.instance].contract.pre);
    Sat(n.span, {fmt::format("{} begins", TextOf(n)), fmt::format("{} never begins", TextOf(n))}, std::move(begins), ObligationKind::kReached);
    for (const auto& [guarantee, span] : context.guarantees) {
      auto formulas = during;
      formulas.push_back(Fails(guarantee));
      Unsat(ObligationKind::kGuarantee, n.span, Noun("what the thread guarantees"), std::move(formulas));
    }
    for (size_t i = 0; i < n.parts.size(); ++i) {
      for (size_t j = i + 1; j < n.parts.size(); ++j) {
        instances_ = {n.parts[i].instance, n.parts[j].instance};
        Collision(n.parts[i], n.parts[j], during);
      }
    }
  }

  // "`cart: Idle()`" or "`cart: Idle(), arm: Wait(1 s)`"
  std::string TextOf(const Node& n) const {
    std::string text;
    for (const Part& p : n.parts) {
      text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", NameOf(p.robot),
                          graph_.instances[p.instance].text);
    }
    return "`" + text + "`";
  }

  // Pre, body, obstacles and region of one robot in a step.
  void Alone(NodeId id, const Part& p, const std::vector<TermId>& during, const Context& context) {
    const Instance& instance = graph_.instances[p.instance];
    const robot::Contract& c = instance.contract;
    const std::string who = fmt::format("`{}: {}`", NameOf(p.robot), instance.text);
    auto formulas = Known(id, context);
    formulas.push_back(Fails(c.pre));
    if (c.pre != arena_.True())
      Unsat(ObligationKind::kPrecondition, p.span, Noun("the precondition of " + who), formulas);
    // Its `during`, as it begins.
    const TermId begins = AtClock(c.during, Number(0));
    formulas.back() = Fails(begins);
    if (begins != arena_.True())
      Unsat(ObligationKind::kStart, p.span, {fmt::format("{} begins where its `during` does", who),
             fmt::format("the controller of {} has to bridge its beginning", who)}, formulas);
    const Shape* body = BodyOf(p.robot);
    if (body == nullptr || !c.footprint) return;
    const TermId state = arena_.And(during);
    const auto all_the_time = [&](ObligationKind kind, const Claim& claim, robot::Meeting meeting) {
      meeting.configuration = state;
      Apart(kind, p.span, claim, std::move(meeting));
    };
    if (robot::Within(arena_, *body, *c.footprint) != arena_.True())
      all_the_time(ObligationKind::kBody, {"the footprint of " + who, "the footprint of " + who + " does not contain its body"}, {{}, {*body}, arena_.True(), *c.footprint});
    for (const robot::Obstacle& o : graph_.world->obstacles) {
      const std::string both = fmt::format("{} and the obstacle `{}`", who, o.name.text);
      all_the_time(ObligationKind::kObstacle, {both, both + " may touch"},
                   {{}, {*c.footprint, o.shape}, arena_.True(), {}});
    }
    if (context.region)
      all_the_time(ObligationKind::kRegion, {"the region of " + who, who + " may leave the region of its thread"},
                   {{}, {*c.footprint}, Fails(*context.region), {}});
  }

  // From the promises of those that assume nothing themselves, so that no promise rests on itself; and, for
  // all that, from the beginning.
  void Assumption(const Node& n, const Part& p, TermId kept, const Context& context) {
    const Instance& instance = graph_.instances[p.instance];
    if (instance.contract.assume == arena_.True()) return;
    std::vector<TermId> formulas = context.assumptions;
    for (const Part& q : n.parts) {
      const robot::Contract& c = graph_.instances[q.instance].contract;
      if (q.robot != p.robot && c.assume == arena_.True()) formulas.push_back(c.during);
    }
    formulas.push_back(kept);
    formulas.push_back(Elapsed(instance.duration));
    formulas.push_back(Fails(instance.contract.assume));
    Unsat(ObligationKind::kAssumption, p.span,
          Noun(fmt::format("what `{}: {}` assumes", NameOf(p.robot), instance.text)), std::move(formulas));
  }

  void Collision(const Part& p, const Part& q, const std::vector<TermId>& during) {
    const robot::Contract& a = graph_.instances[p.instance].contract;
    const robot::Contract& b = graph_.instances[q.instance].contract;
    if (!a.footprint || !b.footprint) return;  // said where it is missing
    const std::string both =
        fmt::format("`{}: {}` and `{}: {}`", NameOf(p.robot), graph_.instances[p.instance].text,
                    NameOf(q.robot), graph_.instances[q.instance].text);
    Apart(ObligationKind::kCollision, p.span, {both, both + " may touch"},
          {arena_.And(during), {*a.footprint, *b.footprint}, arena_.True(), {}});
  }

  // A process decides and calls by what its robot knows.
  void Condition(const SideCondition& c) {
    node_ = c.at.empty() ? NodeId() : c.at[0];
    instances_.clear();
    std::vector<TermId> known;
    for (const NodeId id : c.at) {
      const Facts& facts = facts_[id.index()];
      known.push_back(c.moving ? Kept(graph_, graph_[id], facts, arena_)
                               : OwnFacts(graph_, c.robot, facts, arena_));
    }
    std::vector<TermId> formulas{known.empty() ? arena_.True() : arena_.Or(known), c.hypothesis};
    if (c.moving && c.at.size() == 1) formulas.push_back(Elapsed(StepOf(graph_[c.at[0]])));
    formulas.push_back(Fails(c.goal));
    const std::string what = c.what.substr(c.what.find(' ') + 1);  // "whether ..."
    Unsat(ObligationKind::kProcess, c.span, {what, "it does not follow that " + what}, formulas);
  }

  // Is it about robots of this scope alone?
  bool About(TermId formula, const Scope& scope) {
    const auto variables = robot::VariablesOf(arena_, {formula});
    for (size_t r = 0; r < graph_.robots.size(); ++r) {
      if (scope.contains(RobotId(r))) continue;
      const auto& states = graph_.world->bodies[r].states;
      if (std::ranges::any_of(states, [&](const auto& v) { return variables.contains(v.term); }))
        return false;
    }
    return true;
  }

  void Fork(const Node& n, const Context& context) {
    Circles(n);
    for (const auto& guarantee : context.guarantees) {
      bool one = false;
      for (const Scope& thread : n.threads) one = one || About(guarantee.first, thread);
      if (!one)
        Lacks(guarantee.second,
              "a thread that can guarantee this alone: it is about robots of several threads");
    }
    for (size_t b = 0; b < n.next.size(); ++b) {
      const ThreadFacts& own = n.facts[b];
      const std::string robots = graph_.Names(n.threads[b]);
      if (!own.region) Lacks(own.span, fmt::format("a region for {}", robots), true);
      std::vector<TermId> others = context.assumptions;
      for (size_t j = 0; j < n.next.size(); ++j) {
        if (j != b) others.push_back(n.facts[j].guarantee);
      }
      if (own.assume != arena_.True()) {
        others.push_back(Fails(own.assume));
        Unsat(ObligationKind::kThread, own.span, Noun(fmt::format("what the thread of {} assumes", robots)),
              std::move(others));
      }
      if (own.region && context.region) {
        auto formulas = context.assumptions;
        formulas.insert(formulas.end(), {own.assume, *own.region, Fails(*context.region)});
        Unsat(ObligationKind::kFork, own.span, {fmt::format("the region of {} within that around it", robots),
               fmt::format("the region of {} reaches beyond that around it", robots)},
              std::move(formulas));
      }
      for (size_t j = b + 1; j < n.next.size(); ++j) {
        if (!own.region || !n.facts[j].region) continue;
        auto formulas = context.assumptions;
        formulas.insert(formulas.end(),
                        {*own.region, *n.facts[j].region, own.guarantee, n.facts[j].guarantee});
        const std::string both = fmt::format("the regions of {} and {}", robots, graph_.Names(n.threads[j]));
        Unsat(ObligationKind::kFork, own.span, {both + " are disjoint", both + " overlap"},
              std::move(formulas));
      }
      Context inner = context;
      inner.guarantees.clear();
      for (const auto& [guarantee, span] : context.guarantees) {
        if (About(guarantee, n.threads[b])) inner.guarantees.emplace_back(guarantee, span);
      }
      inner.assumptions.push_back(own.assume);
      for (const TermId part : Conjuncts(arena_, own.guarantee))
        inner.guarantees.emplace_back(part, own.span);
      if (own.region) inner.region = own.region;
      Thread(n.next[b], n.join, inner);
    }
  }

  // A guarantee is shown under the assumptions of its thread. Where two threads assume something and both
  // guarantee something, each might rest on the other.
  void Circles(const Node& n) {
    size_t both = 0;
    for (const ThreadFacts& f : n.facts)
      both += f.assume != arena_.True() && f.guarantee != arena_.True() ? 1 : 0;
    if (both > 1) Lacks(n.span, "an order of assumptions: threads assume what others guarantee, in a circle");
  }

  const Graph& graph_;
  Arena& arena_;
  std::vector<Facts> facts_;
  std::map<TermId, std::vector<TermId>> ranges_;  // by variable
  std::set<TermId> known_;
  NodeId node_;
  std::vector<size_t> instances_;
  Obligations result_;
};

}  // namespace

Obligations ObligationsOf(const Graph& graph, Arena& arena, const std::vector<SideCondition>& conditions) {
  return Builder(graph, arena).Run(conditions);
}

bool IsRequired(ObligationKind kind) {
  return kind != ObligationKind::kStart && kind != ObligationKind::kReached;
}

std::string_view KindName(ObligationKind kind) {
  switch (kind) {
    case ObligationKind::kHull:
      return "hull";
    case ObligationKind::kInitial:
      return "initial";
    case ObligationKind::kPrecondition:
      return "precondition";
    case ObligationKind::kAssumption:
      return "assumption";
    case ObligationKind::kGuarantee:
      return "guarantee";
    case ObligationKind::kBody:
      return "body";
    case ObligationKind::kCollision:
      return "collision";
    case ObligationKind::kObstacle:
      return "obstacle";
    case ObligationKind::kRegion:
      return "region";
    case ObligationKind::kFork:
      return "fork";
    case ObligationKind::kThread:
      return "thread";
    case ObligationKind::kTotalChoice:
      return "total-choice";
    case ObligationKind::kMessage:
      return "message";
    case ObligationKind::kContract:
      return "contract";
    case ObligationKind::kInterrupted:
      return "interrupted";
    case ObligationKind::kStart:
      return "start";
    case ObligationKind::kProcess:
      return "process";
    case ObligationKind::kReached:
      return "reached";
  }
  return "";
}

}  // namespace rondo::choreo
