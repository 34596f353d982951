#include "choreo/obligations/facts.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "expr/substitute.h"

namespace rondo::choreo {

using expr::Arena;
using expr::TermId;

namespace {

constexpr size_t kMostWays = 12;

// What may change while a step goes on: what its motions modify, and all that no robot determines.
std::set<TermId> Changing(const Graph& graph, const Node& motion) {
  std::set<TermId> changing;
  for (const robot::Body& body : graph.world->bodies) {
    for (const auto& v : body.inputs) changing.insert(v.term);
  }
  for (const auto& v : graph.world->environment) changing.insert(v.term);
  for (const Part& p : motion.parts) {
    const Instance& instance = graph.instances[p.instance];
    const auto& states = graph.BodyOf(p.robot).states;
    for (size_t i = 0; i < states.size(); ++i) {
      if (instance.contract.modifies[i]) changing.insert(states[i].term);
    }
  }
  return changing;
}

// The facts that do not depend on any of these variables.
Facts Without(const Arena& arena, const Facts& facts, const std::set<TermId>& variables) {
  Facts result;
  for (Conjunction way : facts) {
    std::erase_if(way, [&](TermId fact) {
      return std::ranges::any_of(robot::VariablesOf(arena, {fact}),
                                 [&](TermId v) { return variables.contains(v); });
    });
    result.insert(std::move(way));
  }
  return result;
}

std::set<TermId> StatesOfOthers(const Graph& graph, const Scope& scope) {
  std::set<TermId> foreign;
  for (size_t r = 0; r < graph.robots.size(); ++r) {
    if (scope.contains(RobotId(r))) continue;
    for (const auto& v : graph.world->bodies[r].states) foreign.insert(v.term);
  }
  return foreign;
}

class Flow {
 public:
  Flow(const Graph& graph, Arena& arena) : graph_(graph), arena_(arena), facts_(graph.nodes.size()) {
    for (const robot::Body& body : graph.world->bodies) {
      for (const auto& v : body.inputs) outside_.insert(v.term);
    }
    for (const auto& v : graph.world->environment) outside_.insert(v.term);
  }

  std::vector<Facts> Run() {
    Reach(graph_.start, {Conjuncts(arena_, graph_.initially)});
    while (!todo_.empty()) {
      const NodeId id = todo_.back();
      todo_.pop_back();
      Step(id);
    }
    return std::move(facts_);
  }

 private:
  // Adds ways by which a node is reached, from a node with this scope.
  void Reach(NodeId id, const Facts& ways, const Scope& from = {}) {
    const bool join = graph_[id].kind == NodeKind::kJoin;
    Facts& known = join ? arrived_[id][from] : facts_[id.index()];
    const Facts before = known;
    known.insert(ways.begin(), ways.end());
    if (known.size() > kMostWays || merged_.contains({id, from})) {
      // What all ways have in common.
      merged_.insert({id, from});
      Conjunction common = *known.begin();
      for (const Conjunction& way : known) {
        Conjunction both;
        std::ranges::set_intersection(common, way, std::inserter(both, both.end()));
        common = std::move(both);
      }
      known = {common};
    }
    if (known != before) todo_.push_back(id);
  }

  void Step(NodeId id) {
    const Node& n = graph_[id];
    const Facts& facts = facts_[id.index()];
    switch (n.kind) {
      case NodeKind::kMotion:
        return Reach(n.next[0], After(n, facts), n.scope);
      case NodeKind::kChoice:
        for (size_t b = 0; b < n.next.size(); ++b) Reach(n.next[b], With(facts, n.guard_terms[b]), n.scope);
        return;
      case NodeKind::kFork:
        for (size_t b = 0; b < n.next.size(); ++b) Reach(n.next[b], Own(facts, n.threads[b]), n.threads[b]);
        return;
      case NodeKind::kMessage:
        return Reach(n.next[0], Told(n, facts), n.scope);
      case NodeKind::kMerge:
        return Reach(n.next[0], facts, n.scope);
      case NodeKind::kJoin:
        return Join(id, n);
      case NodeKind::kEnd:
        return;
    }
  }

  Facts With(const Facts& facts, TermId formula) const {
    Facts result;
    for (Conjunction way : facts) {
      way.merge(Conjuncts(arena_, formula));
      if (!way.contains(arena_.False())) result.insert(std::move(way));
    }
    return result;
  }

  Facts After(const Node& motion, const Facts& facts) const {
    Facts result;
    for (Conjunction way : Without(arena_, facts, Changing(graph_, motion))) {
      for (const Part& p : motion.parts) {
        const robot::Contract& c = graph_.instances[p.instance].contract;
        way.merge(Conjuncts(arena_, c.post));
        way.merge(AtTheEnd(motion, c));
      }
      result.insert(std::move(way));
    }
    return result;
  }

  // What a message carries replaces what an earlier one of this node did; it is as promised.
  Facts Told(const Node& message, const Facts& facts) const {
    std::set<TermId> carried;
    for (size_t i = 0; i < message.payload.size(); ++i) {
      if (i < message.names.size() && !message.names[i].empty())
        carried.merge(robot::VariablesOf(arena_, message.payload[i].terms));
    }
    return With(Without(arena_, facts, carried), message.refinement);
  }

  // What `during` says of the last moment: all that does not depend on the clock, and the rest if the moment
  // is known. Inputs and what others do may change as soon as it is over.
  Conjunction AtTheEnd(const Node& motion, const robot::Contract& contract) const {
    const TermId clock = graph_.world->clock;
    std::optional<expr::Rational> end;
    for (const Part& p : motion.parts) {
      if (p.duration.most && p.duration.least == *p.duration.most && !p.duration.interruptible)
        end = p.duration.most;
    }
    Conjunction result;
    for (const TermId part : Conjuncts(arena_, contract.during)) {
      const bool timed = robot::VariablesOf(arena_, {part}).contains(clock);
      if (timed && !end) continue;
      const TermId then =
          timed ? expr::Substitute(arena_, part, {{clock, arena_.Number(arena_.Real(), *end)}}) : part;
      const auto variables = robot::VariablesOf(arena_, {then});
      if (std::ranges::none_of(variables, [&](TermId v) { return outside_.contains(v); }))
        result.merge(Conjuncts(arena_, then));
    }
    return result;
  }

  // What is about robots of the thread alone: others go their own way meanwhile.
  Facts Own(const Facts& facts, const Scope& thread) const {
    return Without(arena_, facts, StatesOfOthers(graph_, thread));
  }

  // The ways of all threads, combined, once each has arrived.
  void Join(NodeId id, const Node& n) {
    const auto fork = std::ranges::find_if(
        graph_.nodes, [&](const Node& f) { return f.kind == NodeKind::kFork && f.join == id; });
    Facts all{{}};
    for (const Scope& thread : fork->threads) {
      const auto arrived = arrived_[id].find(thread);
      if (arrived == arrived_[id].end()) return;
      if (all.size() * arrived->second.size() > 4 * kMostWays) continue;  // less is known
      Facts combined;
      for (const Conjunction& a : all) {
        for (Conjunction c : arrived->second) {
          c.insert(a.begin(), a.end());
          combined.insert(std::move(c));
        }
      }
      all = std::move(combined);
    }
    facts_[id.index()].insert(all.begin(), all.end());
    Reach(n.next[0], all, n.scope);
  }

  const Graph& graph_;
  Arena& arena_;
  std::vector<Facts> facts_;
  std::map<NodeId, std::map<Scope, Facts>> arrived_;  // at joins, by thread
  std::set<std::pair<NodeId, Scope>> merged_;         // where only what is common is kept
  std::set<TermId> outside_;                          // what no robot determines
  std::vector<NodeId> todo_;
};

}  // namespace

Conjunction Conjuncts(const Arena& arena, TermId formula) {
  if (formula == arena.True()) return {};
  if (arena.op(formula) != expr::Op::kAnd) return {formula};
  const auto args = arena.args(formula);
  return {args.begin(), args.end()};
}

TermId ToTerm(Arena& arena, const Facts& facts) {
  std::vector<TermId> ways;
  for (const Conjunction& way : facts) ways.push_back(arena.And(std::vector<TermId>(way.begin(), way.end())));
  return arena.Or(ways);
}

TermId Kept(const Graph& graph, const Node& motion, const Facts& facts, Arena& arena) {
  return ToTerm(arena, Without(arena, facts, Changing(graph, motion)));
}

TermId OwnFacts(const Graph& graph, RobotId robot, const Facts& facts, Arena& arena) {
  return ToTerm(arena, Without(arena, facts, StatesOfOthers(graph, {robot})));
}

std::vector<Facts> FactsOf(const Graph& graph, Arena& arena) { return Flow(graph, arena).Run(); }

}  // namespace rondo::choreo
