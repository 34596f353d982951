#include "choreo/process/flow.h"

#include <fmt/format.h>

#include <map>
#include <set>

namespace rondo::choreo {
namespace {

using diag::Kind;
using diag::Span;

class Builder {
 public:
  Builder(const ProcessDef& process, const Graph& graph, Declarations& declarations)
      : process_(process),
        graph_(graph),
        declarations_(declarations),
        diagnostics_(declarations.evaluator().diagnostics()) {}

  std::optional<Flow> Run() {
    const size_t errors = diagnostics_.errors();
    flow_.source = &process_;
    flow_.robot = Robot(process_.robot);
    const FlowId end = Add(FlowKind::kExit, process_.span, nullptr);
    flow_.start = Block(process_.body, end);
    if (diagnostics_.errors() == errors) CheckLoops();
    for (const FlowNode& node : flow_.nodes) {
      for (const FlowCase& c : node.cases) CheckNames(*c.source);
    }
    if (diagnostics_.errors() == errors) CheckAssigned();
    if (diagnostics_.errors() > errors) return std::nullopt;
    return std::move(flow_);
  }

 private:
  FlowId Add(FlowKind kind, Span span, const Act* act) {
    FlowNode node;
    node.kind = kind;
    node.span = span;
    node.act = act;
    node.bindings = bindings_;
    flow_.nodes.push_back(std::move(node));
    return FlowId(flow_.nodes.size() - 1);
  }

  RobotId Robot(const Name& name) {
    if (const auto id = graph_.Find(name.text)) return *id;
    std::vector<std::string> names;
    for (const Name& r : graph_.robots) names.push_back(r.text);
    declarations_.Undeclared(name, "robot", names);
    return {};
  }

  FlowId Block(const std::vector<Act>& acts, FlowId next) {
    for (size_t i = acts.size(); i-- > 0;) {
      const bool ends = acts[i].kind == ActKind::kLoop || acts[i].kind == ActKind::kContinue ||
                        acts[i].kind == ActKind::kExit;
      if (ends && i + 1 < acts.size()) {
        diagnostics_.Report(Kind::kChoreoUnreachable, acts[i + 1].span, "this step is never reached")
            .At(acts[i].span, "what stands here never goes on");
      }
      next = Step(acts[i], next);
    }
    return next;
  }

  // A loop's head is an `if` whose branches are known later.
  FlowId Head(const Act& act) { return Add(FlowKind::kIf, act.span, &act); }

  void Close(FlowId head, FlowId next, FlowId otherwise) {
    flow_.nodes[head.index()].next = next;
    flow_.nodes[head.index()].otherwise = otherwise;
  }

  FlowId Step(const Act& act, FlowId next) {
    switch (act.kind) {
      case ActKind::kSend: {
        const FlowId id = Add(FlowKind::kSend, act.span, &act);
        flow_.nodes[id.index()].peer = Robot(act.peer);
        flow_.nodes[id.index()].next = next;
        return id;
      }
      case ActKind::kReceive:
        return Receive(act, next);
      case ActKind::kMotion:
      case ActKind::kAssign: {
        const FlowId id =
            Add(act.kind == ActKind::kMotion ? FlowKind::kMove : FlowKind::kAssign, act.span, &act);
        flow_.nodes[id.index()].next = next;
        return id;
      }
      case ActKind::kIf: {
        const FlowId id = Head(act);
        Close(id, Block(act.body, next), Block(act.otherwise, next));
        return id;
      }
      case ActKind::kWhile: {
        const FlowId id = Head(act);
        Close(id, Block(act.body, id), next);
        return id;
      }
      case ActKind::kLoop: {
        const FlowId id = Head(act);
        const FlowId body = Block(act.body, id);
        Close(id, body, body);
        return id;
      }
      case ActKind::kRec: {
        const FlowId id = Head(act);
        recursions_.emplace_back(act.label.text, id);
        const FlowId body = Block(act.body, next);
        recursions_.pop_back();
        Close(id, body, body);
        return id;
      }
      case ActKind::kContinue:
        return Continue(act);
      case ActKind::kExit:
        return Add(FlowKind::kExit, act.span, &act);
    }
    return next;
  }

  FlowId Receive(const Act& act, FlowId next) {
    const FlowId id = Add(FlowKind::kReceive, act.span, &act);
    std::vector<FlowCase> cases;
    for (const Case& c : act.cases) {
      if (c.peer.text.empty()) {
        diagnostics_.Report(Kind::kProcessPeer, c.span, "nothing says from whom this comes")
            .Help("write `receive from a { ... }`, or `a.label => ...` in each case");
        continue;
      }
      FlowCase result{&c, Robot(c.peer), {}};
      for (const FlowCase& other : cases) {
        if (other.peer != result.peer || other.source->label.text != c.label.text) continue;
        diagnostics_.Report(Kind::kChoreoDuplicate, c.span, fmt::format("`{}` has two cases", c.label.text))
            .At(other.source->span, "the other one");
      }
      bindings_.push_back(&c);
      result.next = Block(c.body, next);
      bindings_.pop_back();
      cases.push_back(result);
    }
    flow_.nodes[id.index()].cases = std::move(cases);
    return id;
  }

  FlowId Continue(const Act& act) {
    for (size_t i = recursions_.size(); i-- > 0;) {
      if (recursions_[i].first == act.label.text) return recursions_[i].second;
    }
    std::vector<std::string> names;
    for (const auto& [name, id] : recursions_) names.push_back(name);
    declarations_.Undeclared(act.label, "recursion", names);
    return FlowId(0);
  }

  // What a message carries is not assigned to: its name stands for it everywhere behind.
  void CheckNames(const Case& c) {
    for (const Name& name : c.names) {
      for (const FlowNode& node : flow_.nodes) {
        if (node.kind != FlowKind::kAssign || node.act->variable.text != name.text) continue;
        diagnostics_
            .Report(Kind::kChoreoDuplicate, node.act->variable.span,
                    fmt::format("`{}` names what a message carries, and is not assigned to", name.text))
            .At(name.span, "named here")
            .Help("choose another name");
      }
    }
  }

  static std::vector<FlowId> Next(const FlowNode& node) {
    std::vector<FlowId> next;
    for (const FlowCase& c : node.cases) next.push_back(c.next);
    if (node.next.valid()) next.push_back(node.next);
    if (node.otherwise.valid()) next.push_back(node.otherwise);
    return next;
  }

  // A name of the process has a value on every way on which it is read.
  void CheckAssigned() {
    std::set<std::string> names;
    for (const FlowNode& node : flow_.nodes) {
      if (node.kind == FlowKind::kAssign) names.insert(node.act->variable.text);
    }
    if (names.empty()) return;
    std::map<FlowId, std::set<std::string>> assigned{{flow_.start, {}}};
    std::vector<FlowId> todo{flow_.start};
    while (!todo.empty()) {
      const FlowId id = todo.back();
      todo.pop_back();
      std::set<std::string> after = assigned.at(id);
      if (flow_[id].kind == FlowKind::kAssign) after.insert(flow_[id].act->variable.text);
      for (const FlowId next : Next(flow_[id])) {
        const auto [it, fresh] = assigned.emplace(next, after);
        const size_t before = it->second.size();
        std::erase_if(it->second, [&](const std::string& name) { return !after.contains(name); });
        if (fresh || it->second.size() != before) todo.push_back(next);
      }
    }
    for (const auto& [id, known] : assigned) {
      const FlowNode& node = flow_[id];
      if (node.act == nullptr) continue;
      std::vector<ExprId> read = node.act->values;
      if (node.act->guard.valid()) read.push_back(node.act->guard);
      for (const Argument& a : node.act->motion.args) read.push_back(a.value);
      const lang::ExprPool& pool = declarations_.evaluator().pool();
      while (!read.empty()) {
        const lang::Expr& e = pool[read.back()];
        read.pop_back();
        read.insert(read.end(), e.args.begin(), e.args.end());
        if (e.kind != lang::ExprKind::kName || !names.contains(e.text) || known.contains(e.text)) continue;
        diagnostics_
            .Report(Kind::kChoreoUndeclared, e.span, fmt::format("`{}` may have no value yet here", e.text))
            .Help("assign to it on every way that leads here");
      }
    }
  }

  // From no branch of a loop may control come back without a step.
  void CheckLoops() {
    enum class Mark : uint8_t { kNew, kOpen, kDone };
    std::vector<Mark> marks(flow_.nodes.size(), Mark::kNew);
    for (size_t i = 0; i < flow_.nodes.size(); ++i) {
      std::vector<std::pair<FlowId, size_t>> path{{FlowId(i), 0}};
      if (marks[i] != Mark::kNew) continue;
      marks[i] = Mark::kOpen;
      while (!path.empty()) {
        auto& [id, child] = path.back();
        const FlowNode& node = flow_[id];
        const bool silent = node.kind == FlowKind::kIf || node.kind == FlowKind::kAssign;
        const size_t children = !silent ? 0 : node.kind == FlowKind::kIf ? 2 : 1;
        if (child >= children) {
          marks[id.index()] = Mark::kDone;
          path.pop_back();
          continue;
        }
        const FlowId next = child++ == 0 ? node.next : node.otherwise;
        if (marks[next.index()] == Mark::kOpen) {
          diagnostics_
              .Report(Kind::kChoreoUnguarded, flow_[next].span, "this loop may go round without a step")
              .Help("put a message or a motion on every way back to its beginning");
          return;
        }
        if (marks[next.index()] == Mark::kNew) {
          marks[next.index()] = Mark::kOpen;
          path.emplace_back(next, 0);
        }
      }
    }
  }

  const ProcessDef& process_;
  const Graph& graph_;
  Declarations& declarations_;
  diag::Diagnostics& diagnostics_;
  Flow flow_;
  std::vector<const Case*> bindings_;
  std::vector<std::pair<std::string, FlowId>> recursions_;
};

}  // namespace

std::optional<Flow> BuildFlow(const ProcessDef& process, const Graph& graph, Declarations& declarations) {
  return Builder(process, graph, declarations).Run();
}

}  // namespace rondo::choreo
