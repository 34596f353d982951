#include "choreo/process/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "choreo/process/labels.h"
#include "expr/substitute.h"

namespace rondo::choreo {

using diag::Kind;
using diag::Span;
using expr::TermId;
using robot::Value;
using robot::ValueKind;

void Wrong::Report(diag::Diagnostics& diagnostics, Span choreography) const {
  auto& report = diagnostics.Report(kind, span, message);
  report.At(choreography, "the choreography");
  if (!help.empty()) report.Help(help);
}

Compare::Compare(const Flow& flow, Graph& graph, Declarations& declarations)
    : flow_(flow),
      graph_(graph),
      evaluator_(declarations.evaluator()),
      arena_(evaluator_.arena()),
      calls_(graph, declarations, flow.source->loose_names) {}

// Bindings only ever get weaker, so that this ends.
bool Compare::Restart() {
  for (auto& [c, binding] : bindings_) binding.used = false;
  locals_.clear();
  if (restarts_) conditions_.clear();
  return std::exchange(restarts_, false);
}

bool Compare::SameLabel(const std::string& asked, const std::string& given) const {
  return choreo::SameLabel(asked, given, flow_.source->loose_names);
}

// -- names

robot::Scope Compare::ScopeOf(const FlowNode& node) const {
  robot::Scope scope;
  scope.outer = &graph_.BodyOf(flow_.robot).scope;
  scope.names = locals_;
  for (const Case* c : node.bindings) {
    const auto it = bindings_.find(c);
    const bool bound = it != bindings_.end() && it->second.used;
    for (size_t i = 0; i < c->names.size(); ++i)
      scope.names[c->names[i].text] = bound ? it->second.values[i] : Value{};
  }
  return scope;
}

TermId Compare::KnownAt(const FlowNode& node) const {
  std::vector<TermId> known;
  for (const Case* c : node.bindings) {
    const auto it = bindings_.find(c);
    if (it != bindings_.end() && !it->second.constant) known.push_back(arena_.Or(it->second.ways));
  }
  return arena_.And(known);
}

// A robot knows its own state and inputs, what it is told, and what it remembers.
void Compare::NeedKnown(const FlowNode& node, const std::vector<TermId>& terms, Span span) {
  std::vector<TermId> told;
  for (const auto& [name, value] : ScopeOf(node).names)
    told.insert(told.end(), value.terms.begin(), value.terms.end());
  const robot::Body& body = graph_.BodyOf(flow_.robot);
  const auto unknown = robot::UnknownTo(body, arena_, terms, told);
  if (!unknown) return;
  evaluator_.diagnostics()
      .Report(Kind::kProcessStep, span,
              fmt::format("`{}` cannot know this: it depends on `{}`", body.name.text, *unknown))
      .Note("a robot knows its own state and inputs, and what it is told");
}

TermId Compare::GuardOf(const FlowNode& node) {
  if (!node.act->guard.valid()) return arena_.True();
  const TermId guard = evaluator_.Formula(node.act->guard, ScopeOf(node), "a formula");
  NeedKnown(node, {guard}, evaluator_.SpanOf(node.act->guard));
  return guard;
}

void Compare::CheckAssignment(const FlowNode& node) {
  const Name& name = node.act->variable;
  const robot::Scope scope = ScopeOf(node);
  Value value = evaluator_.Evaluate(node.act->guard, scope);
  if (value.kind == ValueKind::kError) return;
  NeedKnown(node, value.terms, evaluator_.SpanOf(node.act->guard));
  if (value.terms.empty()) {
    evaluator_.WrongType(evaluator_.SpanOf(node.act->guard), value, "a quantity, a point or a formula");
    return;
  }
  const std::string own = graph_.NameOf(flow_.robot) + "_";
  const std::string bare = name.text.starts_with(own) ? name.text.substr(own.size()) : name.text;
  if (graph_.BodyOf(flow_.robot).scope.Find(bare) != nullptr) {
    evaluator_.diagnostics()
        .Report(Kind::kProcessStep, name.span,
                fmt::format("`{}` belongs to the robot, and is not assigned to", bare))
        .Note("the state of a robot changes by its motions, what it senses by the world")
        .Help("assign to a name of the process");
    return;
  }
  for (TermId& t : value.terms) t = arena_.FreshConstant(name.text, arena_.sort_of(t));
  value.squared.reset();
  const auto [it, fresh] = locals_.emplace(name.text, value);
  if (fresh || (it->second.kind == value.kind && robot::Evaluator::Agree(it->second, value))) return;
  evaluator_.WrongType(evaluator_.SpanOf(node.act->guard), value,
                       fmt::format("{}, as before,", robot::Describe(it->second)));
}

// -- conditions

bool Compare::Refuted(TermId hypothesis, TermId goal) {
  if (goal == arena_.False()) return hypothesis != arena_.False();
  return hypothesis == arena_.Not(goal);
}

void Compare::Need(Span span, std::string what, TermId hypothesis, TermId goal, std::vector<NodeId> at,
                   bool moving) {
  if (goal == arena_.True() || hypothesis == goal || hypothesis == arena_.False()) return;
  // A conjunct of what is known.
  if (arena_.op(hypothesis) == expr::Op::kAnd && std::ranges::count(arena_.args(hypothesis), goal) > 0)
    return;
  conditions_.push_back({span, std::move(what), hypothesis, goal, std::move(at), moving, flow_.robot});
}

TermId Compare::Equal(const Value& a, const Value& b) {
  std::vector<TermId> equal;
  for (size_t i = 0; i < a.terms.size(); ++i) equal.push_back(arena_.Eq(a.terms[i], b.terms[i]));
  return arena_.And(equal);
}

// -- payloads

std::optional<Wrong> Compare::SendPayload(const FlowNode& node, const std::vector<NodeId>& nodes) {
  const robot::Scope scope = ScopeOf(node);
  std::vector<Value> values;
  for (const ExprId id : node.act->values) {
    values.push_back(evaluator_.Evaluate(id, scope));
    NeedKnown(node, values.back().terms, evaluator_.SpanOf(id));
  }
  for (const NodeId id : nodes) {
    const Node& message = graph_[id];
    const std::string label = message.label;
    if (values.size() != message.payload.size()) {
      return Wrong{Kind::kProcessPayload, node.span,
                   fmt::format("`{}` carries {} value{}, but {} {} sent", label, message.payload.size(),
                               message.payload.size() == 1 ? "" : "s", values.size(),
                               values.size() == 1 ? "is" : "are"),
                   ""};
    }
    const TermId known = KnownAt(node);
    expr::Substitution given;
    for (size_t i = 0; i < values.size(); ++i) {
      Value asked = message.payload[i];
      if (values[i].kind == ValueKind::kError || asked.kind == ValueKind::kError) continue;
      const Span span = evaluator_.SpanOf(node.act->values[i]);
      if (asked.kind != values[i].kind || asked.terms.size() != values[i].terms.size() ||
          !robot::Evaluator::Agree(asked, values[i])) {
        return Wrong{Kind::kProcessPayload, span,
                     fmt::format("`{}` carries {}, but this is {}", label, robot::Describe(asked),
                                 robot::Describe(values[i])),
                     ""};
      }
      if (!message.names[i].empty()) {
        for (size_t k = 0; k < asked.terms.size(); ++k) given.emplace(asked.terms[k], values[i].terms[k]);
        continue;
      }
      const TermId same = Equal(values[i], asked);
      if (Refuted(known, same)) {
        return Wrong{Kind::kProcessPayload, span,
                     fmt::format("`{}` carries another value in the choreography", label), ""};
      }
      Need(span, fmt::format("whether `{}` carries the value of the choreography", label), known, same, {id});
    }
    const TermId refinement = expr::Substitute(arena_, message.refinement, given);
    if (Refuted(known, refinement)) {
      return Wrong{Kind::kProcessPayload, node.span,
                   fmt::format("what `{}` carries is not as the choreography promises", label), ""};
    }
    Need(node.span, fmt::format("whether `{}` carries what the choreography promises", label), known,
         refinement, {id});
  }
  return std::nullopt;
}

// What is known of the names of a case when this message came. Of what a message says about states, nothing
// is kept: they change, and the names do not.
TermId Compare::WayOf(const Node& message, const std::vector<Value>& values) {
  expr::Substitution names;
  std::vector<TermId> known;
  std::vector<TermId> symbols;
  for (size_t i = 0; i < values.size(); ++i) {
    symbols.insert(symbols.end(), values[i].terms.begin(), values[i].terms.end());
    if (message.names[i].empty()) {
      known.push_back(Equal(values[i], message.payload[i]));
    } else {
      for (size_t k = 0; k < values[i].terms.size(); ++k)
        names.emplace(message.payload[i].terms[k], values[i].terms[k]);
    }
  }
  const TermId refinement = expr::Substitute(arena_, message.refinement, names);
  if (arena_.op(refinement) == expr::Op::kAnd) {
    const auto parts = arena_.args(refinement);
    known.insert(known.end(), parts.begin(), parts.end());
  } else {
    known.push_back(refinement);
  }
  std::erase_if(known, [&](TermId t) {
    const auto variables = robot::VariablesOf(arena_, {t});
    return !std::ranges::all_of(variables, [&](TermId v) { return std::ranges::count(symbols, v) > 0; });
  });
  return arena_.And(known);
}

std::optional<Wrong> Compare::ReceivePayload(const Case& c, const std::vector<NodeId>& nodes) {
  if (c.names.empty()) return std::nullopt;
  const Node& first = graph_[nodes[0]];
  bool constant = true;
  for (const NodeId id : nodes) {
    const Node& message = graph_[id];
    if (message.payload.size() != c.names.size()) {
      return Wrong{Kind::kProcessPayload, c.span,
                   fmt::format("`{}` carries {} value{}, but {} {} named", message.label,
                               message.payload.size(), message.payload.size() == 1 ? "" : "s", c.names.size(),
                               c.names.size() == 1 ? "is" : "are"),
                   ""};
    }
    for (size_t i = 0; i < c.names.size(); ++i) {
      const Value& value = message.payload[i];
      constant = constant && robot::IsConstant(arena_, value) && value.terms == first.payload[i].terms;
      if (value.kind == first.payload[i].kind && value.dimension == first.payload[i].dimension) continue;
      return Wrong{Kind::kProcessPayload, c.span,
                   fmt::format("`{}` carries different kinds of values", message.label), ""};
    }
  }
  const auto [it, fresh] = bindings_.try_emplace(&c);
  Binding& binding = it->second;
  if (fresh && constant) {
    binding = {first.payload, {}, true, true};
    return std::nullopt;
  }
  if (!fresh && binding.constant) {
    bool same = constant;
    for (size_t i = 0; i < c.names.size(); ++i)
      same = same && binding.values[i].terms == first.payload[i].terms;
    if (same) {
      binding.used = true;
      return std::nullopt;
    }
    restarts_ = true;
  }
  if (fresh || binding.constant) {
    // Symbols, of which the constant so far is one possible value.
    const std::vector<Value> before = std::exchange(binding.values, {});
    for (size_t i = 0; i < c.names.size(); ++i) {
      Value value = first.payload[i];
      for (TermId& t : value.terms) t = arena_.FreshConstant(c.names[i].text, arena_.sort_of(t));
      value.squared.reset();
      binding.values.push_back(std::move(value));
    }
    std::vector<TermId> equal;
    for (size_t i = 0; i < before.size(); ++i) equal.push_back(Equal(binding.values[i], before[i]));
    if (binding.constant) binding.ways.push_back(arena_.And(equal));
    binding.constant = false;
  }
  // What followed from less ways has to be looked at again.
  for (const NodeId id : nodes) {
    const TermId way = WayOf(graph_[id], binding.values);
    if (std::ranges::count(binding.ways, way) > 0) continue;
    binding.ways.push_back(way);
    restarts_ = restarts_ || binding.used;
  }
  binding.used = true;
  return std::nullopt;
}

// -- motions

std::optional<Wrong> Compare::Moves(const FlowNode& node, const std::vector<NodeId>& nodes) {
  const auto done = calls_.Resolve(flow_.robot, node.act->motion, ScopeOf(node));
  if (!done) return std::nullopt;  // said already
  if (node.kind == FlowKind::kReceive && !graph_.instances[*done].duration.interruptible) {
    return Wrong{Kind::kProcessMotion, node.act->motion.motion.span,
                 fmt::format("`{}` cannot be interrupted by the message that it waits for",
                             graph_.instances[*done].text),
                 ""};
  }
  for (const NodeId id : nodes) {
    for (const Part& part : graph_[id].parts) {
      if (part.robot != flow_.robot || part.instance == *done) continue;
      if (auto wrong = Refines(node, graph_.instances[*done], graph_.instances[part.instance], id))
        return wrong;
    }
  }
  return std::nullopt;
}

std::optional<Wrong> Compare::Stands(const FlowNode& node) {
  const auto done = calls_.Resolve(flow_.robot, node.act->motion, ScopeOf(node));
  if (!done) return std::nullopt;  // said already
  const Instance& i = graph_.instances[*done];
  const bool moves = std::ranges::count(i.contract.modifies, true) > 0;
  if (i.duration.interruptible && i.duration.least.IsZero() && !moves) return std::nullopt;
  return Wrong{Kind::kProcessMotion, node.act->motion.motion.span,
               fmt::format("`{}` {}, but nobody moves here in the choreography", i.text,
                           moves ? "moves the robot" : "cannot be interrupted at once"),
               "wait without a motion, or with one that stands still"};
}

// The same motion with the same arguments; or [Sub-Motion]: weaker needs, stronger promises, less space, and
// a duration that fits wherever that of the other one fits.
std::optional<Wrong> Compare::Refines(const FlowNode& node, const Instance& done, const Instance& asked,
                                      NodeId at) {
  const Span span = node.act->motion.motion.span;
  const TermId known = KnownAt(node);
  if (done.motion == asked.motion) {
    for (size_t i = 0; i < done.args.size(); ++i) {
      const std::string& name = done.motion->params[i].name.text;
      const TermId same = Equal(done.args[i], asked.args[i]);
      if (Refuted(known, same)) {
        return Wrong{
            Kind::kProcessArgument, span,
            fmt::format("`{}` is another one in the choreography: there it does `{}`", name, asked.text), ""};
      }
      Need(span, fmt::format("whether `{}` is as in the choreography", name), known, same, {at});
    }
    return std::nullopt;
  }
  const Duration& d = done.duration;
  const Duration& a = asked.duration;
  const auto within = [](const Duration& inner, const Duration& outer) {
    return outer.least <= inner.least && (!outer.most || (inner.most && *inner.most <= *outer.most));
  };
  const bool fits = d.interruptible == a.interruptible && (d.interruptible ? within(a, d) : within(d, a));
  if (!fits) {
    return Wrong{
        Kind::kProcessMotion, span,
        fmt::format("the choreography asks for `{}`, for which `{}` cannot stand", asked.text, done.text),
        "another motion can stand for it if it may be interrupted, too, and takes a time that fits"};
  }
  const robot::Contract& x = done.contract;
  const robot::Contract& c = asked.contract;
  const std::string what = fmt::format("whether `{}` can stand for `{}`", done.text, asked.text);
  for (size_t i = 0; i < x.modifies.size(); ++i) {
    if (!x.modifies[i] || c.modifies[i]) continue;
    return Wrong{Kind::kProcessMotion, span,
                 fmt::format("the choreography asks for `{}`, which leaves `{}` as it is", asked.text,
                             graph_.BodyOf(flow_.robot).states[i].name.text),
                 ""};
  }
  Need(span, what, arena_.And(known, c.pre), x.pre, {at});
  Need(span, what, arena_.And(known, c.assume), x.assume, {at}, true);
  Need(span, what, arena_.And(known, x.during), c.during, {at}, true);
  Need(span, what, arena_.And(known, x.post), c.post, {at}, true);
  if (c.footprint && !x.footprint) {
    return Wrong{
        Kind::kProcessMotion, span,
        fmt::format("nothing is known of the space that `{}` takes, which has to be within that of `{}`",
                    done.text, asked.text),
        ""};
  }
  if (x.footprint && c.footprint) {
    const robot::Vector& p = graph_.world->point;
    Need(span, what, arena_.And({known, x.during, robot::Contains(arena_, *x.footprint, p)}),
         robot::Contains(arena_, *c.footprint, p), {at}, true);
  }
  return std::nullopt;
}

}  // namespace rondo::choreo
