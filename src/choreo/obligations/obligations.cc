#include "choreo/obligations/obligations.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "choreo/obligations/facts.h"
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

class Builder {
 public:
  Builder(const Graph& graph, Arena& arena) : graph_(graph), arena_(arena), facts_(FactsOf(graph, arena)) {}

  Obligations Run() {
    std::vector<TermId> ranges;
    const auto range = [&](const robot::Variable& v) {
      if (v.least) ranges.push_back(arena_.Le(*v.least, v.term));
      if (v.most) ranges.push_back(arena_.Le(v.term, *v.most));
    };
    for (const robot::Body& body : graph_.world->bodies) {
      std::ranges::for_each(body.states, range);
      std::ranges::for_each(body.inputs, range);
    }
    std::ranges::for_each(graph_.world->environment, range);
    ranges_ = arena_.And(ranges);
    for (const robot::Body& body : graph_.world->bodies) {
      if (!body.body || !body.hull) continue;
      Unsat(ObligationKind::kHull, body.type->name.span, fmt::format("the hull of `{}`", body.name.text),
            {In(*body.body), arena_.Not(In(*body.hull))});
    }
    Initial();
    for (const Instance& i : graph_.instances) Contract(i);
    Thread(graph_.start, NodeId(), {});
    return std::move(result_);
  }

 private:
  // -- stating

  void Unsat(ObligationKind kind, diag::Span span, std::string title, std::vector<TermId> formulas) {
    formulas.push_back(ranges_);
    const TermId formula = arena_.And(formulas);
    if (formula == arena_.False() || !known_.insert(formula).second) return;
    result_.all.push_back({kind, span, std::move(title), false, formula});
  }

  void Sat(diag::Span span, std::string title, std::vector<TermId> formulas) {
    formulas.push_back(ranges_);
    const TermId formula = arena_.And(formulas);
    if (formula == arena_.True() || !known_.insert(formula).second) return;
    result_.all.push_back({ObligationKind::kContract, span, std::move(title), true, formula});
  }

  void Lacks(diag::Span span, std::string what) {
    const bool said = std::ranges::any_of(result_.missing, [&](const Missing& m) { return m.what == what; });
    if (!said) result_.missing.push_back({span, std::move(what)});
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

  // -- the whole

  void Initial() {
    for (size_t i = 0; i < graph_.robots.size(); ++i) {
      const Shape* a = BodyOf(RobotId(i));
      if (a == nullptr) continue;
      for (size_t j = i + 1; j < graph_.robots.size(); ++j) {
        const Shape* b = BodyOf(RobotId(j));
        if (b == nullptr) continue;
        Unsat(ObligationKind::kInitial, graph_.source->span,
              fmt::format("`{}` and `{}` are apart initially", NameOf(RobotId(i)), NameOf(RobotId(j))),
              {graph_.initially, In(*a), In(*b)});
      }
      for (const robot::Obstacle& o : graph_.world->obstacles) {
        Unsat(ObligationKind::kInitial, graph_.source->span,
              fmt::format("`{}` and the obstacle `{}` are apart initially", NameOf(RobotId(i)), o.name.text),
              {graph_.initially, In(*a), In(o.shape)});
      }
    }
  }

  // A contract that nothing can keep would prove everything.
  void Contract(const Instance& i) {
    const diag::Span span = i.motion->name.span;
    const std::string who = fmt::format("`{}: {}`", NameOf(i.robot), i.text);
    const robot::Contract& c = i.contract;
    Sat(span, "a state in which " + who + " may begin",
        {c.pre, arena_.And(c.assume, AtClock(c.during, Number(0)))});
    Sat(span, "a state during " + who, {c.during, c.assume, Elapsed(i.duration)});
    Sat(span, "a state in which " + who + " ends", {c.post, c.during, Ended(i.duration)});
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
    formulas.push_back(arena_.Not(arena_.Or(n.guard_terms)));
    Unsat(ObligationKind::kTotalChoice, n.span,
          fmt::format("some alternative of `{}` is open", NameOf(n.chooser)), std::move(formulas));
  }

  // What is sent is some value as promised, or the value that is stated; the guard holds.
  void Message(NodeId id, const Node& n, const Context& context) {
    auto formulas = Known(id, context);
    formulas.push_back(arena_.Not(n.when));
    if (n.when != arena_.True())
      Unsat(ObligationKind::kMessage, n.span, fmt::format("the guard of `{}`", n.label), std::move(formulas));
    if (n.refinement != arena_.True())
      Sat(n.span, fmt::format("something that `{}` may carry", n.label), {n.refinement});
  }

  void Motion(NodeId id, const Node& n, const Context& context) {
    Duration step{Rational(0), std::nullopt, true};
    std::vector<TermId> during = context.assumptions;
    for (const Part& p : n.parts) {
      const robot::Contract& c = graph_.instances[p.instance].contract;
      during.push_back(c.during);
      if (p.duration.most && (!step.most || *p.duration.most < *step.most)) step.most = p.duration.most;
    }
    during.push_back(Elapsed(step));
    // What nothing changes stays as it was.
    const TermId kept = Kept(graph_, n, facts_[id.index()], arena_);
    during.push_back(kept);
    for (const Part& p : n.parts) {
      Alone(id, p, during, context);
      Assumption(n, p, kept, context);
    }
    for (const auto& [guarantee, span] : context.guarantees) {
      auto formulas = during;
      formulas.push_back(arena_.Not(guarantee));
      Unsat(ObligationKind::kGuarantee, n.span, "what the thread guarantees", std::move(formulas));
    }
    for (size_t i = 0; i < n.parts.size(); ++i) {
      for (size_t j = i + 1; j < n.parts.size(); ++j) Apart(n.parts[i], n.parts[j], during);
    }
  }

  // Pre, body, obstacles and region of one robot in a step.
  void Alone(NodeId id, const Part& p, const std::vector<TermId>& during, const Context& context) {
    const Instance& instance = graph_.instances[p.instance];
    const robot::Contract& c = instance.contract;
    const std::string who = fmt::format("`{}: {}`", NameOf(p.robot), instance.text);
    auto formulas = Known(id, context);
    formulas.push_back(arena_.Not(c.pre));
    if (c.pre != arena_.True())
      Unsat(ObligationKind::kPrecondition, p.span, "precondition of " + who, std::move(formulas));
    const auto all_the_time = [&](ObligationKind kind, const std::string& title, TermId bad) {
      auto with = during;
      with.push_back(bad);
      Unsat(kind, p.span, title, std::move(with));
    };
    const Shape* body = BodyOf(p.robot);
    if (body == nullptr || !c.footprint) return;
    const TermId footprint = In(*c.footprint);
    const TermId occupied = In(*body);
    if (occupied != footprint)
      all_the_time(ObligationKind::kBody, "footprint of " + who, arena_.And(occupied, arena_.Not(footprint)));
    for (const robot::Obstacle& o : graph_.world->obstacles)
      all_the_time(ObligationKind::kObstacle, fmt::format("{} and the obstacle `{}`", who, o.name.text),
                   arena_.And(footprint, In(o.shape)));
    if (context.region)
      all_the_time(ObligationKind::kRegion, "region of " + who,
                   arena_.And(footprint, arena_.Not(*context.region)));
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
    formulas.push_back(arena_.Not(instance.contract.assume));
    Unsat(ObligationKind::kAssumption, p.span,
          fmt::format("what `{}: {}` assumes", NameOf(p.robot), instance.text), std::move(formulas));
  }

  void Apart(const Part& p, const Part& q, const std::vector<TermId>& during) {
    const robot::Contract& a = graph_.instances[p.instance].contract;
    const robot::Contract& b = graph_.instances[q.instance].contract;
    if (!a.footprint || !b.footprint) return;  // said where it is missing
    auto formulas = during;
    formulas.push_back(In(*a.footprint));
    formulas.push_back(In(*b.footprint));
    Unsat(ObligationKind::kCollision, p.span,
          fmt::format("`{}: {}` and `{}: {}`", NameOf(p.robot), graph_.instances[p.instance].text,
                      NameOf(q.robot), graph_.instances[q.instance].text),
          std::move(formulas));
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
      if (!own.region) Lacks(own.span, fmt::format("a region for {}", robots));
      std::vector<TermId> others = context.assumptions;
      for (size_t j = 0; j < n.next.size(); ++j) {
        if (j != b) others.push_back(n.facts[j].guarantee);
      }
      if (own.assume != arena_.True()) {
        others.push_back(arena_.Not(own.assume));
        Unsat(ObligationKind::kThread, own.span, fmt::format("what the thread of {} assumes", robots),
              std::move(others));
      }
      if (own.region && context.region) {
        auto formulas = context.assumptions;
        formulas.insert(formulas.end(), {own.assume, *own.region, arena_.Not(*context.region)});
        Unsat(ObligationKind::kFork, own.span, fmt::format("the region of {} within that around it", robots),
              std::move(formulas));
      }
      for (size_t j = b + 1; j < n.next.size(); ++j) {
        if (!own.region || !n.facts[j].region) continue;
        auto formulas = context.assumptions;
        formulas.insert(formulas.end(),
                        {*own.region, *n.facts[j].region, own.guarantee, n.facts[j].guarantee});
        Unsat(ObligationKind::kFork, own.span,
              fmt::format("the regions of {} and {} are disjoint", robots, graph_.Names(n.threads[j])),
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
  TermId ranges_;
  std::set<TermId> known_;
  Obligations result_;
};

}  // namespace

Obligations ObligationsOf(const Graph& graph, Arena& arena) { return Builder(graph, arena).Run(); }

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
  }
  return "";
}

}  // namespace rondo::choreo
