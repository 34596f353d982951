#include "runs/witness_search.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/counted.h"
#include "koord/prove/witness_replay.h"
#include "runs/run_file.h"
#include "verdict/verdict.h"
#include "workspace/places.h"

namespace rondo::runs {
namespace {

// Parameters as in the counterexample; sensors and what has no initial value take any of its values.
void Adopt(const koord::Model& model, const koord::WitnessState& witness, ExplorationOptions& options) {
  for (const auto& value : witness.values) {
    const koord::Variable& variable = model.variables[value.variable];
    std::vector<koord::semantics::Word> words;
    if (!koord::ToWords(model.types, variable.type, value.start, words)) continue;
    if (variable.kind == koord::VariableKind::kParam) {
      if (!model.exploration.values.contains(value.variable)) options.params[value.variable] = words;
      continue;
    }
    std::vector<koord::semantics::Word>& choices = options.choices[value.variable];
    const auto add = [&](const std::vector<koord::semantics::Word>& item) {
      for (size_t i = 0; i < choices.size(); i += item.size()) {
        if (std::equal(item.begin(), item.end(), choices.begin() + static_cast<ptrdiff_t>(i))) return;
      }
      choices.insert(choices.end(), item.begin(), item.end());
    };
    add(words);
    words.clear();
    if (variable.kind == koord::VariableKind::kSensor && value.end &&
        koord::ToWords(model.types, variable.type, *value.end, words))
      add(words);
  }
}

/// Searches the runs of one team for one that violates an invariant.
class Search {
 public:
  Search(const koord::Model& model, const ReachRequest& request, diag::Diagnostics& diagnostics)
      : model_(model), request_(request), diagnostics_(diagnostics) {}

  Reached NotInductive(koord::Row& row, size_t invariant) {
    ExplorationOptions options = Options(invariant, request_.rounds.value_or(kRounds));
    Adopt(model_, *row.witness, options);
    const auto robots = static_cast<size_t>(row.witness->robots);
    Reached reached = One(row, robots, options);
    if (!reached.text.empty()) return reached;
    reached.text = Nothing(row.name, fmt::format("N = {}", robots), options);
    if (last_.search.ending == explore::Ending::kComplete)
      reached.text = fmt::format(
          "{}: no run violates it for N = {} with these values ({} states): a further invariant may exclude the state",
          row.name, robots, last_.search.states);
    return reached;
  }

  // Teams of one to three robots, or of as many as were asked about.
  Reached Undecided(koord::Row& row, size_t invariant) {
    ExplorationOptions options = Options(invariant, request_.rounds.value_or(kRounds));
    if (!request_.rounds) {
      options.states = kStates;
      options.stop = options.stop.WithDeadline(base::StopToken::Clock::now() + kTime);
    }
    const size_t first = request_.robots.value_or(1);
    const size_t most = request_.robots.value_or(kTeam);
    size_t searched = 0;
    for (size_t robots = first; robots <= most && !options.stop.StopRequested(); ++robots) {
      Reached reached = One(row, robots, options);
      if (!reached.text.empty()) return reached;
      const explore::Ending ending = last_.search.ending;
      if (ending != explore::Ending::kComplete && ending != explore::Ending::kDepth) break;
      searched = robots;
    }
    Reached reached{row.name, {}, {}, false};
    if (searched == 0) {
      reached.text = fmt::format("{}: {} rounds of {} are too many runs to look at", row.name,
                                 *options.rounds, base::Counted(first, "robot"));
    } else {
      const std::string scope =
          first == searched ? fmt::format("N = {}", searched) : fmt::format("N <= {}", searched);
      reached.text = Nothing(row.name, scope, options);
    }
    return reached;
  }

 private:
  static constexpr uint32_t kRounds = 6;
  static constexpr size_t kTeam = 3;
  static constexpr uint64_t kStates = 300'000;
  static constexpr std::chrono::milliseconds kTime{700};

  ExplorationOptions Options(size_t invariant, uint32_t rounds) const {
    ExplorationOptions options = request_.exploration;
    options.rounds = rounds;
    options.only = invariant;
    return options;
  }

  std::string Nothing(const std::string& name, const std::string& scope,
                      const ExplorationOptions& options) const {
    return fmt::format(
        "{}: no run of up to {} rounds violates it for {} ({} states{})", name, *options.rounds, scope,
        states_,
        last_.search.ending == explore::Ending::kDepth || last_.search.ending == explore::Ending::kComplete
            ? ""
            : ", cut off");
  }

  // Without text: nothing was found.
  Reached One(koord::Row& row, size_t robots, const ExplorationOptions& options) {
    diag::Diagnostics found;
    last_ = Explore(model_, robots, options, found);
    states_ += last_.search.states;
    Reached reached{row.name, {}, {}, last_.property == "invariant " + row.name};
    if (last_.unusable) {
      reached.text = fmt::format("{}: runs cannot be searched: {}", row.name,
                                 found.all().empty() ? std::string("no reason") : found.all()[0].message);
    } else if (reached.found) {
      Found(row, robots, options, found, reached);
    } else if (last_.broken) {
      reached.text = fmt::format("{}: another property breaks first: {}", row.name, last_.property);
    }
    return reached;
  }

  void Found(koord::Row& row, size_t robots, const ExplorationOptions& options,
             const diag::Diagnostics& found, Reached& reached) {
    // Over real numbers, a run in which doubles were rounded may not exist.
    if (!last_.rounded) {
      row.verdict = verdict::Verdict::kRefuted;
      row.because.clear();
    }
    for (const diag::Diagnostic& d : found.all()) {
      if (d.kind != diag::Kind::kKoordViolated) continue;
      auto& told = diagnostics_.Report(d.kind, d.span, d.message);
      told.label = d.label;
      told.notes = d.notes;
    }
    const std::string path = workspace::DefaultRunFile(request_.file, last_.property);
    RunFile run{request_.file, request_.spec, robots, last_.property, "prove --reach", last_.run};
    KeepParameters(run, model_, {robots, options.params, options.choices, {}});
    if (SaveRun(path, run).ok()) reached.run = path;
    reached.text = fmt::format("{}: reachable for N = {}{}{}", row.name, robots,
                               last_.rounded ? ", where doubles are rounded" : "",
                               reached.run.empty() ? "" : fmt::format(": `rondo replay {}`", reached.run));
  }

  const koord::Model& model_;
  const ReachRequest& request_;
  diag::Diagnostics& diagnostics_;
  Explored last_;
  uint64_t states_ = 0;
};

}  // namespace

std::vector<Reached> SearchWitnesses(const koord::Model& model, koord::Report& report,
                                     const ReachRequest& request, diag::Diagnostics& diagnostics) {
  std::vector<Reached> result;
  for (size_t i = 0; i < model.invariants.size() && i < report.rows.size(); ++i) {
    koord::Row& row = report.rows[i];
    Search search(model, request, diagnostics);
    if (row.verdict == verdict::Verdict::kNotInductive && row.witness && request.rounds)
      result.push_back(search.NotInductive(row, i));
    if (row.verdict == verdict::Verdict::kUnknown && !report.interrupted && !report.contradiction &&
        !report.disagreement)
      result.push_back(search.Undecided(row, i));
  }
  return result;
}

}  // namespace rondo::runs
