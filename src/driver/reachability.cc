#include "driver/reachability.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "driver/exit_status.h"
#include "koord/reach/port_problem.h"
#include "lang/suggest.h"
#include "robot/reach/symmetry.h"

namespace rondo::driver {

using diag::Kind;

namespace {

std::string StateTable(const ContractResult& r, const std::vector<double>& state) {
  std::string text;
  for (size_t i = 0; i < state.size(); ++i) {
    if (r.made.names[i] == "clock") continue;
    text += fmt::format("{}{} = {:.6g}", text.empty() ? "" : ", ", r.made.names[i], state[i]);
  }
  return text;
}

const reach::Problem& ProblemOf(const ContractResult& r) { return r.made.problem; }

}  // namespace

std::vector<ContractResult> ContractsOf(Motion& motion, bool reduce, std::string_view keep,
                                        std::vector<std::string>* left_out) {
  std::vector<ContractResult> all;
  const choreo::Graph* of = nullptr;
  const auto add = [&](const robot::World& world, const robot::Body& body,
                       const robot::MotionInstance& instance) {
    ContractResult result;
    result.span = instance.motion->name.span;
    result.graph = of;
    result.motion = fmt::format("{}.{}", body.type->name.text, instance.motion->name.text);
    auto problem = robot::ProblemOf(world, body, instance, motion.arena);
    result.made.problem.name = fmt::format("{}: {}", body.name.text, instance.text);
    if (problem.ok()) {
      result.made = std::move(problem).value();
    } else {
      result.impossible = problem.error().message;
    }
    if (reduce && result.impossible.empty()) {
      if (auto reduced = robot::WithoutPlace(world, body, instance, motion.declarations->evaluator(), keep)) {
        result.anywhere = std::move(reduced->parameters);
        result.at_zero = std::move(reduced->anywhere);
        if (reduced->made) result.made = std::move(*reduced->made);
      }
    }
    all.push_back(std::move(result));
  };
  for (const choreo::Graph& graph : motion.graphs) {
    of = &graph;
    for (const choreo::Instance& i : graph.instances) {
      robot::MotionInstance instance;
      instance.text = i.text;
      instance.motion = i.motion;
      instance.arguments = i.args;
      instance.contract = i.contract;
      instance.control = i.control;
      instance.duration = i.duration.most;
      instance.least = i.duration.least;
      instance.interruptible = i.duration.interruptible;
      add(*graph.world, graph.BodyOf(i.robot), instance);
    }
  }
  if (!motion.graphs.empty()) return all;
  for (const choreo::Item& item : motion.module.items) {
    const auto* type = std::get_if<robot::RobotDef>(&item);
    if (type == nullptr) continue;
    auto world = std::make_shared<robot::World>();
    for (const robot::MotionInstance& i :
         robot::MotionsOf(*type, motion.declarations->evaluator(), *world, left_out))
      add(*world, world->bodies[0], i);
  }
  return all;
}

std::vector<ContractResult> PortContractsOf(const LoadedKoord& koord, Platforms& platforms, Session& session,
                                            const robot::Loose* loose) {
  std::vector<ContractResult> all;
  for (const koord::PlatformDef* platform : koord.model.platforms) {
    const std::filesystem::path beside = session.sources.path(platform->span.file);
    const std::string file = (beside.parent_path() / platform->file).lexically_normal().string();
    if (std::error_code error; !std::filesystem::is_regular_file(file, error)) {
      session.diagnostics
          .Report(Kind::kChoreoImport, platform->file_span, fmt::format("there is no file `{}`", file))
          .Help("paths are relative to the specification");
      continue;
    }
    auto motion = LoadMotion({file}, {}, session, loose);
    if (motion == nullptr || motion->declarations == nullptr) continue;
    const robot::RobotDef* type = nullptr;
    std::vector<std::string> names;
    for (const choreo::Item& item : motion->module.items) {
      const auto* def = std::get_if<robot::RobotDef>(&item);
      if (def == nullptr) continue;
      names.push_back(def->name.text);
      if (def->name.text == platform->type) type = def;
    }
    auto world = std::make_unique<robot::World>();
    if (type == nullptr || !robot::StandAlone(*type, motion->declarations->evaluator(), *world)) {
      auto& report = session.diagnostics.Report(
          Kind::kChoreoUndeclared, platform->file_span,
          type == nullptr ? fmt::format("there is no robot type `{}` in `{}`", platform->type, file)
                          : fmt::format("`{}` has parameters without a value", platform->type));
      if (const std::string near = lang::Suggest(platform->type, names); type == nullptr && !near.empty())
        report.Help(fmt::format("did you mean `{}`?", near));
      continue;
    }
    for (koord::PortProblem& p : koord::PortProblems(koord.model, *platform, *world, world->bodies[0],
                                                     motion->arena, session.diagnostics, loose)) {
      ContractResult result;
      result.span = p.assumption->span;
      result.made = std::move(p.made);
      result.made.problem.name = p.name;
      result.impossible = std::move(p.impossible);
      result.domain = std::move(p.domain);
      result.model = platform->type;
      all.push_back(std::move(result));
    }
    platforms.files.push_back(std::move(motion));
    platforms.worlds.push_back(std::move(world));
  }
  return all;
}

bool LoadContracts(const std::vector<std::string>& files, const std::string& spec, const robot::Loose* loose,
                   bool reduce, Session& session, LoadedContracts& loaded) {
  if (files.size() == 1 && !IsMotionFile(files[0])) {
    loaded.koord = LoadKoord({files[0], spec}, session);
    if (loaded.koord == nullptr) return false;
    loaded.results = PortContractsOf(*loaded.koord, loaded.platforms, session, loose);
  } else {
    loaded.motion = LoadMotion(files, {}, session, loose);
    if (loaded.motion == nullptr || loaded.motion->declarations == nullptr ||
        session.diagnostics.has_errors())
      return false;
    loaded.results =
        ContractsOf(*loaded.motion, reduce, loose == nullptr ? "" : loose->name, &loaded.left_out);
  }
  return !session.diagnostics.has_errors();
}

void DecideContract(ContractResult& r, const DecideOptions& options, const base::StopToken& stop) {
  if (!r.impossible.empty() || stop.cancelled()) return;
  reach::ProverOptions prover;
  prover.jobs = options.jobs;
  prover.seed = options.seed;
  prover.progress = options.progress;
  const auto begin = std::chrono::steady_clock::now();
  const base::StopToken limited =
      stop.WithDeadline(begin + std::chrono::milliseconds(static_cast<int64_t>(options.timeout * 1000)));
  auto outcome = reach::Decide(r.made.problem, prover, limited);
  r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (outcome.ok()) {
    r.outcome = std::move(outcome).value();
    auto* open = std::get_if<reach::Undecided>(&*r.outcome);
    if (open != nullptr && open->reason == "stopped" && !stop.cancelled())
      open->reason = "out of time (--timeout)";
  } else {
    r.impossible = outcome.error().message;
  }
}

std::string_view VerdictOf(const ContractResult& r) {
  if (!r.impossible.empty()) return "unknown";
  if (!r.same_as.empty()) return "proved";
  if (!r.outcome) return "not begun";
  if (std::holds_alternative<reach::Proved>(*r.outcome)) return "proved";
  if (std::holds_alternative<reach::Refuted>(*r.outcome)) return "refuted";
  return "unknown";
}

int StatusOf(const ContractResult& r) {
  const std::string_view verdict = VerdictOf(r);
  return verdict == "proved" ? kEstablished : verdict == "refuted" ? kRejected : kUndecided;
}

void ReportContract(const ContractResult& r, diag::Diagnostics& diagnostics) {
  const std::string& name = ProblemOf(r).name;
  if (!r.impossible.empty()) {
    diagnostics
        .Report(Kind::kReachUnknown, r.span, fmt::format("the contract of `{}` cannot be analysed", name))
        .Note(r.impossible);
    return;
  }
  if (!r.outcome) return;
  if (const auto* refuted = std::get_if<reach::Refuted>(&*r.outcome)) {
    const reach::Violation& v = refuted->violation;
    const std::string& claim = ProblemOf(r).claims[v.claim].name;
    auto& report = diagnostics.Report(
        Kind::kReachRefuted, r.span,
        fmt::format("`{}` breaks its contract: `{}` fails after {:.4g} s", name, claim, v.time));
    report.Note(fmt::format("start: {}", StateTable(r, refuted->course.start)));
    report.Note(fmt::format("there:  {}", StateTable(r, v.state)));
    report.Note(v.miss < 1e299 ? fmt::format("it fails by {:.3g}", v.miss)
                               : std::string("a term of it has no value there"));
    report.Note(refuted->certain
                    ? "the exact solution from this start was enclosed: it does break the contract"
                    : "a simulation, not enclosed: rounding could matter");
    return;
  }
  if (const auto* open = std::get_if<reach::Undecided>(&*r.outcome)) {
    auto& report = diagnostics.Report(
        Kind::kReachUnknown, r.span, fmt::format("the contract of `{}` is neither proved nor refuted", name));
    report.Note(open->reason);
    if (open->closest) {
      report.Note(fmt::format(
          "closest approach of the sampled trajectories: `{}` held by {:.3g} after {:.4g} s",
          ProblemOf(r).claims[open->closest->claim].name, -open->closest->miss, open->closest->time));
    }
  }
}

std::string ContractTable(const std::vector<ContractResult>& results) {
  std::string text =
      fmt::format("{:<9} {:>9} {:>9} {:>6}  {}\n", "verdict", "time", "certified", "parts", "contract");
  std::string rejected;
  for (const ContractResult& r : results) {
    std::string parts;
    if (r.outcome) {
      if (const auto* proved = std::get_if<reach::Proved>(&*r.outcome))
        parts = fmt::format("{}", proved->leaves.size());
    }
    std::string note = r.same_as.empty() ? "" : fmt::format(" (as {})", r.same_as);
    if (!r.anywhere.empty() && r.graph == nullptr && VerdictOf(r) == "proved")
      note += fmt::format(" (whatever {})", fmt::join(r.anywhere, ", "));
    const std::string certified = r.IsCertified() ? fmt::format("{:.3f} s", r.certify_seconds)
                                  : r.certified   ? "no"
                                                  : "";
    text += fmt::format("{:<9} {:>9} {:>9} {:>6}  {}{}\n", VerdictOf(r), fmt::format("{:.3f} s", r.seconds),
                        certified, parts, ProblemOf(r).name, note);
    if (r.certified && !r.IsCertified())
      rejected += fmt::format("not certified: {}: {}\n", ProblemOf(r).name, r.certified->reason);
  }
  return text + rejected;
}

nlohmann::json ToJson(const ContractResult& r) {
  nlohmann::json out{{"contract", ProblemOf(r).name}, {"verdict", VerdictOf(r)}, {"seconds", r.seconds}};
  if (!r.impossible.empty()) out["reason"] = r.impossible;
  if (!r.made.assumed.empty()) out["assumed"] = r.made.assumed;
  if (!r.domain.empty()) out["domain"] = r.domain;
  if (!r.model.empty()) out["model"] = r.model;
  if (!r.same_as.empty()) out["same_as"] = r.same_as;
  if (!r.anywhere.empty()) out["whatever"] = r.anywhere;
  if (r.certified) {
    out["certified"] = r.certified->accepted;
    out["certify_seconds"] = r.certify_seconds;
    if (!r.certified->accepted) out["not_certified"] = r.certified->reason;
  }
  if (!r.outcome) return out;
  if (const auto* proved = std::get_if<reach::Proved>(&*r.outcome)) {
    out["parts"] = proved->leaves.size();
    out["steps"] = proved->steps;
    nlohmann::json final = nlohmann::json::object();
    nlohmann::json extent = nlohmann::json::object();
    for (size_t i = 0; i < r.made.names.size(); ++i) {
      interval::Interval end = interval::Interval::Empty();
      interval::Interval all = end;
      for (const reach::Leaf& leaf : proved->leaves) {
        end = interval::Hull(end, leaf.final[i]);
        for (const reach::TubeSegment& s : leaf.tube) all = interval::Hull(all, s.during[i]);
      }
      final[r.made.names[i]] = {end.lo, end.hi};
      extent[r.made.names[i]] = {all.lo, all.hi};
    }
    out["final"] = final;
    out["range"] = extent;
  } else if (const auto* refuted = std::get_if<reach::Refuted>(&*r.outcome)) {
    out["claim"] = ProblemOf(r).claims[refuted->violation.claim].name;
    out["time"] = refuted->violation.time;
    out["fails_by"] = refuted->violation.miss;
    out["start"] = refuted->course.start;
    out["state"] = refuted->violation.state;
    out["enclosed"] = refuted->certain;
  } else {
    const auto& open = std::get<reach::Undecided>(*r.outcome);
    out["reason"] = open.reason;
    if (open.closest) out["closest"] = {{"held_by", -open.closest->miss}, {"time", open.closest->time}};
  }
  return out;
}

}  // namespace rondo::driver
