#include "solve/icp/icp_solver.h"

#include <fmt/format.h>

#include <algorithm>

#include "expr/substitute.h"
#include "solve/icp/contractor.h"
#include "solve/icp/point.h"
#include "solve/icp/proof.h"
#include "solve/icp/search.h"

namespace rondo::solve::icp {
namespace {

using expr::Op;

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

  Status Run() { return Decide(lowered_.conjuncts, {}); }

  const Assignment& model() const { return model_; }
  bool exact() const { return exact_; }
  const FlatBox& box() const { return box_; }
  const std::vector<TermId>& box_variables() const { return box_variables_; }

 private:
  using Definitions = std::vector<std::pair<TermId, TermId>>;

  Status Decide(std::vector<TermId> conjuncts, const Definitions& definitions) {
    if (stop_.StopRequested()) return Status::kGaveUp;
    const Prepared prepared = Prepare(arena_, lowered_.variables, std::move(conjuncts), definitions, proof_);
    if (prepared.contradiction) {
      ++statistics_.exact;
      if (proof_ != nullptr) proof_->Contradiction();
      return Status::kUnsat;
    }
    Prepared rotated = prepared;
    if (options_.lemmas) AddRotations(arena_, rotated);
    const Tape tape = BuildTape(arena_, lowered_.variables, rotated);
    statistics_.nodes = std::max(statistics_.nodes, tape.nodes.size());
    statistics_.variables = std::max(statistics_.variables, tape.variables.size());
    ++statistics_.cases;
    search_.verify_box = [&](const FlatBox& box) { return VerifyBox(prepared, tape, box); };
    search_.verify = [&](const std::vector<double>& point) { return Verify(prepared, tape, point); };
    const bool split = !prepared.disjunctions.empty();
    search_.max_boxes = split ? kBoxesBeforeCases : options_.max_boxes;
    SearchResult result = Search(tape, search_);
    statistics_.boxes += result.boxes;
    switch (result.kind) {
      case SearchResult::Kind::kEmpty:
        if (proof_ != nullptr) WriteSearch(rotated, tape, result.tree);
        return Status::kUnsat;
      case SearchResult::Kind::kPoint:
      case SearchResult::Kind::kBox:
        return Status::kSat;
      case SearchResult::Kind::kUndecided:
      case SearchResult::Kind::kGaveUp:
        break;
    }
    if (split) return Cases(prepared);
    if (result.kind == SearchResult::Kind::kGaveUp) return Status::kGaveUp;
    box_ = result.box;
    box_variables_.clear();
    for (const TapeVariable& v : tape.variables) box_variables_.push_back(v.term);
    return Status::kUndecided;
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

  // A number that satisfies the bounds of a variable, `value` if that does.
  static Rational Within(const Range& range, const Rational& value) {
    const bool below = range.lo && (value < *range.lo || (range.lo_strict && value == *range.lo));
    const bool above = range.hi && (value > *range.hi || (range.hi_strict && value == *range.hi));
    if (!below && !above) return value;
    if (range.lo && range.hi && (range.lo_strict || range.hi_strict))
      return (*range.lo + *range.hi) / Rational(2);
    if (below) return range.lo_strict ? *range.lo + Rational(1) : *range.lo;
    return range.hi_strict ? *range.hi - Rational(1) : *range.hi;
  }

  Assignment AssignmentOf(const Prepared& prepared, const Tape& tape, const std::vector<double>& point) {
    Assignment assignment;
    for (const auto& [term, variable] : lowered_.variables) assignment.emplace(term, Rational(0));
    for (size_t v = 0; v < point.size(); ++v)
      assignment[tape.variables[v].term] = Rational::FromDouble(point[v]);
    for (const auto& [term, range] : prepared.ranges) {
      if (lowered_.variables.contains(term)) assignment[term] = Within(range, assignment[term]);
    }
    return assignment;
  }

  // Adds the values of eliminated variables. Are all exact? nullopt if one has no value: its equation does
  // not hold.
  std::optional<bool> Complete(const Prepared& prepared, PointChecker& checker, Assignment& assignment) {
    bool exact = true;
    for (const auto& [variable, definition] : prepared.definitions) {
      const interval::Interval near = checker.Enclosure(definition);
      if (near.IsEmpty()) return std::nullopt;
      const auto value = checker.Exact(definition);
      exact = exact && value.has_value();
      assignment[variable] = value ? *value : Rational::FromDouble(near.Middle());
    }
    return exact;
  }

  bool Verify(const Prepared& prepared, const Tape& tape, const std::vector<double>& point) {
    const Assignment assignment = AssignmentOf(prepared, tape, point);
    PointChecker checker(arena_, assignment);
    Assignment full = assignment;
    const std::optional<bool> exact = Complete(prepared, checker, full);
    if (!exact) return false;
    // The query itself, if all values are rational; else what was derived from it.
    bool good = true;
    if (*exact) {
      PointChecker original(arena_, full);
      for (const TermId c : lowered_.conjuncts) good = good && original.Check(c) == Truth::kTrue;
    } else {
      for (const TermId c : Conjuncts(arena_, prepared)) good = good && checker.Check(c) == Truth::kTrue;
    }
    if (!good) return false;
    model_ = std::move(full);
    exact_ = *exact;
    return true;
  }

  // One equation f = c, all else being inequalities that hold around the box: if f - c changes its sign
  // between two points, it vanishes between them (f is continuous where it is defined).
  bool VerifyBox(const Prepared& prepared, const Tape& tape, const FlatBox& box) {
    std::vector<double> middle(tape.variables.size());
    for (size_t v = 0; v < middle.size(); ++v)
      middle[v] = interval::Interval{box[2 * v], box[2 * v + 1]}.Middle();
    if (Verify(prepared, tape, middle)) return true;
    std::optional<std::pair<TermId, Rational>> equation;
    std::vector<TermId> others = prepared.disjunctions;
    for (const auto& [term, range] : prepared.ranges) {
      for (const Literal& literal : range.Literals(term)) {
        if (literal.relation != kEqual) {
          others.push_back(ToFormula(arena_, literal));
        } else if (equation) {
          return false;
        } else {
          equation = {term, literal.bound};
        }
      }
    }
    if (!equation || HasJumps(equation->first)) return false;
    const interval::Interval target = Enclose(equation->second);
    for (size_t v = 0; v < middle.size(); ++v) {
      if (tape.variables[v].integral) continue;
      for (const double step : {1e-8, 1e-6, 1e-4}) {
        const interval::Interval segment{middle[v] - step, middle[v] + step};
        const auto value_at = [&](double x) {
          std::vector<double> point = middle;
          point[v] = x;
          const Assignment assignment = AssignmentOf(prepared, tape, point);
          PointChecker checker(arena_, assignment);
          checker.Widen(tape.variables[v].term, interval::Interval::Point(x));
          return checker.Enclosure(equation->first);
        };
        const interval::Interval a = value_at(segment.lo);
        const interval::Interval b = value_at(segment.hi);
        if (a.IsEmpty() || b.IsEmpty()) continue;
        if (!(a.hi < target.lo && b.lo > target.hi) && !(a.lo > target.hi && b.hi < target.lo)) continue;
        Assignment assignment = AssignmentOf(prepared, tape, middle);
        PointChecker around(arena_, assignment);
        around.Widen(tape.variables[v].term, segment);
        bool good = !around.Enclosure(equation->first).IsEmpty();
        for (const TermId c : others) good = good && around.Check(c) == Truth::kTrue;
        if (!good) continue;
        if (!Complete(prepared, around, assignment)) continue;
        model_ = std::move(assignment);
        exact_ = false;
        return true;
      }
    }
    return false;
  }

  // Does something occur that is not continuous where it is defined?
  bool HasJumps(TermId term) {
    std::unordered_set<TermId> seen;
    bool jumps = false;
    expr::VisitPostorder(arena_, term, seen, [&](TermId t) {
      jumps = jumps || arena_.op(t) == Op::kIte || arena_.op(t) == Op::kDivide ||
              (arena_.op(t) == Op::kElementary && (arena_.elementary_of(t) == expr::Elementary::kAtan2 ||
                                                   arena_.elementary_of(t) == expr::Elementary::kTan));
    });
    return jumps;
  }

  static constexpr uint64_t kBoxesBeforeCases = 256;
  Lowered& lowered_;
  expr::Arena& arena_;
  const Options& options_;
  const base::StopToken& stop_;
  Statistics& statistics_;
  Proof* proof_;
  SearchOptions search_;
  Assignment model_;
  bool exact_ = true;
  FlatBox box_;
  std::vector<TermId> box_variables_;
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
      sat.exact = decision.exact();
      for (const auto& [term, number] : decision.model()) {
        const Variable& variable = lowered.variables.at(term);
        sat.values.emplace(variable.source, ToValue(query, variable, number));
      }
      return sat;
    }
    case Decision::Status::kUndecided: {
      DeltaSat delta;
      for (size_t v = 0; v < decision.box_variables().size(); ++v) {
        delta.box.emplace(lowered.variables.at(decision.box_variables()[v]).source,
                          std::pair(decision.box()[2 * v], decision.box()[2 * v + 1]));
      }
      return delta;
    }
    case Decision::Status::kGaveUp:
      break;
  }
  if (stop.cancelled()) return Unknown{"interrupted"};
  return Unknown{fmt::format("undecided after {} boxes", statistics.boxes)};
}

}  // namespace rondo::solve::icp
