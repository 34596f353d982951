#include "choreo/graph/lower.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "choreo/graph/constant.h"
#include "lang/suggest.h"

namespace rondo::choreo {
namespace {

using diag::Kind;
using diag::Span;
using expr::Rational;

/// What the module declares, by name.
class Declarations {
 public:
  Declarations(const Module& module, diag::Diagnostics& diagnostics) : diagnostics_(diagnostics) {
    for (const Item& item : module.items) {
      if (const auto* robot = std::get_if<RobotDef>(&item)) Add(robots, robot->name, robot);
      if (const auto* world = std::get_if<WorldDef>(&item)) Add(worlds, world->name, world);
      if (const auto* choreography = std::get_if<ChoreographyDef>(&item))
        Add(choreographies_, choreography->name, choreography);
    }
  }

  template <typename T>
  using Table = std::map<std::string, const T*, std::less<>>;

  template <typename T>
  const T* Find(const Table<T>& table, const Name& name, std::string_view what) {
    if (const auto it = table.find(name.text); it != table.end()) return it->second;
    std::vector<std::string> names;
    for (const auto& [known, value] : table) names.push_back(known);
    Undeclared(name, what, names);
    return nullptr;
  }

  // `owner`: what should have it; empty if the whole module.
  void Undeclared(const Name& name, std::string_view what, const std::vector<std::string>& names,
                  std::string_view owner = {}) {
    auto& report =
        diagnostics_.Report(Kind::kChoreoUndeclared, name.span,
                            owner.empty() ? fmt::format("there is no {} `{}`", what, name.text)
                                          : fmt::format("`{}` has no {} `{}`", owner, what, name.text));
    if (const std::string near = lang::Suggest(name.text, names); !near.empty())
      report.Help(fmt::format("did you mean `{}`?", near)).Fix(name.span, near);
  }

  Table<RobotDef> robots;
  Table<WorldDef> worlds;

 private:
  template <typename T>
  void Add(Table<T>& table, const Name& name, const T* value) {
    const auto [it, fresh] = table.emplace(name.text, value);
    if (fresh) return;
    diagnostics_.Report(Kind::kChoreoDuplicate, name.span, fmt::format("`{}` is declared twice", name.text))
        .At(it->second->name.span, "first here");
  }

  diag::Diagnostics& diagnostics_;
  Table<ChoreographyDef> choreographies_;
};

class Lowering {
 public:
  Lowering(const Module& module, Declarations& declarations, diag::Diagnostics& diagnostics)
      : pool_(module.exprs), declarations_(declarations), diagnostics_(diagnostics) {}

  std::optional<Graph> Run(const ChoreographyDef& source) {
    const size_t errors = diagnostics_.errors();
    graph_.source = &source;
    for (const Name& option : source.options) {
      if (option.text == "equal_durations") {
        graph_.equal_durations = true;
      } else {
        declarations_.Undeclared(option, "option", {"equal_durations"});
      }
    }
    const WorldDef* world = declarations_.Find(declarations_.worlds, source.world, "world");
    if (world == nullptr) return std::nullopt;
    Scope everybody;
    for (const Component& c : world->components) {
      const RobotId id(graph_.robots.size());
      graph_.robots.push_back(c.name);
      graph_.types.push_back(declarations_.Find(declarations_.robots, c.type, "robot type"));
      if (!robots_.emplace(c.name.text, id).second)
        diagnostics_.Report(Kind::kChoreoDuplicate, c.name.span,
                            fmt::format("`{}` is declared twice", c.name.text));
      everybody.insert(id);
    }
    const NodeId end = Add(Make(NodeKind::kEnd, source.span, everybody));
    graph_.start = Statements(source.body, end, everybody);
    if (diagnostics_.errors() > errors) return std::nullopt;
    return std::move(graph_);
  }

 private:
  NodeId Add(Node node) {
    graph_.nodes.push_back(std::move(node));
    return NodeId(graph_.nodes.size() - 1);
  }

  static Node Make(NodeKind kind, Span span, const Scope& scope) {
    Node node;
    node.kind = kind;
    node.span = span;
    node.scope = scope;
    return node;
  }

  NodeId AddMerge(Span span, const Scope& scope) { return Add(Make(NodeKind::kMerge, span, scope)); }

  // From the last statement to the first: each knows where it goes on.
  NodeId Statements(const std::vector<Stmt>& body, NodeId next, const Scope& scope) {
    for (size_t i = body.size(); i-- > 0;) {
      const bool ends = body[i].kind == StmtKind::kLoop || body[i].kind == StmtKind::kContinue;
      if (ends && i + 1 < body.size()) {
        diagnostics_.Report(Kind::kChoreoUnreachable, body[i + 1].span, "this step is never reached")
            .At(body[i].span, "what stands here never goes on");
      }
      next = Statement(body[i], next, scope);
    }
    return next;
  }

  NodeId Statement(const Stmt& s, NodeId next, const Scope& scope) {
    switch (s.kind) {
      case StmtKind::kMessage:
        return Message(s, next, scope);
      case StmtKind::kMotion:
        return Motion(s, next, scope);
      case StmtKind::kParallel:
        return Parallel(s, next, scope);
      case StmtKind::kChoose:
        return Choose(s, next, scope);
      case StmtKind::kLoop: {
        const NodeId head = AddMerge(s.span, scope);
        SetNext(head, Statements(s.body, head, scope));
        return head;
      }
      case StmtKind::kWhile:
        return While(s, next, scope);
      case StmtKind::kRec:
        return Recursion(s, next, scope);
      case StmtKind::kContinue:
        return Continue(s);
    }
    return next;
  }

  void SetNext(NodeId node, NodeId next) { graph_.nodes[node.index()].next = {next}; }

  // A robot in scope; else invalid, after a report.
  RobotId Robot(const Name& name, const Scope& scope) {
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

  NodeId Message(const Stmt& s, NodeId next, const Scope& scope) {
    Node node = Make(NodeKind::kMessage, s.span, scope);
    node.from = Robot(s.from, scope);
    node.to = Robot(s.to, scope);
    node.label = s.label.text;
    node.message = &s;
    if (node.from.valid() && node.from == node.to)
      diagnostics_.Report(Kind::kChoreoSelfMessage, s.span, fmt::format("`{}` sends to itself", s.from.text));
    node.next = {next};
    return Add(std::move(node));
  }

  NodeId Motion(const Stmt& s, NodeId next, const Scope& scope) {
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
      if (auto part = MakePart(robot, call)) node.parts.push_back(std::move(*part));
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
    node.next = {next};
    return Add(std::move(node));
  }

  std::optional<Part> MakePart(RobotId robot, const MotionCall& call) {
    const RobotDef* type = graph_.types[robot.index()];
    if (type == nullptr) return std::nullopt;
    const MotionDef* motion = nullptr;
    std::vector<std::string> names;
    Environment environment;
    for (const RobotItem& item : type->items) {
      if (const auto* group = std::get_if<ParamGroup>(&item)) {
        for (const Param& p : group->params) environment[p.name.text] = p.value;
      }
      const auto* candidate = std::get_if<MotionDef>(&item);
      if (candidate == nullptr) continue;
      names.push_back(candidate->name.text);
      if (candidate->name.text == call.motion.text) motion = candidate;
    }
    if (motion == nullptr) {
      declarations_.Undeclared(call.motion, "motion", names, type->name.text);
      return std::nullopt;
    }
    if (!Bind(*motion, call, environment)) return std::nullopt;
    Part part{robot, call.robot.span.To(call.motion.span), motion, &call, {}};
    const auto least = Time(motion->least, environment, part.span);
    const auto most = Time(motion->most, environment, part.span);
    if (!least || !most) return std::nullopt;
    part.duration = {least->value, std::nullopt, motion->interruptible};
    if (!most->infinite) part.duration.most = most->value;
    if (least->infinite || least->value < Rational(0) || (!most->infinite && most->value < least->value)) {
      diagnostics_.Report(Kind::kChoreoDuration, part.span, "the duration of this motion is empty")
          .At(motion->span, "it is declared here");
      return std::nullopt;
    }
    return part;
  }

  // Parameters and their arguments; defaults come from the robot.
  bool Bind(const MotionDef& motion, const MotionCall& call, Environment& environment) {
    std::map<std::string, ExprId, std::less<>> given;
    bool good = true;
    size_t position = 0;
    for (const Argument& a : call.args) {
      const Span span = pool_[a.value].span;
      if (a.name.text.empty()) {
        if (position >= motion.params.size()) {
          diagnostics_
              .Report(Kind::kChoreoArity, span,
                      fmt::format("`{}` takes {} argument{}", motion.name.text, motion.params.size(),
                                  motion.params.size() == 1 ? "" : "s"))
              .At(motion.name.span, "declared here");
          return false;
        }
        given[motion.params[position++].name.text] = a.value;
        continue;
      }
      const bool known =
          std::ranges::any_of(motion.params, [&](const Param& p) { return p.name.text == a.name.text; });
      if (known && given.emplace(a.name.text, a.value).second) continue;
      good = false;
      std::vector<std::string> names;
      for (const Param& p : motion.params) names.push_back(p.name.text);
      if (known) {
        diagnostics_.Report(Kind::kChoreoArity, a.name.span, fmt::format("`{}` is given twice", a.name.text));
      } else {
        declarations_.Undeclared(a.name, "parameter", names, motion.name.text);
      }
    }
    for (const Param& p : motion.params) {
      if (const auto it = given.find(p.name.text); it != given.end()) {
        environment[p.name.text] = it->second;
      } else if (p.value.valid()) {
        environment[p.name.text] = p.value;
      } else {
        good = false;
        diagnostics_
            .Report(Kind::kChoreoArity, call.motion.span,
                    fmt::format("`{}` needs a value for `{}`", motion.name.text, p.name.text))
            .At(p.name.span, "declared here, without a default");
      }
    }
    return good;
  }

  std::optional<Quantity> Time(ExprId e, const Environment& environment, Span call) {
    auto value = Constant(pool_, e, environment);
    const bool zero = value && value->value.IsZero() && value->dimension == lang::Dimension{};
    if (value && (zero || value->dimension == lang::Dimension{0, 1, 0})) return value;
    auto& report =
        diagnostics_.Report(Kind::kChoreoDuration, pool_[e].span,
                            value ? "a duration is a time" : "the duration of a motion must be known");
    report.At(call, "for this motion");
    if (value) report.Help("write the unit: `5 s`");
    return std::nullopt;
  }

  void Mentioned(const std::vector<Stmt>& body, Scope& robots, Scope& moving) const {
    const auto add = [&](const Name& name, Scope& to) {
      if (const auto it = robots_.find(name.text); it != robots_.end()) to.insert(it->second);
    };
    for (const Stmt& s : body) {
      if (s.kind == StmtKind::kMessage) {
        add(s.from, robots);
        add(s.to, robots);
      }
      if (s.kind == StmtKind::kChoose) add(s.chooser, robots);
      for (const MotionCall& call : s.motions) {
        add(call.robot, robots);
        add(call.robot, moving);
      }
      Mentioned(s.body, robots, moving);
      for (const Branch& b : s.branches) Mentioned(b.body, robots, moving);
    }
  }

  // Each robot of the scope belongs to exactly one thread: the one in which it moves, else the one that
  // mentions it.
  std::vector<Scope> Threads(const Stmt& s, const Scope& scope) {
    std::vector<Scope> mentioned(s.branches.size());
    std::vector<Scope> moving(s.branches.size());
    for (size_t b = 0; b < s.branches.size(); ++b) Mentioned(s.branches[b].body, mentioned[b], moving[b]);
    std::vector<Scope> threads(s.branches.size());
    Scope nowhere;
    for (const RobotId r : scope) {
      std::vector<size_t> in, moves;
      for (size_t b = 0; b < s.branches.size(); ++b) {
        if (mentioned[b].contains(r)) in.push_back(b);
        if (moving[b].contains(r)) moves.push_back(b);
      }
      if (in.empty()) {
        nowhere.insert(r);
        continue;
      }
      threads[moves.empty() ? in[0] : moves[0]].insert(r);
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
    return threads;
  }

  NodeId Parallel(const Stmt& s, NodeId next, const Scope& scope) {
    Node join = Make(NodeKind::kJoin, s.span, scope);
    join.next = {next};
    Node fork = Make(NodeKind::kFork, s.span, scope);
    fork.threads = Threads(s, scope);
    fork.threads_of = &s;
    fork.join = Add(std::move(join));
    // A recursion around the threads cannot go on from inside one of them.
    auto outer = std::exchange(recursions_, {});
    for (auto& [name, head] : outer) recursions_.emplace(name, NodeId());
    for (size_t b = 0; b < s.branches.size(); ++b)
      fork.next.push_back(Statements(s.branches[b].body, fork.join, fork.threads[b]));
    recursions_ = std::move(outer);
    return Add(std::move(fork));
  }

  NodeId Choose(const Stmt& s, NodeId next, const Scope& scope) {
    Node choice = Make(NodeKind::kChoice, s.span, scope);
    choice.chooser = Robot(s.chooser, scope);
    const NodeId merge = AddMerge(s.span, scope);
    SetNext(merge, next);
    for (const Branch& b : s.branches) {
      Owned(b.guard, choice.chooser);
      choice.guards.push_back(b.guard);
      choice.next.push_back(Statements(b.body, merge, scope));
    }
    return Add(std::move(choice));
  }

  NodeId While(const Stmt& s, NodeId next, const Scope& scope) {
    const NodeId head = AddMerge(s.span, scope);
    Node choice = Make(NodeKind::kChoice, s.span, scope);
    const std::map<RobotId, Span> owners = Owners(s.guard);
    if (owners.empty()) {
      diagnostics_
          .Report(Kind::kChoreoGuardOwner, pool_[s.guard].span, "this guard reads the state of no robot")
          .Note("the robot whose state a guard reads decides whether the loop goes on");
    } else {
      choice.chooser = owners.begin()->first;
      Owned(s.guard, choice.chooser);
      if (!scope.contains(choice.chooser))
        Robot(Name{graph_.NameOf(choice.chooser), owners.begin()->second}, scope);
    }
    choice.guards = {s.guard, {}};
    choice.next = {Statements(s.body, head, scope), next};
    SetNext(head, Add(std::move(choice)));
    return head;
  }

  NodeId Recursion(const Stmt& s, NodeId next, const Scope& scope) {
    const NodeId head = AddMerge(s.span, scope);
    const auto before = recursions_.find(s.label.text);
    const std::optional<NodeId> hidden =
        before == recursions_.end() ? std::nullopt : std::optional(before->second);
    recursions_[s.label.text] = head;
    SetNext(head, Statements(s.body, next, scope));
    recursions_.erase(s.label.text);
    if (hidden) recursions_[s.label.text] = *hidden;
    return head;
  }

  NodeId Continue(const Stmt& s) {
    const auto it = recursions_.find(s.label.text);
    if (it != recursions_.end() && it->second.valid()) return it->second;
    if (it != recursions_.end()) {
      diagnostics_
          .Report(Kind::kChoreoOutOfScope, s.span,
                  fmt::format("the recursion `{}` is outside this `parallel`", s.label.text))
          .Help("let the threads join, and go on behind the `parallel`");
    } else {
      std::vector<std::string> names;
      for (const auto& [name, head] : recursions_) names.push_back(name);
      declarations_.Undeclared(s.label, "recursion", names);
    }
    return graph_.nodes.empty() ? NodeId() : NodeId(0);
  }

  // The robots whose state an expression reads, and where.
  std::map<RobotId, Span> Owners(ExprId id) const {
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

  void Owned(ExprId guard, RobotId owner) {
    for (const auto& [robot, span] : Owners(guard)) {
      if (robot == owner || !owner.valid()) continue;
      diagnostics_
          .Report(Kind::kChoreoGuardOwner, span,
                  fmt::format("this guard reads the state of `{}`, but `{}` decides", graph_.NameOf(robot),
                              graph_.NameOf(owner)))
          .Help(fmt::format("let `{}` send what it knows to `{}` first", graph_.NameOf(robot),
                            graph_.NameOf(owner)));
    }
  }

  const lang::ExprPool& pool_;
  Declarations& declarations_;
  diag::Diagnostics& diagnostics_;
  Graph graph_;
  std::map<std::string, RobotId, std::less<>> robots_;
  std::map<std::string, NodeId, std::less<>> recursions_;  // invalid: outside the threads that are lowered
};

}  // namespace

std::vector<Graph> Lower(const Module& module, diag::Diagnostics& diagnostics) {
  Declarations declarations(module, diagnostics);
  std::vector<Graph> graphs;
  for (const Item& item : module.items) {
    const auto* choreography = std::get_if<ChoreographyDef>(&item);
    if (choreography == nullptr) continue;
    if (auto graph = Lowering(module, declarations, diagnostics).Run(*choreography))
      graphs.push_back(std::move(*graph));
  }
  return graphs;
}

}  // namespace rondo::choreo
