#pragma once

#include <map>
#include <optional>

#include "choreo/graph/calls.h"

/// Shares what both ways of writing choreographies need to make their graphs.
namespace rondo::choreo {

/// Tells which robots a thread mentions, and which of them move in it.
struct ThreadRobots {
  Scope mentioned, moving;
};

/// Makes the nodes of a graph and checks what concerns one node alone: names, arguments, units, owners of
/// guards, and which robot belongs to which thread (rule 1, scopes; docs/theory.md, "Choreographies"). A base
/// of the classes that lower one way of writing each.
class NodeBuilder {
 public:
  explicit NodeBuilder(Declarations& declarations)
      : declarations_(declarations),
        evaluator_(declarations.evaluator()),
        pool_(evaluator_.pool()),
        diagnostics_(evaluator_.diagnostics()),
        calls_(graph_, declarations) {}
  NodeBuilder(const NodeBuilder&) = delete;
  NodeBuilder& operator=(const NodeBuilder&) = delete;

 protected:
  /// Reads world, options and initial state. Returns all robots, or nothing after a report.
  std::optional<Scope> Begin(const ChoreographyDef& source);
  /// Returns the graph, unless an error was reported since `Begin`.
  std::optional<Graph> Finish();

  /// Puts a node into the graph. Its successors may be set later.
  NodeId Add(Node node);
  static Node Make(NodeKind kind, diag::Span span, const Scope& scope);
  Node MakeMessage(const Stmt& s, const Scope& scope);
  Node MakeMotion(const Stmt& s, const Scope& scope);
  /// Makes a fork without successors and without its join. `threads`: by branch.
  Node MakeFork(const Stmt& s, const std::vector<ThreadRobots>& threads, const Scope& scope);
  /// Adds the next alternative to a choice. An invalid guard stands for "where the ones before do not hold".
  void AddGuard(ExprId guard, Node& choice);
  /// Adds the robots that one step mentions, and those that move in it.
  void Mentions(const Stmt& s, ThreadRobots& thread) const;
  /// Returns the robot of this name if it is in scope; else an invalid id, after a report.
  RobotId Robot(const Name& name, const Scope& scope);
  /// Reports a variable that the robot would have to know to evaluate these terms, but cannot.
  void NeedKnown(const std::vector<expr::TermId>& terms, diag::Span span, RobotId robot);
  /// Returns the robots whose state an expression reads, and where it does.
  std::map<RobotId, diag::Span> Owners(ExprId id) const;

  Declarations& declarations_;
  robot::Evaluator& evaluator_;
  const lang::ExprPool& pool_;
  diag::Diagnostics& diagnostics_;
  Graph graph_;

 private:
  void AddPayload(const Payload& payload, robot::Scope& scope, std::vector<expr::TermId>& known, Node& node);
  std::vector<Scope> Threads(const Stmt& s, const std::vector<ThreadRobots>& threads, const Scope& scope);
  ThreadFacts Facts(const Branch& branch);
  void CheckCoupling(const Stmt& s, const Node& fork, const Scope& scope);

  Calls calls_;
  std::map<std::string, RobotId, std::less<>> robots_;
  size_t errors_ = 0;
};

}  // namespace rondo::choreo
