#include "choreo/graph/calls.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "lang/expr_printer.h"

namespace rondo::choreo {

using diag::Kind;
using diag::Span;
using expr::Rational;
using robot::Value;
using robot::ValueKind;

namespace {

std::string Lower(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

// Which parameter each argument is for, or nothing if the motion cannot be called so.
std::optional<std::vector<size_t>> Match(const MotionDef& motion, const MotionCall& call) {
  std::vector<size_t> places;
  std::vector<bool> taken(motion.params.size());
  size_t position = 0;
  for (const Argument& a : call.args) {
    size_t i = position;
    if (!a.name.text.empty()) {
      const auto it =
          std::ranges::find_if(motion.params, [&](const Param& p) { return p.name.text == a.name.text; });
      i = static_cast<size_t>(it - motion.params.begin());
    } else {
      ++position;
    }
    if (i >= motion.params.size() || taken[i]) return std::nullopt;
    taken[i] = true;
    places.push_back(i);
  }
  for (size_t i = 0; i < taken.size(); ++i) {
    if (!taken[i] && !motion.params[i].value.valid()) return std::nullopt;
  }
  return places;
}

}  // namespace

Calls::Calls(Graph& graph, Declarations& declarations, bool loose)
    : graph_(graph), declarations_(declarations), evaluator_(declarations.evaluator()), loose_(loose) {
  for (size_t i = 0; i < graph.instances.size(); ++i) known_.emplace(KeyOf(graph.instances[i]), i);
}

Calls::Key Calls::KeyOf(const Instance& instance) {
  Key key{instance.robot.value, reinterpret_cast<uintptr_t>(instance.motion)};
  for (const Value& v : instance.args) {
    for (const expr::TermId t : v.terms) key.push_back(t.value);
  }
  return key;
}

bool Calls::Named(const MotionDef& motion, const Name& name) const {
  if (!loose_) return motion.name.text == name.text;
  std::string_view text = name.text;
  if (text.starts_with("m_")) text.remove_prefix(2);
  return Lower(motion.name.text) == Lower(text);
}

const MotionDef* Calls::FindMotion(const RobotDef& type, const MotionCall& call) {
  std::vector<std::string> names;
  std::vector<const MotionDef*> candidates;
  for (const RobotItem& item : type.items) {
    const auto* motion = std::get_if<MotionDef>(&item);
    if (motion == nullptr) continue;
    names.push_back(motion->name.text);
    if (!Named(*motion, call.motion)) continue;
    if (Match(*motion, call)) return motion;
    candidates.push_back(motion);
  }
  if (candidates.empty()) {
    declarations_.Undeclared(call.motion, "motion", names, type.name.text);
  } else {
    WrongArguments(call, candidates);
  }
  return nullptr;
}

// Says what is wrong with the one motion of this name; of several, how many arguments they take.
void Calls::WrongArguments(const MotionCall& call, const std::vector<const MotionDef*>& candidates) {
  diag::Diagnostics& diagnostics = evaluator_.diagnostics();
  const MotionDef& motion = *candidates[0];
  if (candidates.size() > 1) {
    auto& report = diagnostics.Report(Kind::kChoreoArity, call.motion.span,
                                      fmt::format("no motion `{}` takes such arguments", motion.name.text));
    for (const MotionDef* m : candidates) report.At(m->span, "declared here");
    return;
  }
  size_t position = 0;
  std::set<std::string> given;
  for (const Argument& a : call.args) {
    const Span span = evaluator_.SpanOf(a.value);
    if (a.name.text.empty()) {
      if (position >= motion.params.size()) {
        diagnostics
            .Report(Kind::kChoreoArity, span,
                    fmt::format("`{}` takes {} argument{}", motion.name.text, motion.params.size(),
                                motion.params.size() == 1 ? "" : "s"))
            .At(motion.name.span, "declared here");
        return;
      }
      given.insert(motion.params[position++].name.text);
      continue;
    }
    std::vector<std::string> names;
    for (const Param& p : motion.params) names.push_back(p.name.text);
    if (std::ranges::find(names, a.name.text) == names.end()) {
      declarations_.Undeclared(a.name, "parameter", names, motion.name.text);
    } else if (!given.insert(a.name.text).second) {
      diagnostics.Report(Kind::kChoreoArity, a.name.span, fmt::format("`{}` is given twice", a.name.text));
    }
  }
  for (const Param& p : motion.params) {
    if (given.contains(p.name.text) || p.value.valid()) continue;
    diagnostics
        .Report(Kind::kChoreoArity, call.motion.span,
                fmt::format("`{}` needs a value for `{}`", motion.name.text, p.name.text))
        .At(p.name.span, "declared here, without a default");
  }
}

std::string Calls::TextOf(const MotionDef& motion, const MotionCall& call) const {
  std::string args;
  for (const Argument& a : call.args) {
    args += args.empty() ? "" : ", ";
    if (!a.name.text.empty()) args += a.name.text + " = ";
    args += lang::PrintExpr(evaluator_.pool(), a.value);
  }
  return fmt::format("{}({})", motion.name.text, args);
}

std::optional<size_t> Calls::Resolve(RobotId robot, const MotionCall& call, const robot::Scope& scope) {
  const robot::Body& body = graph_.BodyOf(robot);
  if (body.type == nullptr) return std::nullopt;
  const MotionDef* motion = FindMotion(*body.type, call);
  if (motion == nullptr) return std::nullopt;
  const size_t errors = evaluator_.diagnostics().errors();
  const std::vector<size_t> places = *Match(*motion, call);
  Instance instance;
  instance.robot = robot;
  instance.motion = motion;
  instance.args.resize(motion->params.size());
  std::vector<Span> spans(motion->params.size(), call.motion.span);
  for (size_t i = 0; i < places.size(); ++i) {
    spans[places[i]] = evaluator_.SpanOf(call.args[i].value);
    Value value = evaluator_.Evaluate(call.args[i].value, scope);
    if (value.terms.empty()) value = evaluator_.WrongType(spans[places[i]], value, "a quantity or a point");
    instance.args[places[i]] = std::move(value);
  }
  if (evaluator_.diagnostics().errors() > errors) return std::nullopt;
  const robot::Scope names = robot::MotionScope(body, *motion, instance.args, spans, evaluator_);
  if (evaluator_.diagnostics().errors() > errors) return std::nullopt;
  for (size_t i = 0; i < motion->params.size(); ++i)
    instance.args[i] = names.names.find(motion->params[i].name.text)->second;
  Key key = KeyOf(instance);
  if (const auto it = known_.find(key); it != known_.end()) return it->second;
  const Span span = call.robot.span.file == call.motion.span.file && !call.robot.text.empty()
                        ? call.robot.span.To(call.motion.span)
                        : call.motion.span;
  const auto duration = DurationOf(*motion, names, span);
  if (!duration) return std::nullopt;
  instance.duration = *duration;
  instance.contract = robot::ContractOf(body, *motion, names, evaluator_);
  instance.control = robot::ControlOf(body, *motion, names, evaluator_);
  instance.text = TextOf(*motion, call);
  if (evaluator_.diagnostics().errors() > errors) return std::nullopt;
  graph_.instances.push_back(std::move(instance));
  known_.emplace(std::move(key), graph_.instances.size() - 1);
  return graph_.instances.size() - 1;
}

std::optional<Value> Calls::Time(ExprId e, const robot::Scope& names, Span call) {
  const Value value = evaluator_.Evaluate(e, names);
  if (value.kind == ValueKind::kError) return std::nullopt;
  const bool time =
      value.kind == ValueKind::kQuantity && (value.any_dimension || value.dimension == robot::kTime);
  if (time && evaluator_.arena().IsNumber(value.terms[0])) return value;
  auto& report = evaluator_.diagnostics().Report(
      Kind::kChoreoDuration, evaluator_.SpanOf(e),
      time ? "the duration of a motion must be known" : "a duration is a time");
  report.At(call, "for this motion");
  if (!time) report.Help("write the unit: `5 s`");
  return std::nullopt;
}

std::optional<Duration> Calls::DurationOf(const MotionDef& motion, const robot::Scope& names, Span call) {
  const lang::Expr& end = evaluator_.pool()[motion.most];
  const bool infinite = end.kind == lang::ExprKind::kName && end.text == "inf";
  const auto least = Time(motion.least, names, call);
  const auto most = infinite ? least : Time(motion.most, names, call);
  if (!least || !most) return std::nullopt;
  Duration duration{evaluator_.arena().number(least->terms[0]), std::nullopt, motion.interruptible};
  if (!infinite) duration.most = evaluator_.arena().number(most->terms[0]);
  if (duration.least < Rational(0) || (duration.most && *duration.most < duration.least)) {
    evaluator_.diagnostics()
        .Report(Kind::kChoreoDuration, call, "the duration of this motion is empty")
        .At(motion.span, "it is declared here");
    return std::nullopt;
  }
  return duration;
}

}  // namespace rondo::choreo
