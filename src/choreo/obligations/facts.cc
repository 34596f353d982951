#include "choreo/obligations/facts.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include "choreo/obligations/solve_for.h"
#include "expr/substitute.h"

namespace rondo::choreo {

using expr::Arena;
using expr::TermId;

namespace {

constexpr size_t kMostWays = 12;

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
    Reach(graph_.start, {Conjuncts(arena_, graph_.initially)}, graph_[graph_.start].scope);
    while (!todo_.empty()) {
      const NodeId id = todo_.back();
      todo_.pop_back();
      Step(id);
    }
    return std::move(facts_);
  }

 private:
  // Adds ways by which a node is reached, from a node with this scope. What is about robots of other threads
  // was true for a moment: they go on meanwhile.
  void Reach(NodeId id, const Facts& ways, const Scope& from) {
    const bool join = graph_[id].kind == NodeKind::kJoin;
    Facts& known = join ? arrived_[id][from] : facts_[id.index()];
    const Facts before = known;
    known.merge(Without(arena_, ways, StatesOfOthers(graph_, from)));
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
        return Reach(n.next[0], After(id, n, facts), n.scope);
      case NodeKind::kChoice:
        for (size_t b = 0; b < n.next.size(); ++b) Reach(n.next[b], With(facts, n.guard_terms[b]), n.scope);
        return;
      case NodeKind::kFork:
        for (size_t b = 0; b < n.next.size(); ++b) Reach(n.next[b], facts, n.threads[b]);
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

  Facts After(NodeId id, const Node& motion, const Facts& facts) {
    const TermId end = EndOf(id, motion);
    Conjunction news;
    if (!arena_.IsNumber(end)) {
      const Duration step = StepOf(motion);
      news.insert(arena_.Le(arena_.Number(arena_.Real(), step.least), end));
      if (step.most) news.insert(arena_.Le(end, arena_.Number(arena_.Real(), *step.most)));
    }
    for (const Part& p : motion.parts) {
      const robot::Contract& c = graph_.instances[p.instance].contract;
      news.merge(Conjuncts(arena_, expr::Substitute(arena_, c.post, {{graph_.world->clock, end}})));
      news.merge(AtTheEnd(c, end));
    }
    std::set<TermId> old = ChangingIn(graph_, motion);
    old.insert(end);  // of an earlier time
    Facts result;
    for (Conjunction way : Without(arena_, facts, old)) {
      way.insert(news.begin(), news.end());
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

  // When a step ends: a number, if all agree on it; or some moment, one for each step.
  TermId EndOf(NodeId id, const Node& motion) {
    const Duration step = StepOf(motion);
    if (step.most && step.least == *step.most) return arena_.Number(arena_.Real(), step.least);
    const auto it = ends_.find(id);
    if (it != ends_.end()) return it->second;
    return ends_.emplace(id, arena_.FreshConstant("end", arena_.Real())).first->second;
  }

  // What `during` says of the last moment. Inputs may change as soon as it is over.
  Conjunction AtTheEnd(const robot::Contract& contract, TermId end) const {
    // States that `post` gives in full: the rest would only repeat it.
    std::set<TermId> given{graph_.world->clock};
    for (const TermId part : Conjuncts(arena_, contract.post)) {
      const auto variables = robot::VariablesOf(arena_, {part});
      if (variables.size() == 1 && SolveFor(arena_, part, *variables.begin()))
        given.insert(*variables.begin());
    }
    Conjunction result;
    for (const TermId part : Conjuncts(arena_, contract.during)) {
      const auto variables = robot::VariablesOf(arena_, {part});
      if (std::ranges::any_of(variables, [&](TermId v) { return outside_.contains(v); })) continue;
      if (std::ranges::includes(given, variables)) continue;
      result.merge(Conjuncts(arena_, expr::Substitute(arena_, part, {{graph_.world->clock, end}})));
    }
    return result;
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
  std::map<NodeId, TermId> ends_;                     // when steps end, where that is not fixed
  std::vector<NodeId> todo_;
};

}  // namespace

std::set<TermId> ModifiedIn(const Graph& graph, const Node& motion) {
  std::set<TermId> modified;
  for (const Part& p : motion.parts) {
    const Instance& instance = graph.instances[p.instance];
    const auto& states = graph.BodyOf(p.robot).states;
    for (size_t i = 0; i < states.size(); ++i) {
      if (instance.contract.modifies[i]) modified.insert(states[i].term);
    }
  }
  return modified;
}

std::set<TermId> ChangingIn(const Graph& graph, const Node& motion) {
  std::set<TermId> changing = ModifiedIn(graph, motion);
  for (const robot::Body& body : graph.world->bodies) {
    for (const auto& v : body.inputs) changing.insert(v.term);
  }
  for (const auto& v : graph.world->environment) changing.insert(v.term);
  return changing;
}

Duration StepOf(const Node& motion) {
  Duration step{expr::Rational(0), std::nullopt, true};
  for (const Part& p : motion.parts) {
    if (step.least < p.duration.least) step.least = p.duration.least;
    if (p.duration.most && (!step.most || *p.duration.most < *step.most)) step.most = p.duration.most;
    step.interruptible = step.interruptible && p.duration.interruptible;
  }
  return step;
}

Conjunction Conjuncts(const Arena& arena, TermId formula) {
  if (formula == arena.True()) return {};
  if (arena.op(formula) != expr::Op::kAnd) return {formula};
  const auto args = arena.args(formula);
  return {args.begin(), args.end()};
}

std::vector<TermId> TakeConnected(std::set<TermId>& variables, std::vector<TermId>& parts,
                                  const std::function<const std::set<TermId>&(TermId)>& variables_of) {
  std::vector<TermId> taken;
  for (bool grown = true; grown;) {
    grown = false;
    std::erase_if(parts, [&](TermId part) {
      const std::set<TermId>& own = variables_of(part);
      if (!own.empty() && std::ranges::none_of(own, [&](TermId v) { return variables.contains(v); }))
        return false;
      taken.push_back(part);
      variables.insert(own.begin(), own.end());
      return grown = true;
    });
  }
  return taken;
}

TermId ToTerm(Arena& arena, const Facts& facts) {
  std::vector<TermId> ways;
  for (const Conjunction& way : facts) ways.push_back(arena.And(std::vector<TermId>(way.begin(), way.end())));
  return arena.Or(ways);
}

TermId Kept(const Graph& graph, const Node& motion, const Facts& facts, Arena& arena) {
  return ToTerm(arena, Without(arena, facts, ChangingIn(graph, motion)));
}

TermId OwnFacts(const Graph& graph, RobotId robot, const Facts& facts, Arena& arena) {
  return ToTerm(arena, Without(arena, facts, StatesOfOthers(graph, {robot})));
}

std::vector<Facts> FactsOf(const Graph& graph, Arena& arena) { return Flow(graph, arena).Run(); }

}  // namespace rondo::choreo
