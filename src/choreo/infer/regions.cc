#include "choreo/infer/regions.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "choreo/infer/cells.h"
#include "choreo/prove/answer.h"
#include "choreo/prove/sampler.h"
#include "expr/defined.h"
#include "robot/separation/numeric_set.h"
#include "verdict/verdict.h"

namespace rondo::choreo {
namespace {

using expr::Arena;
using expr::Numeric;
using expr::Rational;
using expr::TermId;

constexpr size_t kSamples = 200;
constexpr int kRounds = 16;
constexpr int kSlabs = 4;
constexpr size_t kMostCells = 40;
constexpr std::chrono::milliseconds kPatience{1000};  // for one motion

class Inferring {
 public:
  Inferring(Graph& graph, Arena& arena, const InferOptions& options)
      : graph_(graph), arena_(arena), options_(options) {}

  Inference Run() {
    Visit(graph_.start, NodeId(), std::nullopt, "");
    return std::move(inference_);
  }

 private:
  /// A motion of a thread, as the obligations about regions have it.
  struct Source {
    size_t thread = 0;
    Obligation obligation;
    std::vector<robot::Set> solids;
    std::vector<Numeric::Point> states;
  };

  // All forks from a node on, the outer ones first.
  void Visit(NodeId start, NodeId join, const std::optional<TermId>& outer, const std::string& outer_text) {
    std::set<NodeId> seen;
    std::vector<NodeId> todo{start};
    while (!todo.empty()) {
      const NodeId id = todo.back();
      todo.pop_back();
      if (id == join || !seen.insert(id).second) continue;
      if (graph_[id].kind != NodeKind::kFork) {
        todo.insert(todo.end(), graph_[id].next.begin(), graph_[id].next.end());
        continue;
      }
      const auto& facts = graph_[id].facts;
      const bool lacks = std::ranges::any_of(facts, [](const ThreadFacts& f) { return !f.region; });
      if (lacks) Fork(id, outer, outer_text);
      for (size_t b = 0; b < graph_[id].next.size(); ++b) {
        const ThreadFacts& own = graph_[id].facts[b];
        Visit(graph_[id].next[b], graph_[id].join, own.region ? own.region : outer,
              own.region ? own.region_text : outer_text);
      }
      todo.push_back(graph_[id].join);
    }
  }

  void Fork(NodeId id, const std::optional<TermId>& outer, const std::string& outer_text) {
    if (options_.progress) options_.progress(graph_.Names(graph_[id].scope));
    const std::vector<ThreadFacts> before = graph_[id].facts;
    std::vector<Source> sources = SourcesOf(id);
    const size_t threads = graph_[id].threads.size();
    std::mt19937_64 random(1);
    for (Source& s : sources) {
      if (!Prepare(s, random))
        return Fail(id, before, s.thread, fmt::format("no state of {} was found", MotionOf(s)));
    }
    bool cut = false;
    stop_ = options_.stop.WithDeadline(base::StopToken::Clock::now() + options_.limits.time);
    for (int round = 0; round < kRounds && !stop_.StopRequested(); ++round) {
      std::vector<Extent> items;
      for (size_t s = 0; s < sources.size(); ++s) AddItems(sources[s], s, items);
      const Cells cells = Separate(std::move(items), threads);
      if (cells.conflict && !cut) {
        cut = true;
        for (Source& s : sources) Cut(s);
        continue;
      }
      size_t count = 0;
      for (const auto& own : cells.by_thread) count += own.size();
      if (!cells.conflict && count > kMostCells)
        return Fail(id, before, 0, fmt::format("it would take more than {} cells", kMostCells));
      if (cells.conflict) {
        const auto& [a, b] = *cells.conflict;
        return Fail(id, before, a.thread,
                    fmt::format("nothing separates {} and {}", MotionOf(sources[a.source]),
                                MotionOf(sources[b.source])));
      }
      for (size_t b = 0; b < threads; ++b) {
        ThreadFacts& f = graph_[id].facts[b];
        if (before[b].region) continue;
        const TermId own = ToTerm(cells.by_thread[b]);
        const std::string text = ToText(cells.by_thread[b]);
        f.region = outer ? arena_.And(*outer, own) : own;
        f.region_text = outer ? fmt::format("({}) and ({})", outer_text, text) : text;
      }
      const auto holds = Holds(id, sources);
      if (!holds) break;
      if (*holds) {
        for (size_t b = 0; b < threads; ++b) {
          if (before[b].region) continue;
          inference_.found.push_back(
              {before[b].span, graph_.Names(graph_[id].threads[b]), graph_[id].facts[b].region_text});
        }
        return;
      }
    }
    Fail(id, before, 0, "the regions that samples suggest cannot be proved");
  }

  // The motion of an obligation "the region of `a: M()`".
  static std::string MotionOf(const Source& source) {
    const std::string& title = source.obligation.title;
    return title.substr(std::min(title.find('`'), title.size()));
  }

  void Fail(NodeId id, const std::vector<ThreadFacts>& before, size_t thread, const std::string& why) {
    graph_[id].facts = before;
    inference_.failed.push_back({before[thread].span, why});
  }

  // The motions of each thread: what would have to keep to a region, if it had one.
  std::vector<Source> SourcesOf(NodeId id) {
    Graph marked = graph_;
    std::vector<TermId> marks;
    for (size_t b = 0; b < marked[id].facts.size(); ++b) {
      const TermId number = arena_.Number(arena_.Real(), Rational(1'000'000 + static_cast<int64_t>(b)));
      marks.push_back(arena_.Lt(graph_.world->point[0], number));
      marked.nodes[id.index()].facts[b].region = marks.back();
    }
    for (const NodeId inner : Below(id)) {
      for (ThreadFacts& f : marked.nodes[inner.index()].facts) f.region.reset();
    }
    std::vector<Source> sources;
    for (Obligation& o : ObligationsOf(marked, arena_).all) {
      if (o.kind != ObligationKind::kRegion) continue;
      const auto mark = std::ranges::find(marks, o.meeting->where, [&](TermId m) { return arena_.Not(m); });
      if (mark == marks.end()) continue;
      sources.push_back({static_cast<size_t>(mark - marks.begin()), std::move(o), {}, {}});
    }
    return sources;
  }

  // The forks within the threads of a fork.
  std::vector<NodeId> Below(NodeId id) const {
    std::vector<NodeId> forks;
    std::set<NodeId> seen{graph_[id].join};
    std::vector<NodeId> todo = graph_[id].next;
    while (!todo.empty()) {
      const NodeId n = todo.back();
      todo.pop_back();
      if (!seen.insert(n).second) continue;
      if (graph_[n].kind == NodeKind::kFork) forks.push_back(n);
      todo.insert(todo.end(), graph_[n].next.begin(), graph_[n].next.end());
    }
    return forks;
  }

  bool Prepare(Source& source, std::mt19937_64& random) {
    robot::Meeting alone = *source.obligation.meeting;
    alone.where = arena_.True();
    const auto pieces = robot::PiecesOf(arena_, graph_.world->point, alone, 400);
    if (!pieces) return false;
    for (const robot::Piece& piece : *pieces) {
      const auto solid =
          std::ranges::find_if(piece, [](const robot::Set& s) { return s.kind == robot::SetKind::kSolid; });
      if (solid == piece.end()) return false;
      source.solids.push_back(*solid);
    }
    const Sampler sampler(arena_, alone.configuration);
    for (size_t i = 0; i < kSamples; ++i) {
      if (auto state = sampler.Draw(random, i == 0 ? 2000 : 50)) source.states.push_back(std::move(*state));
    }
    if (!source.states.empty()) return true;
    // Too thin for chance: one state by the solver.
    solve::Query query;
    query.arena = &arena_;
    query.assertions = {{alone.configuration, ""}};
    solve::Budget budget;
    budget.time = std::chrono::milliseconds(1000);
    const solve::Answer answer = solve::icp::IcpSolver(options_.engine).Check(query, budget, options_.stop);
    if (std::holds_alternative<solve::Unsat>(answer)) return true;  // it never happens
    if (!std::holds_alternative<solve::Sat>(answer)) return false;
    source.states.push_back(PointOf(answer));
    return true;
  }

  // Solids into slabs, along their axes: what leans takes up less space so.
  void Cut(Source& source) {
    std::vector<robot::Set> slabs;
    for (const robot::Set& set : source.solids) {
      const auto axis = set.solid.kind == robot::ShapeKind::kBox      ? 4
                        : set.solid.kind == robot::ShapeKind::kPrism  ? 0
                        : set.solid.kind == robot::ShapeKind::kSphere ? -1
                                                                      : 1;
      if (axis < 0) {
        slabs.push_back(set);
        continue;
      }
      const TermId low = set.solid.sizes[static_cast<size_t>(axis)];
      const TermId high = set.solid.sizes[static_cast<size_t>(axis) + 1];
      const auto at = [&](int k) {
        const TermId share = arena_.Number(arena_.Real(), Rational(k) / Rational(kSlabs));
        return arena_.Add(low, arena_.Mul(share, arena_.Sub(high, low)));
      };
      for (int k = 0; k < kSlabs; ++k) {
        robot::Set slab = set;
        slab.solid.sizes[static_cast<size_t>(axis)] = at(k);
        slab.solid.sizes[static_cast<size_t>(axis) + 1] = at(k + 1);
        slabs.push_back(std::move(slab));
      }
    }
    source.solids = std::move(slabs);
  }

  void AddItems(const Source& source, size_t index, std::vector<Extent>& items) {
    std::vector<Extent> own(source.solids.size());
    for (const Numeric::Point& state : source.states) {
      Numeric numeric(arena_, state);
      for (size_t k = 0; k < source.solids.size(); ++k) {
        const robot::NumericSet set = robot::Evaluate(arena_, source.solids[k], numeric);
        Extent::Moment m;
        for (size_t d = 0; d < kDirections.size(); ++d) {
          const Eigen::Vector3d n(kDirections[d][0], kDirections[d][1], kDirections[d][2]);
          m.most[d] = n.dot(set.FarthestAlong(n));
          m.least[d] = n.dot(set.FarthestAlong(-n));
        }
        own[k].moments.push_back(m);
      }
    }
    for (Extent& item : own) {
      if (item.moments.empty()) continue;
      item.thread = source.thread;
      item.source = index;
      items.push_back(std::move(item));
    }
  }

  TermId ToTerm(const std::vector<Cell>& cells) {
    std::vector<TermId> any;
    for (const Cell& cell : cells) {
      std::vector<TermId> all;
      for (const Side& s : cell) {
        std::vector<TermId> sum;
        for (size_t i = 0; i < 3; ++i) {
          const int c = kDirections[s.direction][i];
          if (c != 0)
            sum.push_back(arena_.Mul(arena_.Number(arena_.Real(), Rational(c)), graph_.world->point[i]));
        }
        // The number that the text has.
        const auto tenths = static_cast<int64_t>(std::llround(s.offset * 10'000));
        const TermId offset = arena_.Number(arena_.Real(), Rational(tenths) / Rational(10'000));
        const TermId along = arena_.Add(sum);
        all.push_back(s.below ? arena_.Lt(along, offset) : arena_.Lt(offset, along));
      }
      any.push_back(arena_.And(all));
    }
    return arena_.Or(any);
  }

  // Does every motion keep to its region? States in which one does not are samples from now on. Nothing if
  // that cannot be told.
  std::optional<bool> Holds(NodeId id, std::vector<Source>& sources) {
    bool holds = true;
    for (Source& s : sources) {
      Obligation o = s.obligation;
      o.meeting->where = expr::Complement(arena_, *graph_[id].facts[s.thread].region);
      Limits limits = options_.limits;
      limits.certificates = false;
      limits.time = std::min(limits.time, kPatience);
      const Decision d = Decide(o, *graph_.world, arena_, options_.engine, limits, stop_);
      if (d.verdict == verdict::Verdict::kProved) continue;
      if (d.witness.values.empty() || stop_.StopRequested()) return std::nullopt;
      holds = false;
      s.states.push_back(d.witness.values);
    }
    return holds;
  }

  Graph& graph_;
  Arena& arena_;
  const InferOptions& options_;
  base::StopToken stop_;
  Inference inference_;
};

}  // namespace

Inference InferRegions(Graph& graph, Arena& arena, const InferOptions& options) {
  return Inferring(graph, arena, options).Run();
}

}  // namespace rondo::choreo
