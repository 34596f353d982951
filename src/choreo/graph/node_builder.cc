#include "choreo/graph/node_builder.h"

#include <fmt/format.h>

#include <algorithm>

#include "expr/defined.h"
#include "expr/substitute.h"
#include "lang/expr_printer.h"

namespace rondo::choreo {

using diag::Kind;
using diag::Span;
using expr::TermId;
using robot::Value;
using robot::ValueKind;

std::optional<Scope> NodeBuilder::Begin(const ChoreographyDef& source) {
  errors_ = diagnostics_.errors();
  graph_.source = &source;
  for (const Name& option : source.options) {
    if (option.text == "equal_durations") {
      graph_.equal_durations = true;
    } else {
      declarations_.Undeclared(option, "option", {"equal_durations"});
    }
  }
  graph_.world = declarations_.FindWorld(source.world);
  if (graph_.world == nullptr) return std::nullopt;
  Scope everybody;
  for (const robot::Body& body : graph_.world->bodies) {
    const RobotId id(graph_.robots.size());
    graph_.robots.push_back(body.name);
    robots_.emplace(body.name.text, id);
    everybody.insert(id);
  }
  graph_.initially = evaluator_.Formula(source.initially, graph_.world->scope, "a formula");
  return everybody;
}

std::optional<Graph> NodeBuilder::Finish() {
  if (diagnostics_.errors() > errors_) return std::nullopt;
  return std::move(graph_);
}

NodeId NodeBuilder::Add(Node node) {
  graph_.nodes.push_back(std::move(node));
  return NodeId(graph_.nodes.size() - 1);
}

Node NodeBuilder::Make(NodeKind kind, Span span, const Scope& scope) {
  Node node;
  node.kind = kind;
  node.span = span;
  node.scope = scope;
  return node;
}

RobotId NodeBuilder::Robot(const Name& name, const Scope& scope) {
  const auto it = robots_.find(name.text);
  if (it == robots_.end()) {
    std::vector<std::string> names;
    for (const auto& [known, id] : robots_) names.push_back(known);
    declarations_.Undeclared(name, "robot", names);
    return {};
  }
  if (scope.contains(it->second)) return it->second;
  diagnostics_
      .Report(Kind::kChoreoOutOfScope, name.span,
              fmt::format("`{}` belongs to another thread of this `parallel`", name.text))
      .Note(fmt::format("this thread has {}", graph_.Names(scope)))
      .Help("let the threads join before robots of different threads meet");
  return {};
}

// -- messages

Node NodeBuilder::MakeMessage(const Stmt& s, const Scope& scope) {
  Node node = Make(NodeKind::kMessage, s.span, scope);
  node.from = Robot(s.from, scope);
  node.to = Robot(s.to, scope);
  node.label = s.label.text;
  if (node.from.valid() && node.from == node.to)
    diagnostics_.Report(Kind::kChoreoSelfMessage, s.span, fmt::format("`{}` sends to itself", s.from.text));
  robot::Scope names;
  names.outer = &graph_.world->scope;
  std::vector<TermId> known;
  for (const Payload& p : s.payload) AddPayload(p, names, known, node);
  node.refinement = evaluator_.arena().And(known);
  node.when = evaluator_.Formula(s.guard, graph_.world->scope, "a formula");
  for (size_t i = 0; i < s.payload.size(); ++i) {
    if (node.names[i].empty())
      NeedKnown(node.payload[i].terms, evaluator_.SpanOf(s.payload[i].value), node.from);
  }
  if (s.guard.valid()) NeedKnown({node.when}, evaluator_.SpanOf(s.guard), node.from);
  return node;
}

// `name: type | what is known of it`, or a value.
void NodeBuilder::AddPayload(const Payload& payload, robot::Scope& scope, std::vector<TermId>& known,
                             Node& node) {
  expr::Arena& arena = evaluator_.arena();
  node.names.push_back(payload.name.text);
  if (payload.name.text.empty()) {
    Value value = evaluator_.Evaluate(payload.value, scope);
    if (value.kind != ValueKind::kError && value.terms.empty())
      value =
          evaluator_.WrongType(evaluator_.SpanOf(payload.value), value, "a quantity, a point or a formula");
    node.payload.push_back(std::move(value));
    return;
  }
  const auto fresh = [&](expr::SortId sort) { return arena.FreshConstant(payload.name.text, sort); };
  Value value;
  if (const lang::Dimension* d = lang::FindDimension(payload.type.text)) {
    value = robot::Quantity(fresh(arena.Real()), *d);
  } else if (payload.type.text == "point") {
    value = robot::PointAt({fresh(arena.Real()), fresh(arena.Real()), fresh(arena.Real())});
  } else if (payload.type.text == "bool") {
    value = robot::Boolean(fresh(arena.Bool()));
  } else {
    declarations_.Undeclared(payload.type, "type of payloads",
                             {"length", "angle", "time", "speed", "acceleration", "number", "point", "bool"});
  }
  if (!scope.names.emplace(payload.name.text, value).second)
    diagnostics_.Report(Kind::kChoreoDuplicate, payload.name.span,
                        fmt::format("`{}` is declared twice", payload.name.text));
  node.payload.push_back(std::move(value));
  known.push_back(evaluator_.Formula(payload.value, scope, "a formula"));
}

// -- motions

Node NodeBuilder::MakeMotion(const Stmt& s, const Scope& scope) {
  Node node = Make(NodeKind::kMotion, s.span, scope);
  Scope missing = scope;
  for (const MotionCall& call : s.motions) {
    const RobotId robot = Robot(call.robot, scope);
    if (!robot.valid()) continue;
    if (missing.erase(robot) == 0) {
      diagnostics_.Report(Kind::kChoreoRobotTwice, call.robot.span,
                          fmt::format("`{}` moves twice in one step", call.robot.text));
      continue;
    }
    const auto instance = calls_.Resolve(robot, call, graph_.world->scope);
    if (!instance) continue;
    const Span span = call.robot.span.To(call.motion.span);
    node.parts.push_back({robot, span, *instance, graph_.instances[*instance].duration});
    for (const Value& v : graph_.instances[*instance].args) {
      if (robot::IsConstant(evaluator_.arena(), v)) continue;
      diagnostics_
          .Report(Kind::kRobotType, span, "an argument of this motion depends on the state of a robot")
          .Note("a contract is about motions whose arguments are known beforehand");
    }
  }
  if (!missing.empty()) {
    diagnostics_
        .Report(Kind::kChoreoNotMoving, s.span,
                fmt::format("nothing is said of what {} {} in this step", graph_.Names(missing),
                            missing.size() == 1 ? "does" : "do"))
        .Note("time passes for every robot of a thread in each of its steps")
        .Help(fmt::format("write all motions of the step in braces: `{{ {}: ..., {}: Idle() }}`",
                          s.motions.empty() ? "a" : s.motions[0].robot.text,
                          graph_.NameOf(*missing.begin())));
  }
  return node;
}

// -- choices

std::map<RobotId, Span> NodeBuilder::Owners(ExprId id) const {
  std::map<RobotId, Span> owners;
  std::vector<ExprId> todo{id};
  while (!todo.empty()) {
    const lang::Expr& e = pool_[todo.back()];
    todo.pop_back();
    if (e.kind == lang::ExprKind::kName) {
      if (const auto it = robots_.find(e.text); it != robots_.end()) owners.emplace(it->second, e.span);
    }
    todo.insert(todo.end(), e.args.begin(), e.args.end());
  }
  return owners;
}

void NodeBuilder::NeedKnown(const std::vector<TermId>& terms, Span span, RobotId robot) {
  if (!robot.valid()) return;
  const auto unknown = robot::UnknownTo(graph_.BodyOf(robot), evaluator_.arena(), terms, {});
  if (!unknown) return;
  diagnostics_
      .Report(Kind::kChoreoGuardOwner, span,
              fmt::format("`{}` cannot know this: it depends on `{}`", graph_.NameOf(robot), *unknown))
      .Note("a robot knows its own state and inputs, and what it is told")
      .Help("let whoever knows it send a message first");
}

void NodeBuilder::AddGuard(ExprId guard, Node& choice) {
  expr::Arena& arena = evaluator_.arena();
  choice.guards.push_back(guard);
  if (!guard.valid()) {
    std::vector<TermId> others;
    for (const TermId g : choice.guard_terms) others.push_back(expr::Complement(arena, g));
    choice.guard_terms.push_back(arena.And(others));
    return;
  }
  choice.guard_terms.push_back(evaluator_.Formula(guard, graph_.world->scope, "a formula"));
  bool foreign = false;
  for (const auto& [robot, span] : Owners(guard)) {
    if (robot == choice.chooser || !choice.chooser.valid()) continue;
    foreign = true;
    diagnostics_
        .Report(Kind::kChoreoGuardOwner, span,
                fmt::format("this guard reads the state of `{}`, but `{}` decides", graph_.NameOf(robot),
                            graph_.NameOf(choice.chooser)))
        .Help(fmt::format("let `{}` send what it knows to `{}` first", graph_.NameOf(robot),
                          graph_.NameOf(choice.chooser)));
  }
  // Not by name, but by way of what carries it, or of the world.
  if (!foreign) NeedKnown({choice.guard_terms.back()}, pool_[guard].span, choice.chooser);
}

// -- threads

void NodeBuilder::Mentions(const Stmt& s, ThreadRobots& thread) const {
  const auto add = [&](const Name& name, Scope& to) {
    if (const auto it = robots_.find(name.text); it != robots_.end()) to.insert(it->second);
  };
  if (s.kind == StmtKind::kMessage) {
    add(s.from, thread.mentioned);
    add(s.to, thread.mentioned);
  }
  if (s.kind == StmtKind::kChoose) add(s.chooser, thread.mentioned);
  for (const MotionCall& call : s.motions) {
    add(call.robot, thread.mentioned);
    add(call.robot, thread.moving);
  }
}

// Each robot of the scope belongs to exactly one thread: the one in which it moves, else the one that
// mentions it.
std::vector<Scope> NodeBuilder::Threads(const Stmt& s, const std::vector<ThreadRobots>& threads,
                                        const Scope& scope) {
  std::vector<Scope> result(s.branches.size());
  Scope nowhere;
  for (const RobotId r : scope) {
    std::vector<size_t> in, moves;
    for (size_t b = 0; b < s.branches.size(); ++b) {
      if (threads[b].mentioned.contains(r)) in.push_back(b);
      if (threads[b].moving.contains(r)) moves.push_back(b);
    }
    if (in.empty()) {
      nowhere.insert(r);
      continue;
    }
    result[moves.empty() ? in[0] : moves[0]].insert(r);
    if (moves.size() < 2) continue;
    diagnostics_
        .Report(Kind::kChoreoRobotTwice, s.branches[moves[1]].span,
                fmt::format("`{}` moves in two threads of one `parallel`", graph_.NameOf(r)))
        .At(s.branches[moves[0]].span, "it moves here, too");
  }
  if (!nowhere.empty()) {
    diagnostics_
        .Report(Kind::kChoreoRobotNowhere, s.span,
                fmt::format("{} {} in no thread of this `parallel`", graph_.Names(nowhere),
                            nowhere.size() == 1 ? "is" : "are"))
        .Help("add a thread in which it idles");
  }
  return result;
}

ThreadFacts NodeBuilder::Facts(const Branch& branch) {
  expr::Arena& arena = evaluator_.arena();
  std::vector<TermId> region, assume, guarantee;
  std::string text;
  const auto add = [&](const std::vector<Clause>& clauses) {
    for (const Clause& c : clauses) {
      const bool space = c.keyword.text == "region";
      const robot::Scope& names = space ? graph_.world->point_scope : graph_.world->scope;
      const TermId formula = evaluator_.Formula(c.value, names, "a formula");
      if (space)
        text +=
            fmt::format("{}({})", text.empty() ? "" : " and ", lang::PrintExpr(evaluator_.pool(), c.value));
      (space ? region : c.keyword.text == "assume" ? assume : guarantee).push_back(formula);
    }
  };
  if (!branch.contract.text.empty()) {
    if (const ContractDef* contract = declarations_.FindContract(branch.contract)) add(contract->facts);
  }
  add(branch.facts);
  ThreadFacts facts{branch.span, std::nullopt, arena.And(assume), arena.And(guarantee), text};
  if (!region.empty()) facts.region = arena.And(region);
  return facts;
}

Node NodeBuilder::MakeFork(const Stmt& s, const std::vector<ThreadRobots>& threads, const Scope& scope) {
  Node fork = Make(NodeKind::kFork, s.span, scope);
  fork.threads = Threads(s, threads, scope);
  for (size_t b = 0; b < s.branches.size(); ++b) {
    fork.facts.push_back(Facts(s.branches[b]));
    Scope stated;
    for (const Name& name : s.branches[b].robots) stated.insert(Robot(name, scope));
    if (stated.empty() || stated == fork.threads[b] || stated.contains(RobotId())) continue;
    diagnostics_.Report(Kind::kChoreoOutOfScope, s.branches[b].span,
                        fmt::format("this contract is about {}, but its thread has {}", graph_.Names(stated),
                                    graph_.Names(fork.threads[b])));
  }
  CheckCoupling(s, fork, scope);
  return fork;
}

// A robot that is carried by one of another thread goes where that one goes: its thread must know about it.
void NodeBuilder::CheckCoupling(const Stmt& s, const Node& fork, const Scope& scope) {
  for (size_t b = 0; b < fork.threads.size(); ++b) {
    for (const RobotId r : fork.threads[b]) {
      for (auto parent = graph_.BodyOf(r).parent; parent; parent = graph_.world->bodies[*parent].parent) {
        const RobotId carrier(*parent);
        if (fork.threads[b].contains(carrier) || !scope.contains(carrier)) continue;
        bool known = false;
        std::unordered_set<TermId> seen;
        expr::VisitPostorder(evaluator_.arena(), fork.facts[b].assume, seen, [&](TermId t) {
          known = known || std::ranges::any_of(graph_.BodyOf(carrier).states,
                                               [&](const auto& v) { return v.term == t; });
        });
        if (known) continue;
        diagnostics_
            .Report(Kind::kChoreoCoupled, s.branches[b].span,
                    fmt::format("`{}` stands on `{}`, which belongs to another thread", graph_.NameOf(r),
                                graph_.NameOf(carrier)))
            .Note(fmt::format("nothing is assumed of where `{}` goes meanwhile", graph_.NameOf(carrier)))
            .Help(fmt::format(
                "let the thread of `{0}` guarantee what this one assumes: `assume {0}.x == 0 m`, for instance",
                graph_.NameOf(carrier)));
      }
    }
  }
}

}  // namespace rondo::choreo
