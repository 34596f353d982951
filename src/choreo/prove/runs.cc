#include "choreo/prove/runs.h"

#include <algorithm>
#include <chrono>
#include <map>

#include "choreo/prove/routes.h"

namespace rondo::choreo {
namespace {

using verdict::Verdict;

constexpr size_t kRounds = 3;
constexpr size_t kMostRoutes = 64;

// Is it about what is known at a node?
bool IsAboutAPlace(const Obligation& o) {
  return !o.nodes.empty() && o.kind != ObligationKind::kProcess && o.kind != ObligationKind::kReached &&
         o.kind != ObligationKind::kStart && !o.bridge;
}

class Search {
 public:
  Search(const Graph& graph, expr::Arena& arena, const std::set<std::string>& proved,
         const ProveOptions& options)
      : graph_(graph), arena_(arena), proved_(proved), options_(options) {}

  void Run(const Obligation& obligation, Proof& proof) {
    const base::StopToken stop =
        options_.stop.WithDeadline(std::chrono::steady_clock::now() + options_.limits.time);
    size_t without = 0;  // rounds, up to which every way was decided, and none is that of a run
    for (size_t rounds = 1; rounds <= kRounds; ++rounds) {
      bool none = true;
      for (const NodeId node : obligation.nodes) {
        Known& known = KnownOf(node, rounds);
        none = none && known.routes.complete;
        for (size_t r = 0; r < known.routes.all.size(); ++r) {
          const Route& route = known.routes.all[r];
          if (route.rounds < rounds) continue;  // looked at already
          if (!known.obligations[r]) known.obligations[r] = ObligationsOf(route.graph, arena_, {}, proved_);
          const Decision decision = On(route, *known.obligations[r], obligation, stop);
          if (options_.stop.StopRequested()) return;
          if (decision.verdict == Verdict::kRefuted) {
            proof.turns = route.turns;
            if (!route.turns.empty()) proof.decision.witness = decision.witness;
            return;
          }
          none = none && decision.verdict == Verdict::kProved;
        }
      }
      if (!none || stop.StopRequested()) break;
      without = rounds;
    }
    proof.decision.verdict = Verdict::kNotInductive;
    proof.rounds = without;
  }

 private:
  // Ways to a node, and what is to be shown on each of them, once somebody asked.
  struct Known {
    Routes routes;
    std::vector<std::optional<Obligations>> obligations;
  };
  Known& KnownOf(NodeId node, size_t rounds) {
    const auto [it, fresh] = known_.try_emplace({node, rounds});
    if (fresh) {
      it->second.routes = RoutesTo(graph_, node, rounds, kMostRoutes);
      it->second.obligations.resize(it->second.routes.all.size());
    }
    return it->second;
  }

  // The same obligation where only this way leads to the node. Refuted if any of those that are like it is.
  Decision On(const Route& route, const Obligations& all, const Obligation& obligation,
              const base::StopToken& stop) {
    Decision worst;
    worst.verdict = Verdict::kProved;
    bool found = false;
    for (const Obligation& o : all.all) {
      const bool here = std::ranges::find(o.nodes, route.target) != o.nodes.end();
      if (!here || o.kind != obligation.kind || o.title != obligation.title) continue;
      found = true;
      Limits limits = options_.limits;
      limits.certificates = false;
      const Decision decision = Decide(o, *graph_.world, arena_, {}, limits, stop);
      if (decision.verdict == Verdict::kRefuted) return decision;
      if (decision.verdict != Verdict::kProved) worst = decision;
    }
    if (!found) worst.verdict = Verdict::kUnknown;
    return worst;
  }

  const Graph& graph_;
  expr::Arena& arena_;
  const std::set<std::string>& proved_;
  const ProveOptions& options_;
  std::map<std::pair<NodeId, size_t>, Known> known_;
};

}  // namespace

void FindRuns(const Obligations& obligations, const Graph& graph, expr::Arena& arena,
              const std::set<std::string>& proved, const ProveOptions& options, Proofs& proofs) {
  Search search(graph, arena, proved, options);
  for (size_t i = 0; i < obligations.all.size(); ++i) {
    const Obligation& o = obligations.all[i];
    Proof& proof = proofs.all[i];
    if (proof.decision.verdict != Verdict::kRefuted || !IsAboutAPlace(o)) continue;
    if (options.stop.StopRequested()) return;
    search.Run(o, proof);
  }
}

}  // namespace rondo::choreo
