#include <fmt/format.h>

#include <map>
#include <set>

#include "choreo/wellformed/wellformed.h"

namespace rondo::choreo {
namespace {

using diag::Kind;

class Choices {
 public:
  Choices(const Graph& graph, diag::Diagnostics& diagnostics) : graph_(graph), diagnostics_(diagnostics) {}

  void Run() {
    for (const Node& n : graph_.nodes) {
      // A robot that is alone has nobody to tell.
      if (n.kind == NodeKind::kChoice && n.scope.size() > 1) Check(n);
    }
  }

 private:
  // What may come first behind `start`: steps, or ends of the thread.
  std::set<NodeId> First(NodeId start) const {
    std::set<NodeId> seen, first;
    std::vector<NodeId> todo{start};
    while (!todo.empty()) {
      const NodeId id = todo.back();
      todo.pop_back();
      if (!seen.insert(id).second) continue;
      const Node& n = graph_[id];
      if (n.kind == NodeKind::kMerge || n.kind == NodeKind::kChoice) {
        todo.insert(todo.end(), n.next.begin(), n.next.end());
      } else {
        first.insert(id);
      }
    }
    return first;
  }

  void Check(const Node& choice) {
    std::map<std::pair<RobotId, std::string>, std::pair<size_t, NodeId>> labels;
    const std::string& chooser = graph_.NameOf(choice.chooser);
    for (size_t b = 0; b < choice.next.size(); ++b) {
      for (const NodeId id : First(choice.next[b])) {
        const Node& n = graph_[id];
        if (n.kind != NodeKind::kMessage || n.from != choice.chooser) {
          Silent(choice, n);
          continue;
        }
        const auto [it, fresh] = labels.emplace(std::pair(n.to, n.label), std::pair(b, id));
        if (fresh || it->second.first == b || it->second.second == id) continue;
        diagnostics_
            .Report(Kind::kChoreoChoiceLabel, n.span,
                    fmt::format("`{}` cannot tell two alternatives of `{}` apart: both begin with `{}`",
                                graph_.NameOf(n.to), chooser, n.label))
            .At(graph_[it->second.second].span, "the other one")
            .Help("give the messages different labels");
      }
    }
  }

  void Silent(const Node& choice, const Node& n) {
    const std::string& chooser = graph_.NameOf(choice.chooser);
    const bool step = n.kind == NodeKind::kMessage || n.kind == NodeKind::kMotion;
    auto& report = diagnostics_.Report(
        Kind::kChoreoChoiceSilent, step ? n.span : choice.span,
        step ? fmt::format("`{}` has chosen, but this step does not tell the others", chooser)
             : fmt::format("one alternative of `{}` ends without a word to the others", chooser));
    if (step) report.At(choice.span, "the choice is here");
    report.Note("the other robots of the thread cannot see which alternative was taken")
        .Help(fmt::format("let each alternative begin with a message of `{}`", chooser));
  }

  const Graph& graph_;
  diag::Diagnostics& diagnostics_;
};

}  // namespace

void CheckChoices(const Graph& graph, diag::Diagnostics& diagnostics) { Choices(graph, diagnostics).Run(); }

void CheckWellFormed(const Graph& graph, diag::Diagnostics& diagnostics) {
  CheckChoices(graph, diagnostics);
  CheckSynchronisation(graph, diagnostics);
  CheckTime(graph, diagnostics);
  CheckDurations(graph, diagnostics);
}

}  // namespace rondo::choreo
