#include "choreo/obligations/obligations.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "choreo/obligations/facts.h"
#include "choreo/obligations/statements.h"

namespace rondo::choreo {
namespace {

using expr::Arena;
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
  Builder(const Graph& graph, Arena& arena, const std::set<std::string>& proved)
      : graph_(graph), arena_(arena), s_(graph, arena), facts_(FactsOf(graph, arena)), proved_(proved) {}

  Obligations Run(const std::vector<SideCondition>& conditions) {
    StateWhole(s_);
    for (size_t i = 0; i < graph_.instances.size(); ++i) {
      s_.instances = {i};
      StateContract(s_, graph_.instances[i]);
    }
    s_.instances.clear();
    Thread(graph_.start, NodeId(), {});
    for (const SideCondition& c : conditions) Condition(c);
    return s_.Take();
  }

 private:
  const std::string& NameOf(RobotId r) const { return graph_.NameOf(r); }

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
      s_.node = id;
      s_.instances.clear();
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
    formulas.push_back(s_.NoneOf(n.guard_terms));
    s_.Unsat(ObligationKind::kTotalChoice, n.span,
             {fmt::format("some alternative of `{}` is open", NameOf(n.chooser)),
              fmt::format("`{}` may have no alternative", NameOf(n.chooser))},
             formulas);
  }

  // What is sent is some value as promised, or the value that is stated; the guard holds.
  void Message(NodeId id, const Node& n, const Context& context) {
    auto formulas = Known(id, context);
    StatePromise(s_, n, formulas);
    formulas.push_back(s_.Fails(n.when));
    if (n.when != arena_.True())
      s_.Unsat(ObligationKind::kMessage, n.span, Noun(fmt::format("the guard of `{}`", n.label)), formulas);
  }

  void Motion(NodeId id, const Node& n, const Context& context) {
    std::vector<TermId> during = context.assumptions;
    for (const Part& p : n.parts) during.push_back(graph_.instances[p.instance].contract.during);
    during.push_back(s_.Elapsed(StepOf(n)));
    // What nothing changes stays as it was.
    const TermId kept = Kept(graph_, n, facts_[id.index()], arena_);
    during.push_back(kept);
    for (const Part& p : n.parts) {
      s_.instances = {p.instance};
      Begins(id, p, context);
      Assumption(n, p, kept, context);
    }
    s_.instances.clear();
    for (const Part& p : n.parts) s_.instances.push_back(p.instance);
    s_.Sat(n.span, {fmt::format("{} begins", TextOf(n)), fmt::format("{} never begins", TextOf(n))},
           Known(id, context), ObligationKind::kReached);
    const Bridge bridge = BridgeInto(s_, n, facts_[id.index()], context.assumptions);
    StateKeeping(s_, n, TextOf(n), facts_[id.index()], context.assumptions, bridge.bridged, proved_);
    Occupy(n, during, context);
    if (bridge.bridged.empty()) return;
    s_.bridge = true;
    Occupy(n, bridge.states, context);
    s_.bridge = false;
  }

  // "`cart: Move(1 m)`", and when, if it is not yet where it says
  std::string Who(const Part& p) const {
    return fmt::format("`{}: {}`{}", NameOf(p.robot), graph_.instances[p.instance].text,
                       s_.bridge ? " (before it is where `during` begins)" : "");
  }

  // What the robots of a step do in space while these formulas hold.
  void Occupy(const Node& n, const std::vector<TermId>& during, const Context& context) {
    for (const Part& p : n.parts) {
      s_.instances = {p.instance};
      Space(p, during, context);
    }
    s_.instances.clear();
    for (const Part& p : n.parts) s_.instances.push_back(p.instance);
    for (const auto& [guarantee, span] : context.guarantees) {
      auto formulas = during;
      formulas.push_back(s_.Fails(guarantee));
      s_.Unsat(ObligationKind::kGuarantee, n.span, Noun("what the thread guarantees"), formulas);
    }
    std::vector<Member> members;
    for (const Part& p : n.parts) {
      const Instance& i = graph_.instances[p.instance];
      if (!i.contract.footprint) continue;  // said where it is missing
      members.push_back({Who(p), &*i.contract.footprint, {}, {p.instance}});
    }
    StateApart(s_, ObligationKind::kCollision, n.parts[0].span, members, during);
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

  // How one robot begins a step.
  void Begins(NodeId id, const Part& p, const Context& context) {
    const robot::Contract& c = graph_.instances[p.instance].contract;
    const std::string who = Who(p);
    auto formulas = Known(id, context);
    formulas.push_back(s_.Fails(c.pre));
    if (c.pre != arena_.True())
      s_.Unsat(ObligationKind::kPrecondition, p.span, Noun("the precondition of " + who), formulas);
    const TermId begins = s_.AtClock(c.during, 0);
    formulas.back() = s_.Fails(begins);
    if (begins != arena_.True())
      s_.Unsat(ObligationKind::kStart, p.span,
               {fmt::format("{} begins where its `during` does", who),
                fmt::format("the controller of {} has to bridge its beginning", who)},
               formulas);
  }

  // Body, obstacles and region of one robot in a step.
  void Space(const Part& p, const std::vector<TermId>& during, const Context& context) {
    const robot::Contract& c = graph_.instances[p.instance].contract;
    const std::string who = Who(p);
    const Shape* body = BodyOf(s_, p.robot);
    if (body == nullptr || !c.footprint) return;
    const TermId state = arena_.And(during);
    const auto all_the_time = [&](ObligationKind kind, const Claim& claim, robot::Meeting meeting) {
      meeting.configuration = state;
      s_.Apart(kind, p.span, claim, std::move(meeting));
    };
    if (robot::Within(arena_, *body, *c.footprint) != arena_.True())
      all_the_time(ObligationKind::kBody,
                   {"the footprint of " + who, "the footprint of " + who + " does not contain its body"},
                   {{}, {*body}, arena_.True(), *c.footprint});
    for (const robot::Obstacle& o : graph_.world->obstacles) {
      const std::string both = fmt::format("{} and the obstacle `{}`", who, o.name.text);
      all_the_time(ObligationKind::kObstacle, {both, both + " may touch"},
                   {{}, {*c.footprint, o.shape}, arena_.True(), {}});
    }
    if (context.region)
      all_the_time(ObligationKind::kRegion,
                   {"the region of " + who, who + " may leave the region of its thread"},
                   {{}, {*c.footprint}, s_.Fails(*context.region), {}});
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
    formulas.push_back(s_.Elapsed(instance.duration));
    formulas.push_back(s_.Fails(instance.contract.assume));
    s_.Unsat(ObligationKind::kAssumption, p.span,
             Noun(fmt::format("what `{}: {}` assumes", NameOf(p.robot), instance.text)), formulas);
  }

  // A process decides and calls by what its robot knows.
  void Condition(const SideCondition& c) {
    s_.node = c.at.empty() ? NodeId() : c.at[0];
    s_.instances.clear();
    std::vector<TermId> known;
    for (const NodeId id : c.at) {
      const Facts& facts = facts_[id.index()];
      known.push_back(c.moving ? Kept(graph_, graph_[id], facts, arena_)
                               : OwnFacts(graph_, c.robot, facts, arena_));
    }
    std::vector<TermId> formulas{known.empty() ? arena_.True() : arena_.Or(known), c.hypothesis};
    if (c.moving && c.at.size() == 1) formulas.push_back(s_.Elapsed(StepOf(graph_[c.at[0]])));
    formulas.push_back(s_.Fails(c.goal));
    const std::string what = c.what.substr(c.what.find(' ') + 1);  // "whether ..."
    s_.Unsat(ObligationKind::kProcess, c.span, {what, "it does not follow that " + what}, formulas);
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
    std::vector<Member> members;
    std::vector<TermId> known = context.assumptions;
    for (size_t b = 0; b < n.next.size(); ++b) {
      known.push_back(n.facts[b].guarantee);
      if (n.facts[b].region)
        members.push_back({"the region of " + graph_.Names(n.threads[b]), nullptr, *n.facts[b].region, {}});
    }
    StateApart(s_, ObligationKind::kFork, n.span, members, known);
    s_.instances.clear();
    for (const auto& guarantee : context.guarantees) {
      bool one = false;
      for (const Scope& thread : n.threads) one = one || About(guarantee.first, thread);
      if (!one)
        s_.Lacks(guarantee.second,
                 "a thread that can guarantee this alone: it is about robots of several threads");
    }
    for (size_t b = 0; b < n.next.size(); ++b) {
      const ThreadFacts& own = n.facts[b];
      const std::string robots = graph_.Names(n.threads[b]);
      if (!own.region) s_.Lacks(own.span, fmt::format("a region for {}", robots), true);
      std::vector<TermId> others = context.assumptions;
      for (size_t j = 0; j < n.next.size(); ++j) {
        if (j != b) others.push_back(n.facts[j].guarantee);
      }
      if (own.assume != arena_.True()) {
        others.push_back(s_.Fails(own.assume));
        s_.Unsat(ObligationKind::kThread, own.span,
                 Noun(fmt::format("what the thread of {} assumes", robots)), others);
      }
      if (own.region && context.region) {
        auto formulas = context.assumptions;
        formulas.insert(formulas.end(), {own.assume, arena_.And(*own.region, s_.Fails(*context.region))});
        s_.Unsat(ObligationKind::kFork, own.span,
                 {fmt::format("the region of {} within that around it", robots),
                  fmt::format("the region of {} reaches beyond that around it", robots)},
                 formulas);
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
    if (both > 1)
      s_.Lacks(n.span, "an order of assumptions: threads assume what others guarantee, in a circle");
  }

  const Graph& graph_;
  Arena& arena_;
  Statements s_;
  std::vector<Facts> facts_;
  const std::set<std::string>& proved_;
};

}  // namespace

Obligations ObligationsOf(const Graph& graph, Arena& arena, const std::vector<SideCondition>& conditions,
                          const std::set<std::string>& proved) {
  return Builder(graph, arena, proved).Run(conditions);
}

}  // namespace rondo::choreo
