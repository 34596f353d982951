#include "solve/icp/icp_solver.h"

#include <fmt/format.h>

#include <algorithm>

#include "solve/icp/prepare/periods.h"
#include "solve/icp/prepare/proof.h"
#include "solve/icp/search.h"
#include "solve/icp/verify.h"

namespace rondo::solve::icp {
namespace {

/// Decides one lowered query by cases.
class Decision {
 public:
  Decision(Lowered& lowered, const Options& options, const base::StopToken& stop, Statistics& statistics,
           Proof* proof)
      : lowered_(lowered),
        arena_(lowered.arena),
        options_(options),
        stop_(stop),
        statistics_(statistics),
        proof_(proof) {
    search_.record_tree = proof != nullptr;
    search_.jobs = options.jobs;
    search_.precision = options.precision;
    search_.stop = stop;
    search_.kernels = options.kernels != nullptr ? options.kernels : &interval::BestKernels();
  }

  enum class Status : uint8_t { kUnsat, kSat, kUndecided, kGaveUp };

  // False if there is no solution; else the box is what contraction leaves of everything.
  bool Enclose() {
    const Prepared prepared = Prepare(arena_, lowered_.variables, lowered_.conjuncts, {});
    if (prepared.contradiction) return false;
    const Tape tape = BuildTape(arena_, lowered_.variables, prepared);
    const auto box = ContractRoot(tape, *search_.kernels);
    if (box) Report(*box, tape, prepared);
    return box.has_value();
  }

  Status Run() { return Decide(lowered_.conjuncts, {}); }

  const Solution& solution() const { return solution_; }
  const std::map<TermId, interval::Interval>& box() const { return box_; }

 private:
  using Definitions = std::vector<std::pair<TermId, TermId>>;

  Status Decide(std::vector<TermId> conjuncts, const Definitions& definitions) {
    if (stop_.StopRequested()) return Status::kGaveUp;
    Prepared prepared = Prepare(arena_, lowered_.variables, std::move(conjuncts), definitions, proof_, stop_);
    if (!prepared.contradiction) BoundAngles(arena_, lowered_.variables, prepared, proof_);
    if (prepared.contradiction) {
      ++statistics_.exact;
      if (proof_ != nullptr) proof_->Contradiction();
      return Status::kUnsat;
    }
    ++statistics_.cases;
    const bool split = !prepared.disjunctions.empty();
    const bool links = options_.lemmas && !split;
    Attempt attempt{prepared, {}};
    if (options_.lemmas) AddRotations(arena_, attempt.rotated, false, stop_);
    SearchResult result = Try(attempt, prepared,
                              links   ? std::min(options_.boxes_before_links, options_.max_boxes)
                              : split ? kBoxesBeforeCases
                                      : options_.max_boxes);
    if (links && result.kind == SearchResult::Kind::kGaveUp && !stop_.StopRequested()) {
      Attempt linked{prepared, {}};
      if (AddRotations(arena_, linked.rotated, true, stop_)) attempt = std::move(linked);
      result = Try(attempt, prepared, options_.max_boxes);
    }
    const Prepared& rotated = attempt.rotated;
    const Tape& tape = attempt.tape;
    switch (result.kind) {
      case SearchResult::Kind::kEmpty:
        if (proof_ != nullptr) WriteSearch(rotated, tape, result.tree);
        return Status::kUnsat;
      case SearchResult::Kind::kPoint:
        return Status::kSat;
      case SearchResult::Kind::kUndecided:
      case SearchResult::Kind::kGaveUp:
        break;
    }
    if (split) return Cases(prepared);
    if (result.kind == SearchResult::Kind::kGaveUp) return Status::kGaveUp;
    Report(result.box, tape, prepared);
    return Status::kUndecided;
  }

  // What one search is about.
  struct Attempt {
    Prepared rotated;
    Tape tape;
  };

  SearchResult Try(Attempt& attempt, const Prepared& prepared, uint64_t max_boxes) {
    attempt.tape = BuildTape(arena_, lowered_.variables, attempt.rotated);
    statistics_.nodes = std::max(statistics_.nodes, attempt.tape.nodes.size());
    statistics_.variables = std::max(statistics_.variables, attempt.tape.variables.size());
    Verifier verifier(lowered_, prepared, attempt.tape, *search_.kernels);
    search_.verify = [&](const std::vector<double>& point) {
      auto solution = verifier.Verify(point);
      if (solution) solution_ = std::move(*solution);
      return solution.has_value();
    };
    search_.max_boxes = max_boxes;
    SearchResult result = Search(attempt.tape, search_);
    statistics_.boxes += result.boxes;
    return result;
  }

  // The box, and what it leaves to the variables that were eliminated.
  void Report(const FlatBox& box, const Tape& tape, const Prepared& prepared) {
    box_.clear();
    const Assignment nothing;
    PointChecker checker(arena_, nothing);
    for (size_t v = 0; v < tape.variables.size(); ++v) {
      const interval::Interval range{box[2 * v], box[2 * v + 1]};
      box_.emplace(tape.variables[v].term, range);
      checker.Widen(tape.variables[v].term, range);
    }
    for (const auto& [variable, term] : prepared.definitions) box_.emplace(variable, checker.Enclosure(term));
  }

  void WriteSearch(const Prepared& prepared, const Tape& tape, const std::vector<TreeNode>& tree) {
    for (const TermId c : Conjuncts(arena_, prepared)) proof_->Fact(Normalised(arena_, c));
    for (const Lemma& l : prepared.lemmas) proof_->Identity(l.parts, l.constant);
    std::vector<TermId> variables;
    for (const TapeVariable& v : tape.variables) variables.push_back(v.term);
    std::string text;
    std::vector<uint32_t> open{0};
    while (!open.empty()) {
      const TreeNode node = open.back() < tree.size() ? tree[open.back()] : TreeNode{};
      open.pop_back();
      if (!text.empty()) text += text.size() % 100 < 90 ? " " : "\n";
      if (node.first_child == 0) {
        text += ".";
        continue;
      }
      text += fmt::format("{} {}", node.variable, node.value);
      open.insert(open.end(), {node.first_child + 1, node.first_child});
    }
    proof_->Search(variables, text);
  }

  // One of the alternatives of one disjunction must hold.
  Status Cases(const Prepared& prepared) {
    const auto smallest =
        std::min_element(prepared.disjunctions.begin(), prepared.disjunctions.end(),
                         [&](TermId a, TermId b) { return arena_.args(a).size() < arena_.args(b).size(); });
    std::vector<TermId> rest = Conjuncts(arena_, prepared);
    std::erase(rest, *smallest);
    const auto args = arena_.args(*smallest);
    const std::vector<TermId> alternatives(args.begin(), args.end());
    Status status = Status::kUnsat;
    if (proof_ != nullptr) proof_->Cases(*smallest);
    for (const TermId alternative : alternatives) {
      if (proof_ != nullptr) proof_->Case(alternative);
      std::vector<TermId> conjuncts = rest;
      conjuncts.push_back(alternative);
      const Status s = Decide(std::move(conjuncts), prepared.definitions);
      if (s == Status::kSat) return s;
      if (s == Status::kGaveUp || status == Status::kUnsat) status = s;
      if (s == Status::kGaveUp && stop_.StopRequested()) return s;
    }
    if (proof_ != nullptr) proof_->End();
    return status;
  }

  static constexpr uint64_t kBoxesBeforeCases = 256;
  Lowered& lowered_;
  expr::Arena& arena_;
  const Options& options_;
  const base::StopToken& stop_;
  Statistics& statistics_;
  Proof* proof_;
  SearchOptions search_;
  Solution solution_;
  std::map<TermId, interval::Interval> box_;
};

Value ToValue(const Query& query, const Variable& variable, const Rational& number) {
  switch (variable.kind) {
    case Variable::Kind::kReal:
    case Variable::Kind::kInt:
      return Value{number};
    case Variable::Kind::kBool:
      return Value{number > Rational(0)};
    case Variable::Kind::kEnum: {
      const expr::Sort& sort = query.arena->sort(query.arena->sort_of(variable.source));
      return Value{sort.names.at(static_cast<size_t>(number.ToDouble()))};
    }
  }
  return Value{number};
}

}  // namespace

namespace {

Box ToBox(const std::map<TermId, interval::Interval>& ranges, const Lowered& lowered) {
  Box box;
  for (const auto& [variable, range] : ranges) {
    const auto known = lowered.variables.find(variable);
    if (known == lowered.variables.end() || range.IsEmpty()) continue;
    box.emplace(known->second.source, std::pair(range.lo, range.hi));
  }
  return box;
}

}  // namespace

std::optional<Box> IcpSolver::Enclose(const Query& query) const {
  Lowered lowered;
  Lower(query, lowered);
  if (!lowered.unsupported.empty()) return std::nullopt;
  Statistics statistics;
  Decision decision(lowered, options_, {}, statistics, nullptr);
  if (!decision.Enclose()) return std::nullopt;
  return ToBox(decision.box(), lowered);
}

Answer IcpSolver::Check(const Query& query, const Budget& budget, const base::StopToken& stop) const {
  Statistics statistics;
  return Check(query, budget, stop, statistics);
}

Answer IcpSolver::Check(const Query& query, const Budget& budget, const base::StopToken& stop,
                        Statistics& statistics) const {
  Lowered lowered;
  Lower(query, lowered);
  if (!lowered.unsupported.empty())
    return Unknown{fmt::format("no interval arithmetic for {}", lowered.unsupported)};
  const base::StopToken limited = stop.WithDeadline(base::StopToken::Clock::now() + budget.time);
  std::optional<Proof> proof;
  if (budget.certificate) proof.emplace(lowered);
  Decision decision(lowered, options_, limited, statistics, proof ? &*proof : nullptr);
  switch (decision.Run()) {
    case Decision::Status::kUnsat: {
      Unsat unsat;
      for (const Assertion& a : query.assertions) {
        if (!a.group.empty()) unsat.core.push_back(a.group);
      }
      if (proof) unsat.certificate = ToSmtLib(query, expr::SmtFunctions::kNamed) + proof->text();
      std::sort(unsat.core.begin(), unsat.core.end());
      unsat.core.erase(std::unique(unsat.core.begin(), unsat.core.end()), unsat.core.end());
      return unsat;
    }
    case Decision::Status::kSat: {
      Sat sat;
      sat.exact = decision.solution().exact;
      for (const auto& [term, number] : decision.solution().values) {
        const Variable& variable = lowered.variables.at(term);
        sat.values.emplace(variable.source, ToValue(query, variable, number));
      }
      return sat;
    }
    case Decision::Status::kUndecided: {
      Box box = ToBox(decision.box(), lowered);
      double width = 0;
      for (const auto& [variable, range] : box) width = std::max(width, range.second - range.first);
      // Of what was eliminated, nothing is known where its definition may have no value.
      for (const auto& [variable, range] : decision.box()) {
        if (range.IsEmpty()) width = std::numeric_limits<double>::infinity();
      }
      // Not a small box: far away, doubles are too coarse.
      if (!(width <= options_.widest))
        return Unknown{fmt::format("nothing could be excluded in a box of width {}", width)};
      return DeltaSat{std::move(box)};
    }
    case Decision::Status::kGaveUp:
      break;
  }
  if (stop.cancelled()) return Unknown{"interrupted"};
  return Unknown{fmt::format("undecided after {} boxes", statistics.boxes)};
}

}  // namespace rondo::solve::icp
