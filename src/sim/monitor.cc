#include "sim/monitor.h"

#include <fmt/format.h>

#include <algorithm>

#include "koord/check/spec_labels.h"

namespace rondo::sim {

using diag::Kind;
using koord::semantics::FormulaCode;
using koord::semantics::PromiseCode;
using koord::semantics::Word;

Monitor::Monitor(koord::semantics::Team& team, diag::Diagnostics& diagnostics, Report report)
    : team_(team),
      diagnostics_(diagnostics),
      report_(std::move(report)),
      responses_(team),
      waits_(responses_.words()) {}

void Monitor::Violated(double time, const std::string& what, int robot, diag::Span span, Kind kind) {
  const auto it = std::find_if(violations_.begin(), violations_.end(),
                               [&](const Violation& v) { return v.what == what && v.robot == robot; });
  if (it != violations_.end()) {
    ++it->count;
    report_(*it, false);
    return;
  }
  const bool first = std::none_of(violations_.begin(), violations_.end(),
                                  [&](const Violation& v) { return v.what == what; });
  violations_.push_back({what, robot, time, 1});
  if (first) {
    const std::string who = robot < 0 ? "" : fmt::format(" by robot {}", robot);
    diagnostics_.Report(kind, span, fmt::format("{} was violated at t = {:.6g} s{}", what, time, who));
  }
  report_(violations_.back(), true);
}

void Monitor::Formula(double time, const FormulaCode& formula, const std::string& kind, Kind what) {
  for (size_t r = 0; r < (formula.per_robot ? team_.robots() : 1); ++r) {
    if (team_.machine().RunFormula(formula.entry, r)) continue;
    Violated(time, fmt::format("{} `{}`", kind, formula.name), formula.per_robot ? static_cast<int>(r) : -1,
             formula.span, what);
  }
}

void Monitor::Initially(std::span<Word> state) {
  team_.machine().SetMemory(state.data());
  for (const FormulaCode& f : team_.facts()) Formula(0, f, "assumption", Kind::kKoordAssumptionBroken);
  for (const FormulaCode& f : team_.initially()) Formula(0, f, "assumption", Kind::kKoordAssumptionBroken);
  for (const FormulaCode& f : team_.port_facts()) Formula(0, f, "assumption", Kind::kKoordAssumptionBroken);
  for (const FormulaCode& f : team_.invariants()) Formula(0, f, "invariant", Kind::kKoordViolated);
}

void Monitor::Settled(double time, std::span<Word> state, bool between_rounds) {
  team_.machine().SetMemory(state.data());
  for (const FormulaCode& f : team_.invariants()) {
    if (!f.at_rounds || between_rounds) Formula(time, f, "invariant", Kind::kKoordViolated);
  }
}

void Monitor::Between(double time, std::span<Word> state) {
  if (responses_.empty()) return;
  size_t robot = 0;
  const int late = responses_.Observe(state, waits_, &robot);
  if (late < 0) return;
  const koord::semantics::ResponseCode& response = team_.responses()[static_cast<size_t>(late)];
  Violated(time, fmt::format("response `{}`", response.name), static_cast<int>(robot), response.span,
           Kind::kKoordViolated);
}

void Monitor::During(double time, std::span<Word> state, std::span<const Word> settled, bool between_rounds) {
  koord::semantics::Machine& machine = team_.machine();
  machine.SetMemory(state.data(), settled.data());
  for (const FormulaCode& f : team_.port_facts())
    Formula(time, f, "assumption", Kind::kKoordAssumptionBroken);
  // Formulas only read.
  auto* const before = const_cast<Word*>(settled.data());  // NOLINT
  for (const PromiseCode& p : team_.promises()) {
    if (p.at_end && !between_rounds) continue;
    for (size_t r = 0; r < team_.robots(); ++r) {
      machine.SetMemory(before);
      if (p.when != 0 && !machine.RunFormula(p.when, r)) continue;
      machine.SetMemory(state.data(), settled.data());
      if (machine.RunFormula(p.always, r)) continue;
      Violated(time, fmt::format("assumption `{}`", p.name), static_cast<int>(r), p.span,
               Kind::kKoordAssumptionBroken);
    }
  }
  Settled(time, state, between_rounds);
}

void Monitor::Model(double time, const std::string& what, size_t robot, diag::Span span) {
  Violated(time, what, static_cast<int>(robot), span, Kind::kKoordAssumptionBroken);
}

void Monitor::Summary(double time) {
  const int s = team_.machine().violated_summary();
  if (s < 0) return;
  team_.machine().ForgetSummary();
  const koord::SummaryDef& def = *team_.model().summaries[static_cast<size_t>(s)];
  Violated(time, fmt::format("summary `{}`", def.function), -1, def.span, Kind::kKoordSummaryBroken);
}

}  // namespace rondo::sim
