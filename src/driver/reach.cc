#include "driver/reach.h"

#include <fmt/format.h>

#include <algorithm>

#include "driver/run_file.h"
#include "koord/prove/witness_replay.h"

namespace rondo::driver {
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

}  // namespace

std::vector<Reached> SearchWitnesses(const koord::Model& model, koord::Report& report, uint32_t rounds,
                                     const std::string& file, const std::string& spec,
                                     const ExplorationOptions& given, diag::Diagnostics& diagnostics) {
  std::vector<Reached> result;
  for (koord::Row& row : report.rows) {
    if (row.verdict != koord::Verdict::kNotInductive || !row.witness) continue;
    ExplorationOptions options = given;
    options.rounds = rounds;
    options.only = static_cast<size_t>(&row - report.rows.data());  // rows are invariants, in their order
    Adopt(model, *row.witness, options);
    const auto robots = static_cast<size_t>(row.witness->robots);
    diag::Diagnostics found;
    const Explored explored = Explore(model, robots, options, found);
    Reached reached{row.name, {}, {}, explored.property == "invariant " + row.name};
    const std::string scope = fmt::format("N = {}", robots);
    if (explored.unusable) {
      reached.text = fmt::format("{}: cannot be explored: {}", row.name,
                                 found.all().empty() ? std::string("no reason") : found.all()[0].message);
    } else if (reached.found) {
      // Over real numbers, a run in which doubles were rounded may not exist.
      if (!explored.rounded) row.verdict = koord::Verdict::kRefuted;
      for (const diag::Diagnostic& d : found.all()) {
        if (d.kind != diag::Kind::kKoordViolated) continue;
        auto& told = diagnostics.Report(d.kind, d.span, d.message);
        told.label = d.label;
        told.notes = d.notes;
      }
      const std::string path = DefaultRunFile(file, explored.property);
      RunFile run{file, spec, robots, explored.property, "prove --reach", explored.run};
      KeepParameters(run, model, {robots, options.params, options.choices, {}});
      if (SaveRun(path, run).ok()) reached.run = path;
      reached.text = fmt::format("{}: reachable for {}{}{}", row.name, scope,
                                 explored.rounded ? ", where doubles are rounded" : "",
                                 reached.run.empty() ? "" : fmt::format(": `rondo replay {}`", reached.run));
    } else if (explored.broken) {
      reached.text = fmt::format("{}: another property breaks first: {}", row.name, explored.property);
    } else if (explored.search.ending == explore::Ending::kComplete) {
      reached.text = fmt::format(
          "{}: no run violates it for {} with these values ({} states): a further invariant "
          "may exclude the state",
          row.name, scope, explored.search.states);
    } else {
      reached.text = fmt::format("{}: no run of up to {} rounds violates it for {} ({} states{})", row.name,
                                 rounds, scope, explored.search.states,
                                 explored.search.ending == explore::Ending::kDepth ? "" : ", cut off");
    }
    result.push_back(std::move(reached));
  }
  return result;
}

}  // namespace rondo::driver
