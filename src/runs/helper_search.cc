#include "runs/helper_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "base/parallel.h"
#include "koord/prove/witness_replay.h"
#include "runs/helper_literals.h"
#include "workspace/koord_files.h"

namespace rondo::runs {
namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kMostLiterals = 20;
constexpr size_t kMostCandidates = 500;  // that exclude the counterexample, of one size
constexpr size_t kMostTogether = 40;
constexpr int kRounds = 6;

class Search {
 public:
  explicit Search(const HelperRequest& request) : request_(request), end_(Clock::now() + request.budget) {
    prove_ = request.prove;
    prove_.smt_out.clear();
    prove_.cross_check = nullptr;
    // No name of the program's own.
    while ((request.program + request.spec).find(prefix_) != std::string::npos) prefix_ += "_";
  }

  Helpers Run(const koord::Report& given) {
    Program base = Load({});
    if (base.loaded == nullptr) return {{}, false, "the program cannot be read again"};
    asked_ = base.loaded->model.invariants.size();
    Literals(base.loaded->model);
    koord::Report report = given;
    for (int round = 0; round < kRounds; ++round) {
      if (report.AllProved()) return Needed();
      const koord::WitnessState* witness = nullptr;
      for (const koord::Row& row : report.rows) {
        if (row.verdict == verdict::Verdict::kRefuted)
          return {{}, false, "what is refuted no helper can prove"};
        if (row.witness && row.witness->of == koord::WitnessOf::kRound) witness = &*row.witness;
      }
      if (witness == nullptr) return {{}, false, "there is no counterexample to induction to learn from"};
      const koord::WitnessState state = *witness;
      if (!Exclude(state)) return {{}, false, why_};
      report = Prove(accepted_);
    }
    return {{}, false, "still not inductive after several counterexamples"};
  }

 private:
  struct Program {
    workspace::Session session;
    std::unique_ptr<workspace::LoadedKoord> loaded;
  };

  bool Over() {
    if (prove_.stop.cancelled())
      why_ = "interrupted";
    else if (Clock::now() > end_)
      why_ = "no time was left";
    else
      return false;
    return true;
  }

  Program Load(const std::vector<std::string>& more) {
    Program program;
    std::string spec = request_.spec;
    for (size_t i = 0; i < more.size(); ++i)
      spec += fmt::format("\ninvariant {}_{}: {}", prefix_, i + 1, more[i]);
    program.loaded = workspace::LoadKoordTexts(request_.name, request_.program, spec + "\n", program.session);
    return program;
  }

  void Literals(const koord::Model& model) {
    for (const Literal& literal : LiteralsOf(model, kMostLiterals)) {
      // A type that formulas cannot be about, or a name that `i` hides.
      if (Load({"forall i in ID: " + literal.of_i}).loaded != nullptr) literals_.push_back(literal);
    }
    // Places of arrays come behind what says that they are some.
    std::ranges::stable_partition(literals_,
                                  [](const Literal& l) { return l.of_i.find("]]") == std::string::npos; });
  }

  // `p`, or `(p)` if it is more than a name, a comparison or a call.
  static std::string InBrackets(const std::string& text) {
    for (const char* word : {" and ", " or ", " implies ", " if ", ": "}) {
      if (text.find(word) != std::string::npos) return "(" + text + ")";
    }
    return text;
  }

  // Clauses of so many literals, with either sign each.
  std::vector<std::string> Clauses(size_t size) const {
    std::vector<std::string> clauses;
    const auto add = [&](const std::vector<size_t>& chosen) {
      for (size_t signs = 0; signs < size_t{1} << chosen.size(); ++signs) {
        std::string given, then;
        for (size_t k = 0; k < chosen.size(); ++k) {
          std::string& side = (signs >> k & 1) != 0 ? given : then;
          const bool first = side.empty();
          side += fmt::format("{}{}",
                              first             ? ""
                              : &side == &given ? " and "
                                                : " or ",
                              InBrackets(literals_[chosen[k]].of_i));
        }
        clauses.push_back("forall i in ID: " + (given.empty()  ? then
                                                : then.empty() ? fmt::format("not ({})", given)
                                                               : fmt::format("{} implies {}", given, then)));
      }
    };
    const size_t n = literals_.size();
    for (size_t a = 0; a < n; ++a) {
      if (size == 1) add({a});
      for (size_t b = a + 1; b < n && size > 1; ++b) {
        if (size == 2) add({a, b});
        for (size_t c = b + 1; c < n && size == 3; ++c) add({a, b, c});
      }
    }
    // Two robots that are not both so.
    for (size_t a = 0; a < n && size == 2; ++a) {
      for (size_t b = 0; b < n; ++b)
        clauses.push_back(fmt::format("forall i, j in ID: i != j and {} implies not {}",
                                      InBrackets(literals_[a].of_i), InBrackets(literals_[b].of_j)));
    }
    return clauses;
  }

  // Finds inductive clauses that are false at the start of the round, and accepts them.
  bool Exclude(const koord::WitnessState& state) {
    bool comparable = false;
    for (size_t size = 1; size <= 3; ++size) {
      if (Over()) return false;
      std::vector<std::string> clauses = Clauses(size);
      Program all = Load(clauses);
      if (all.loaded == nullptr) continue;
      const std::vector<bool> holds = koord::InvariantsAtStart(all.loaded->model, state);
      std::vector<std::string> left;
      for (size_t i = 0; i < clauses.size() && asked_ + i < holds.size(); ++i) {
        comparable = true;
        if (!holds[asked_ + i] && left.size() < kMostCandidates) left.push_back(clauses[i]);
      }
      left = Inductive(left);
      if (left.empty()) continue;
      accepted_.insert(accepted_.end(), left.begin(), left.end());
      return true;
    }
    if (!Over())
      why_ =
          comparable
              ? "no clause of the program's own predicates excludes the counterexample, as far as values such as lists "
                "can be looked at, and is inductive"
              : "the counterexample has values that no run can have";
    return false;
  }

  koord::Report Prove(const std::vector<std::string>& helpers) {
    Program program = Load(helpers);
    diag::Diagnostics ignored;
    return program.loaded == nullptr ? koord::Report{} : koord::Prove(program.loaded->model, prove_, ignored);
  }

  // Is the last of these inductive, given the others and what was asked?
  bool IsInductive(const std::vector<std::string>& helpers) {
    Program program = Load(helpers);
    if (program.loaded == nullptr) return false;
    koord::ProveOptions options = prove_;
    options.quick = true;
    options.timeout = std::min(options.timeout, std::chrono::milliseconds(1000));
    options.jobs = 1;
    options.progress = nullptr;
    diag::Diagnostics ignored;
    const koord::Report report = koord::Prove(program.loaded->model, options, ignored);
    const size_t row = asked_ + helpers.size() - 1;
    return row < report.rows.size() && std::ranges::all_of(report.rows[row].cells, [](const koord::Cell& c) {
             return c.verdict == verdict::Verdict::kProved;
           });
  }

  // Those that are inductive, each by itself, together with what was asked and accepted; else the largest part of the first
  // ones that is as a whole.
  std::vector<std::string> Inductive(const std::vector<std::string>& candidates) {
    std::vector<std::string> alone = Surviving(candidates, {});
    if (!alone.empty() || Over()) return alone;
    std::vector<std::string> left(
        candidates.begin(),
        candidates.begin() + static_cast<ptrdiff_t>(std::min(candidates.size(), kMostTogether)));
    while (!left.empty() && !Over()) {
      std::vector<std::string> next = Surviving(left, left);
      if (next.size() == left.size()) return next;
      left = std::move(next);
    }
    return {};
  }

  std::vector<std::string> Surviving(const std::vector<std::string>& candidates,
                                     const std::vector<std::string>& premises) {
    std::vector<char> good(candidates.size());
    size_t done = 0;
    std::mutex mutex;
    base::ParallelFor(candidates.size(), prove_.jobs, [&](size_t i) {
      if (prove_.stop.cancelled() || Clock::now() > end_) return;
      std::vector<std::string> together = accepted_;
      for (const std::string& p : premises) {
        if (p != candidates[i]) together.push_back(p);
      }
      together.push_back(candidates[i]);
      good[i] = IsInductive(together) ? 1 : 0;
      const std::scoped_lock lock(mutex);
      if (prove_.progress) prove_.progress(++done, candidates.size(), candidates[i]);
    });
    std::vector<std::string> left;
    for (size_t i = 0; i < candidates.size(); ++i) {
      if (good[i] != 0) left.push_back(candidates[i]);
    }
    return left;
  }

  // Leaves out one after the other what the proof does without.
  Helpers Needed() {
    std::vector<std::string> needed = accepted_;
    for (size_t i = needed.size(); i-- > 0 && !Over();) {
      std::vector<std::string> fewer = needed;
      fewer.erase(fewer.begin() + static_cast<ptrdiff_t>(i));
      if (Prove(fewer).AllProved()) needed = std::move(fewer);
    }
    Helpers helpers{{}, true, ""};
    for (size_t i = 0; i < needed.size(); ++i)
      helpers.invariants.push_back(fmt::format("invariant {}_{}: {}", prefix_, i + 1, needed[i]));
    return helpers;
  }

  const HelperRequest& request_;
  Clock::time_point end_;
  koord::ProveOptions prove_;
  std::string prefix_ = "helper";
  size_t asked_ = 0;
  std::vector<Literal> literals_;
  std::vector<std::string> accepted_;
  std::string why_;
};

}  // namespace

Helpers FindHelpers(const HelperRequest& request, const koord::Report& report) {
  return Search(request).Run(report);
}

}  // namespace rondo::runs
