#include "koord/prove/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>

#include "koord/check/spec_labels.h"
#include "verdict/verdict.h"

namespace rondo::koord {

using diag::Kind;
using diag::Span;

namespace {

const char* Describe(CheckKind kind) {
  switch (kind) {
    case CheckKind::kIndex:
      return "this index can be out of range";
    case CheckKind::kDivision:
      return "this divisor can be zero";
    case CheckKind::kRoot:
      return "this root can be of a negative number";
    case CheckKind::kRemove:
      return "the item to remove may not be in the list";
    case CheckKind::kUnrolling:
      return "the list can be longer than its stated bound";
    case CheckKind::kRepeating:
      return "this loop can be repeated more often than it says";
    case CheckKind::kReturn:
      return "this function can end without a value";
    case CheckKind::kChoice:
      return "there may be no value to choose";
  }
  return "";
}

// Does the invariant that stands there count or sum up robots?
bool Counts(const Model& model, Span where) {
  const std::function<bool(ExprId)> in = [&](ExprId id) {
    const lang::Expr& e = model.program->exprs[id];
    if (e.kind == lang::ExprKind::kFold && (e.text == "sum" || e.text == "count")) return true;
    return std::ranges::any_of(e.args, in);
  };
  return std::ranges::any_of(model.invariants, [&](const InvariantDef* def) {
    return model.program->exprs[def->body].span == where && in(def->body);
  });
}

}  // namespace

Span Reporter::SpanOf(const std::string& name) const {
  for (const AssumeDef* def : model_.assumptions) {
    if (AssumptionName(model_, *def) == name) return def->span;
  }
  for (const SummaryDef* def : model_.summaries) {
    if (SummaryName(*def) == name) return def->span;
  }
  for (size_t i = 0; i < model_.invariants.size(); ++i) {
    if ("invariant " + InvariantName(model_, i) == name) return model_.invariants[i]->span;
  }
  return {};
}

void Reporter::Contradiction(const std::string& what, const std::vector<std::string>& core) {
  report_.contradiction = true;
  std::vector<Span> spans;
  for (const std::string& name : core) {
    const Span span = SpanOf(name);
    if (span.file.valid() && std::find(spans.begin(), spans.end(), span) == spans.end())
      spans.push_back(span);
  }
  Span primary = spans.empty() ? Span{} : spans[0];
  if (spans.empty() && !model_.events.empty()) primary = model_.events[0]->span;
  auto& report = diagnostics_.Report(Kind::kKoordContradiction, primary,
                                     "the assumptions contradict each other: " + what);
  if (!spans.empty()) report.Under(core.size() == 1 ? "this cannot be true" : "cannot be true together");
  for (size_t i = 1; i < spans.size(); ++i) report.At(spans[i], "with this");
  report.Help("from a contradiction everything follows: no verdict below counts");
}

void Reporter::NeverEnabled(size_t action, const std::vector<std::string>& core) {
  const EventDef& event = *model_.events[action - 1];
  const Span span = event.pre.valid() ? model_.program->exprs[event.pre].span : event.span;
  auto& report =
      diagnostics_.Report(Kind::kKoordNeverEnabled, span, fmt::format("`{}` can never happen", event.name));
  report.Under("no state that satisfies the invariants makes this true");
  for (const std::string& name : core) {
    if (const Span other = SpanOf(name); other.file.valid()) report.At(other, "excluded by this");
  }
}

void Reporter::Unrealisable(size_t p) {
  if (problems_.promises()[p].def->at_end) return;  // nothing is promised at once
  // Only if a small team shows it with every quantifier in place.
  for (int64_t n = 1; n <= 2; ++n) {
    expr::Arena arena;
    diag::Diagnostics ignored;
    Problems small(arena, model_, {n, true}, ignored);
    const Problem problem = small.PromiseNow(p);
    const solve::Budget budget{std::chrono::milliseconds(1000), false};
    if (!std::holds_alternative<solve::Sat>(options_.solver->Check(problem.Whole(), budget, options_.stop)))
      continue;
    const Theory::Promise promise = problems_.promises()[p];
    diagnostics_
        .Report(Kind::kKoordUnrealisable, promise.def->span,
                fmt::format("`{}` promises at once what need not hold yet", promise.name))
        .Under("its condition can be true while its promise is false")
        .Note(
            "the promise must hold at every moment after the program transition, the first one included;\n"
            "a controller that starts where it is false has broken it already")
        .Help("strengthen the condition, or add an invariant that excludes such a state");
    return;
  }
}

// Two promises that cannot be kept together, although both can be due: from there on, proofs are about nothing.
void Reporter::Excluding() {
  const std::vector<Theory::Promise> promises = problems_.promises();
  const solve::Budget budget{std::chrono::milliseconds(1000), false};
  for (size_t a = 0; a < promises.size(); ++a) {
    for (size_t b = a + 1; b < promises.size(); ++b) {
      if (promises[a].def->module != promises[b].def->module) continue;
      const auto answer = [&](bool kept) {
        return options_.solver->Check(problems_.BothPromises(a, b, kept).query, budget, options_.stop);
      };
      if (!std::holds_alternative<solve::Unsat>(answer(true)) ||
          std::holds_alternative<solve::Unsat>(answer(false)))
        continue;
      diagnostics_
          .Report(Kind::kKoordUnrealisable, promises[a].def->span,
                  fmt::format("`{}` and `{}` exclude each other", promises[a].name, promises[b].name))
          .Under("both can be due at once, and then no controller keeps both")
          .At(promises[b].def->span, "the other one")
          .Note("a proof says nothing of what comes after such a state")
          .Help("weaken a promise, or add an invariant that excludes that both conditions are true");
    }
  }
}

std::string Reporter::Scope() const {
  return options_.robots ? fmt::format("for N = {}", *options_.robots) : "for every N";
}

void Reporter::Failures() {
  if (report_.contradiction || report_.interrupted) return;
  for (size_t i = 0; i < report_.rows.size(); ++i) {
    Row& row = report_.rows[i];
    const auto open = std::find_if(row.cells.begin(), row.cells.end(),
                                   [](const Cell& c) { return c.verdict != verdict::Verdict::kProved; });
    if (open == row.cells.end()) continue;
    if (i < model_.invariants.size()) {
      FailedInvariant(i);
    } else {
      FailedDefinedness(*open, *open->action);
    }
  }
}

// Only the obligation with a witness has failed; the others of its row are as yet undecided.
void Reporter::FailedInvariant(size_t i) {
  Row& row = report_.rows[i];
  const InvariantDef& def = *model_.invariants[i];
  const auto it = witnesses_.find(i);
  const bool confirmed = it != witnesses_.end() && it->second.confirmed;
  const auto open = [](const Cell& c) { return c.verdict != verdict::Verdict::kProved; };
  auto failed = row.cells.end();
  if (confirmed) {
    const auto breaks = [&](const Cell& c) {
      return open(c) && (it->second.state.of == WitnessOf::kCutOff ? c.column == kCutOffColumn
                                                                   : c.action == it->second.action);
    };
    failed = std::find_if(row.cells.begin(), row.cells.end(), breaks);
    // The round may break the invariant by a later action than its first, whose own case is proved.
    if (failed == row.cells.end()) failed = std::find_if(row.cells.begin(), row.cells.end(), open);
  }
  for (auto cell = row.cells.begin(); cell != row.cells.end(); ++cell) {
    if (!open(*cell)) continue;
    cell->verdict = cell == failed ? verdict::Verdict::kRefuted : verdict::Verdict::kUnknown;
    if (cell != failed && cell->reason.empty())
      cell->reason = "a possible counterexample could not be confirmed";
  }
  if (confirmed) {
    Told(row, def, it->second);
    return;
  }
  Undecided(row, *std::find_if(row.cells.begin(), row.cells.end(), open),
            model_.program->exprs[def.body].span, it == witnesses_.end() ? nullptr : &it->second);
}

void Reporter::Told(Row& row, const InvariantDef& def, const Witness& witness) {
  const auto index = static_cast<size_t>(std::find(model_.invariants.begin(), model_.invariants.end(), &def) -
                                         model_.invariants.begin());
  const WitnessReplay replay = ReplayWitness(model_, index, witness.state);
  if (replay.outcome == ReplayOutcome::kDiffers) {
    report_.disagreement = true;
    row.verdict = verdict::Verdict::kUnknown;
    row.because = "the counterexample does not replay: " + replay.why;
    diagnostics_
        .Report(Kind::kKoordDisagreement, def.span,
                fmt::format("the solver's counterexample of `{}` is not a round of the program", row.name))
        .Under(replay.why)
        .Note(witness.table)
        .Help("this is a bug of Rondo's");
    return;
  }
  row.witness = witness.state;
  const Span required = model_.program->exprs[def.body].span;
  const std::string size = fmt::format("N_sys = {}", witness.robots);
  const std::optional<size_t> action = witness.action;
  if (witness.state.of == WitnessOf::kCutOff) return ToldCutOff(row, def, witness, replay);
  if (!action) {
    row.verdict = verdict::Verdict::kRefuted;
    diagnostics_
        .Report(Kind::kKoordRefuted, required, fmt::format("`{}` is false in an initial state", row.name))
        .Under("required here")
        .Note(fmt::format("an initial state that the declarations and assumptions allow ({}):\n{}", size,
                          witness.table))
        .Help("give variables initial values, or state what holds at the start: `assume initially: ...`");
    return;
  }
  row.verdict = witness.reachable ? verdict::Verdict::kRefuted : verdict::Verdict::kNotInductive;
  const Kind kind = witness.reachable ? Kind::kKoordRefuted : Kind::kKoordNotInductive;
  const std::string who =
      *action == 0 ? "the environment" : fmt::format("`{}`", model_.events[*action - 1]->name);
  const Span where = *action == 0 ? required : model_.events[*action - 1]->span;
  auto& report =
      diagnostics_.Report(kind, where,
                          witness.reachable ? fmt::format("{} violates `{}`", who, row.name)
                                            : fmt::format("{} does not preserve `{}`", who, row.name));
  if (*action == 0) {
    report.Under("required at every moment");
  } else {
    report.At(required, "required here");
  }
  report.Note(fmt::format("one round that breaks it, from {} ({}):\n{}",
                          witness.reachable ? "an initial state" : "a state that satisfies every invariant",
                          size, witness.table));
  report.Note(replay.outcome == ReplayOutcome::kReplayed ? "replayed: the program makes this round"
                                                         : "not replayed: " + replay.why);
  if (!witness.reachable)
    report.Note(
        "this state may be unreachable: the induction could not exclude it; `rondo prove --reach 6` looks for a run to it");
  const bool promised = std::ranges::any_of(model_.assumptions,
                                            [](const AssumeDef* a) { return a->kind == AssumeKind::kPort; });
  if (witness.environment && promised && !witness.reachable) {
    report.Help(
        "add an invariant that excludes the state at the start of this round (`rondo prove --helpers` looks for one),\n"
        "or say more of what the controller guarantees");
  } else if (witness.environment) {
    report.Help("say what the controller guarantees: `assume M when ... always ...`");
  } else if (!witness.reachable) {
    report.Help(
        "add an invariant that excludes the state at the start of this round; `rondo prove --helpers` looks for one");
  }
}

void Reporter::ToldCutOff(Row& row, const InvariantDef& def, const Witness& witness,
                          const WitnessReplay& replay) {
  row.verdict = witness.reachable ? verdict::Verdict::kRefuted : verdict::Verdict::kNotInductive;
  auto& report =
      diagnostics_
          .Report(witness.reachable ? Kind::kKoordRefuted : Kind::kKoordNotInductive,
                  model_.program->exprs[def.body].span,
                  fmt::format("a robot that is cut off {} `{}`",
                              witness.reachable ? "violates" : "does not preserve", row.name))
          .Under("required at every moment")
          .Note(fmt::format("one round that breaks it, from {} (N_sys = {}):\n{}",
                            witness.reachable ? "an initial state" : "a state that satisfies every invariant",
                            witness.robots, witness.table));
  for (const FallbackDef* fallback : model_.fallbacks) report.At(fallback->span, "what it does then");
  report.Note(replay.outcome == ReplayOutcome::kReplayed ? "replayed: the program makes this round"
                                                         : "not replayed: " + replay.why);
  report.Note(
      "who is cut off has said what it does, and its actuators may never get it: they hold, or get what the fallback says");
  report.Help("state the invariant of what robots do after all, or let the fallback keep it");
}

void Reporter::FailedDefinedness(Cell& cell, size_t place) {
  Row& row = report_.rows.back();
  // Which operation: ask for each alone, with a team small enough to be sure.
  for (int64_t n = options_.robots.value_or(1); n <= options_.robots.value_or(4) && n <= 8; ++n) {
    expr::Arena arena;
    diag::Diagnostics ignored;
    Problems small(arena, model_, {n, true}, ignored);
    for (int64_t r = 0; r < n; ++r) {
      const TermId robot = arena.IntNumber(r);
      for (const DefinednessCheck& check : small.ChecksAt(place, robot)) {
        const solve::Query query = small.DefinedAt(place, check, robot).Whole();
        const solve::Budget budget{std::min(options_.timeout, std::chrono::milliseconds(2000)), false};
        if (!std::holds_alternative<solve::Sat>(options_.solver->Check(query, budget, options_.stop)))
          continue;
        row.verdict = verdict::Verdict::kNotInductive;
        cell.verdict = verdict::Verdict::kRefuted;
        diagnostics_.Report(Kind::kKoordUndefinedOperation, check.span, Describe(check.kind))
            .Under(fmt::format("for robot {} of {}, in a state that satisfies every invariant", r, n))
            .Help("guard the operation, or add an invariant that excludes the state");
        return;
      }
    }
  }
  Undecided(row, cell, problems_.ChecksOf(place).front().span, nullptr);
}

void Reporter::Undecided(Row& row, const Cell& cell, Span span, const Witness* candidate) {
  row.verdict = verdict::Verdict::kUnknown;
  auto& report = diagnostics_.Report(Kind::kKoordUnknown, span,
                                     fmt::format("`{}` could not be decided {}", row.name, Scope()));
  report.Under(fmt::format("obligation `{}`", cell.column));
  if (candidate != nullptr) {
    report.Note(fmt::format(
        "a possible counterexample (N_sys = {}), not checked against every value that the functions may take:\n"
        "{}",
        candidate->robots, candidate->table));
    report.Help("state more of what the functions and ports guarantee, if this cannot happen");
  } else {
    report.Note(fmt::format("{}: {}", options_.solver->name(), cell.reason));
    if (!options_.robots && Counts(model_, span))
      report.Note(
          "for every N, `count` and `sum` are known as far as at most one robot changes at a time (under one lock), or all change\n"
          "in one direction; else only whether `count` is 0, 1, more, or all");
    // More time helps where time was short; a number, where there is none yet.
    const std::string_view robots = "fix the number of robots (`--robots 3`)";
    if (!options_.robots) {
      report.Help(cell.timed_out ? fmt::format("give it more time (`--timeout 60`), or {}", robots)
                                 : std::string(robots));
    } else if (cell.timed_out) {
      report.Help("give it more time (`--timeout 60`)");
    }
  }
}

// The largest set of invariants whose proofs use only members of the set.
void Reporter::Verdicts() {
  if (report_.contradiction || report_.interrupted || report_.disagreement) {
    for (Row& row : report_.rows) {
      row.verdict = verdict::Verdict::kUnknown;
      row.because = report_.contradiction ? "the assumptions contradict each other"
                    : report_.interrupted ? "interrupted"
                                          : "solvers disagree";
    }
    return;
  }
  std::set<std::string> standing;
  const auto all_proved = [](const Row& row) {
    return std::all_of(row.cells.begin(), row.cells.end(),
                       [](const Cell& c) { return c.verdict == verdict::Verdict::kProved; });
  };
  // What operations mean where they are undefined is open, so a step proof is worth what the row
  // `well-defined` is worth.
  const bool has_defined = report_.rows.size() > model_.invariants.size();
  const std::string defined = "the row `well-defined`";
  for (size_t i = 0; i < report_.rows.size(); ++i) {
    if (all_proved(report_.rows[i]))
      standing.insert(i < model_.invariants.size() ? "invariant " + report_.rows[i].name : defined);
  }
  if (!has_defined) standing.insert(defined);
  std::map<std::string, std::string> fell;
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t i = 0; i < report_.rows.size(); ++i) {
      const Row& row = report_.rows[i];
      const std::string name = i < model_.invariants.size() ? "invariant " + row.name : defined;
      if (!standing.contains(name)) continue;
      std::string missing = standing.contains(defined) ? "" : defined;
      for (const Cell& cell : row.cells) {
        for (const std::string& used : cell.core) {
          if (used.starts_with("invariant ") && !standing.contains(used)) missing = used;
        }
      }
      if (missing.empty()) continue;
      standing.erase(name);
      fell[name] = missing;
      changed = true;
    }
  }
  for (size_t i = 0; i < report_.rows.size(); ++i) {
    Row& row = report_.rows[i];
    const std::string name = i < model_.invariants.size() ? "invariant " + row.name : defined;
    if (standing.contains(name)) {
      row.verdict = verdict::Verdict::kProved;
    } else if (fell.contains(name)) {
      row.verdict = verdict::Verdict::kConditional;
      row.because = fmt::format("its proof uses {}, which is not proved", fell[name]);
    }
  }
}

}  // namespace rondo::koord
