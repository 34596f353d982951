#include "choreo/prove/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ranges>
#include <set>

#include "robot/contact/contact.h"
#include "verdict/verdict.h"

namespace rondo::choreo {
namespace {

using diag::Kind;

Kind KindOf(ObligationKind kind) {
  switch (kind) {
    case ObligationKind::kHull:
    case ObligationKind::kBody:
      return Kind::kChoreoFootprint;
    case ObligationKind::kInitial:
    case ObligationKind::kCollision:
    case ObligationKind::kObstacle:
      return Kind::kChoreoCollision;
    case ObligationKind::kPrecondition:
      return Kind::kChoreoPrecondition;
    case ObligationKind::kRegion:
    case ObligationKind::kFork:
      return Kind::kChoreoRegion;
    case ObligationKind::kAssumption:
    case ObligationKind::kGuarantee:
    case ObligationKind::kThread:
      return Kind::kChoreoAssumption;
    case ObligationKind::kTotalChoice:
      return Kind::kChoreoNoAlternative;
    case ObligationKind::kMessage:
      return Kind::kChoreoPromise;
    case ObligationKind::kContract:
    case ObligationKind::kKeeping:
    case ObligationKind::kInterrupted:
    case ObligationKind::kStart:
      return Kind::kChoreoContract;
    case ObligationKind::kReached:
      return Kind::kChoreoNever;
    case ObligationKind::kProcess:
      return Kind::kProcessCondition;
  }
  return Kind::kChoreoContract;
}

std::string_view HelpFor(ObligationKind kind) {
  switch (kind) {
    case ObligationKind::kHull:
      return "make the hull larger: it has to contain the body in every state";
    case ObligationKind::kBody:
      return "make the footprint larger: it has to contain the body all the time";
    case ObligationKind::kInitial:
      return "say in `initially` where they stand, or put them elsewhere in the world";
    case ObligationKind::kCollision:
      return "let one of them wait, or say more in `during` of its motion about where it is";
    case ObligationKind::kObstacle:
      return "go another way, or say more in `during` of the motion about where the robot is";
    case ObligationKind::kPrecondition:
      return "begin where the motion before has ended, or weaken `pre`";
    case ObligationKind::kRegion:
      return "make the region larger, or say more in `during` of the motion";
    case ObligationKind::kFork:
      return "regions of threads have no point in common; such as only touch are apart if one of them is open: `z < 10 cm` and `z >= "
             "10 cm`";
    case ObligationKind::kAssumption:
      return "another robot of this step has to promise it in `during`, without assumptions of its own";
    case ObligationKind::kGuarantee:
      return "say more in `during` of the motion, or guarantee less";
    case ObligationKind::kThread:
      return "another thread has to guarantee it";
    case ObligationKind::kTotalChoice:
      return "add an alternative, such as one without a guard behind the others";
    case ObligationKind::kMessage:
      return "send what the refinement promises, or promise less";
    case ObligationKind::kContract:
      return "a contract that nothing can keep would prove everything";
    case ObligationKind::kKeeping:
      return "let `during` say where the robot is at each moment, without gaps: `x == linear(clock, ...)`";
    case ObligationKind::kInterrupted:
      return "a message may come at any moment: say in `during` what `post` promises";
    case ObligationKind::kProcess:
      return "say so in the process: check it before, or use the values of the choreography";
    case ObligationKind::kReached:
    case ObligationKind::kStart:
      break;
  }
  return "";
}

std::string Quantity(double value, lang::Dimension dimension) {
  const auto number = [](double v) {
    std::string text = fmt::format("{:.4g}", std::abs(v) < 5e-7 ? 0.0 : v);
    return text;
  };
  if (dimension == robot::kAngle) return number(value * 180 / std::numbers::pi) + " deg";
  const std::string unit = robot::UnitText(dimension);
  return unit == "a number" ? number(value) : number(value) + " " + unit;
}

// The way there: what is decided on it, in order.
void ShowTurns(const Proof& proof, diag::Diagnostic& report) {
  for (size_t t = 0; t < proof.turns.size(); ++t)
    report.At(proof.turns[t].span, fmt::format("on the way there ({}): {}", t + 1, proof.turns[t].what));
}

void Explain(const Graph& graph, const Obligation& o, const Witness& witness, diag::Diagnostic& report) {
  if (witness.values.empty()) return;
  const auto clock = witness.values.find(graph.world->clock);
  std::string where = PlaceOf(graph, witness);
  if (!where.empty()) where = "at the point " + where;
  const bool moving = NodeOf(o).valid() && graph[NodeOf(o)].kind == NodeKind::kMotion &&
                      o.kind != ObligationKind::kPrecondition && o.kind != ObligationKind::kStart;
  if (moving && clock != witness.values.end()) {
    where = fmt::format("{}{} s after the step has begun", where.empty() ? "" : where + ", ",
                        fmt::format("{:.4g}", clock->second));
  }
  if (!where.empty()) report.Note(where);
  const auto state = StateOf(graph, witness);
  if (!state.empty())
    report.Note(fmt::format("in the state {}{}", fmt::join(state, ", "), witness.exact ? "" : " (nearly)"));
}

}  // namespace

std::vector<std::string> StateOf(const Graph& graph, const Witness& witness) {
  std::vector<std::string> state;
  const auto show = [&](const std::string& owner, const robot::Variable& v) {
    const auto it = witness.values.find(v.term);
    if (it == witness.values.end() || !std::isfinite(it->second)) return;
    state.push_back(fmt::format("{}.{} = {}", owner, v.name.text, Quantity(it->second, v.dimension)));
  };
  for (const robot::Body& body : graph.world->bodies) {
    for (const auto& v : body.states) show(body.name.text, v);
    for (const auto& v : body.inputs) show(body.name.text, v);
  }
  for (const auto& v : graph.world->environment) show("environment", v);
  return state;
}

std::string PlaceOf(const Graph& graph, const Witness& witness) {
  std::array<double, 3> at{};
  for (size_t i = 0; i < 3; ++i) {
    const auto it = witness.values.find(graph.world->point[i]);
    if (it == witness.values.end()) return "";
    at[i] = it->second;
  }
  return fmt::format("({}, {}, {})", Quantity(at[0], robot::kLength), Quantity(at[1], robot::kLength),
                     Quantity(at[2], robot::kLength));
}

void ConfirmWitnesses(const Obligations& obligations, expr::Arena& arena, Proofs& proofs) {
  constexpr double kTolerance = 1e-6;  // whatever a formula compares
  constexpr double kContact = 1e-4;    // metres: FCL is not exact
  for (size_t i = 0; i < obligations.all.size(); ++i) {
    const Obligation& o = obligations.all[i];
    Proof& proof = proofs.all[i];
    const Witness& witness = proof.decision.witness;
    if (o.keeping || proof.decision.verdict != verdict::Verdict::kRefuted || witness.values.empty()) continue;
    const auto deny = [&](const std::string& why) {
      proofs.bug = true;
      proofs.problems.push_back(fmt::format("the witness of \"{}\" is not confirmed: {}", o.failure, why));
    };
    const auto variables = robot::VariablesOf(arena, {o.formula});
    const bool complete =
        std::ranges::all_of(variables, [&](expr::TermId v) { return witness.values.contains(v); });
    if (complete) {
      const double miss = expr::Numeric(arena, witness.values).Violation(o.formula);
      if (!(miss <= kTolerance)) deny(fmt::format("the formula fails by {:.3g} there", miss));
    }
    if (!o.meeting || o.meeting->shapes.size() != 2) continue;
    const auto contact =
        robot::FindContact(arena, o.meeting->shapes[0], o.meeting->shapes[1], witness.values);
    if (!contact) continue;
    proof.confirmed = contact->touches || contact->distance <= kContact;
    if (!proof.confirmed) deny(fmt::format("FCL sees a distance of {:.3g} m", contact->distance));
  }
}

void ReportProofs(const Graph& graph, const Obligations& obligations, const Proofs& proofs,
                  diag::Diagnostics& diagnostics) {
  for (const Missing& m : obligations.missing) {
    diagnostics.Report(Kind::kChoreoMissing, m.span, fmt::format("nothing can be proved without {}", m.what));
  }
  for (size_t i = 0; i < obligations.all.size(); ++i) {
    const Obligation& o = obligations.all[i];
    const Decision& d = proofs.all[i].decision;
    if (d.verdict == verdict::Verdict::kProved || o.kind == ObligationKind::kStart) continue;
    // A motion that begins where it must not often cannot begin there either: that is one mistake.
    const auto follows = [&](size_t j) {
      const Obligation& p = obligations.all[j];
      // Nor can a contract be kept that contradicts itself.
      const bool own = o.keeping && p.kind == ObligationKind::kContract && p.nodes.empty() &&
                       !p.instances.empty() &&
                       std::ranges::find(o.instances, p.instances[0]) != o.instances.end();
      if (own) return verdict::Fails(proofs.all[j].decision.verdict);
      return p.kind == ObligationKind::kPrecondition && p.nodes == o.nodes &&
             (o.keeping || p.instances == o.instances) && verdict::Fails(proofs.all[j].decision.verdict);
    };
    if ((o.kind == ObligationKind::kContract || o.keeping) && !o.nodes.empty() &&
        std::ranges::any_of(std::views::iota(size_t{0}, obligations.all.size()), follows))
      continue;
    if (d.verdict == verdict::Verdict::kNotInductive) {
      diag::Diagnostic& report = diagnostics.Report(Kind::kChoreoNotInductive, o.span, o.failure);
      Explain(graph, o, d.witness, report);
      const size_t rounds = proofs.all[i].rounds;
      report.Note(rounds == 0 ? "no run was found that breaks it"
                              : fmt::format("no run breaks it that goes through each loop {} at most",
                                            rounds == 1 ? "once" : fmt::format("{} times", rounds)));
      report.Help(
          "where ways meet, only what all of them have in common is known: let `post` of the motions before, or a "
          "guard, say what holds here");
      continue;
    }
    if (d.verdict == verdict::Verdict::kRefuted) {
      diag::Diagnostic& report = diagnostics.Report(KindOf(o.kind), o.span, o.failure);
      if (!d.reason.empty()) report.Note(d.reason);
      Explain(graph, o, d.witness, report);
      ShowTurns(proofs.all[i], report);
      if (proofs.all[i].confirmed) report.Note("FCL finds them in contact there, too");
      if (const auto help = HelpFor(o.kind); !help.empty()) report.Help(std::string(help));
      continue;
    }
    // What was interrupted is counted, and said once for all.
    if (!IsRequired(o.kind) || proofs.all[i].interrupted) continue;
    diag::Diagnostic& report =
        diagnostics.Report(Kind::kChoreoUnknown, o.span, fmt::format("not decided: {}", o.title));
    report.Note(d.reason);
    if (d.apart > 0) {
      report.Note(fmt::format("where it came closest, the distance is at least {:.3g} m", d.apart));
    } else if (d.apart < 0 && d.apart > -1e9) {
      report.Note(fmt::format("where it came closest, the shapes overlap by {:.3g} m, as far as can be seen",
                              -d.apart));
    }
    Explain(graph, o, d.witness, report);
    report.Help(o.keeping ? std::string(HelpFor(o.kind))
                          : "give it more time with `--timeout`, or leave more space");
  }
}

std::vector<std::string> AssumptionsOf(const Graph& graph, const std::set<std::string>& proved,
                                       const Obligations& obligations, const Proofs& proofs) {
  std::vector<std::string> result;
  std::set<std::string> motions;
  for (const Instance& i : graph.instances)
    motions.insert(fmt::format("{}.{}", graph.BodyOf(i.robot).type->name.text, i.motion->name.text));
  std::erase_if(motions, [&](const std::string& m) { return proved.contains(m); });
  if (!motions.empty())
    result.push_back(fmt::format("controllers keep the contracts of {}", fmt::join(motions, ", ")));
  std::set<std::string> ranges;
  for (const robot::Body& b : graph.world->bodies) {
    for (const auto& v : b.states) {
      if (v.least || v.most) ranges.insert(fmt::format("{}.{}", b.type->name.text, v.name.text));
    }
    for (const auto& v : b.inputs) {
      if (v.least || v.most) ranges.insert(fmt::format("{}.{}", b.type->name.text, v.name.text));
    }
  }
  for (const auto& v : graph.world->environment) ranges.insert(v.name.text);
  if (!ranges.empty())
    result.push_back(fmt::format("these stay in their ranges: {}", fmt::join(ranges, ", ")));
  if (graph.initially.valid()) result.push_back("`initially` holds when it begins");
  if (graph.equal_durations)
    result.push_back(
        "motions of one step that cannot be interrupted end at the same moment (equal_durations)");
  for (size_t i = 0; i < obligations.all.size(); ++i) {
    if (obligations.all[i].kind == ObligationKind::kStart && !proofs.all[i].interrupted &&
        proofs.all[i].decision.verdict != verdict::Verdict::kProved)
      result.push_back(obligations.all[i].failure);
  }
  return result;
}

}  // namespace rondo::choreo
