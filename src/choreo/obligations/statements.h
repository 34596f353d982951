#pragma once

#include <map>
#include <set>
#include <unordered_map>

#include "choreo/obligations/facts.h"
#include "choreo/obligations/obligations.h"

/// States the obligations of choreographies as formulas.
namespace rondo::choreo {

/// Says in words what holds, and what is the matter if it does not.
struct Claim {
  std::string title, failure;
};

/// Returns the claim "X", whose failure is "X may not hold".
Claim Noun(const std::string& title);
/// Returns the claim "a state ...", whose failure is "there is no state ...".
Claim State(const std::string& state);

/// Builds formulas about one choreography, and states obligations: each with those formulas that have to do
/// with it, equal ones once.
class Statements {
 public:
  Statements(const Graph& graph, expr::Arena& arena);

  // -- stating; what follows is about this node and these motions

  NodeId node;
  std::vector<size_t> instances;
  bool bridge = false;  ///< about the way to where `during` begins

  /// States that the last formula has no solution together with the others. Those that share no variable with
  /// it, directly or over others, become the `rest`.
  void Unsat(ObligationKind kind, diag::Span span, const Claim& claim,
             const std::vector<expr::TermId>& formulas);
  /// States that the meeting is impossible: in no state of its configuration do all its shapes have a common
  /// point. What is known of other variables becomes the `rest`.
  void Apart(ObligationKind kind, diag::Span span, const Claim& claim, robot::Meeting meeting);
  /// States that the formulas have a common solution, within the ranges of their variables.
  void Sat(diag::Span span, const Claim& claim, std::vector<expr::TermId> formulas,
           ObligationKind kind = ObligationKind::kContract);
  /// States that the step can be kept (`Keeping`); `formula` only names what is asked, so that equal
  /// obligations are one.
  void Keep(diag::Span span, const Claim& claim, expr::TermId formula, Keeping keeping);
  /// Notes that something is missing without which an obligation cannot be stated, each text once. `region`:
  /// it is the region of a thread.
  void Lacks(diag::Span span, std::string what, bool region = false);
  /// Returns everything that was stated; to be called once, at the end.
  Obligations Take() { return std::move(result_); }

  // -- formulas

  const Graph& graph() const { return graph_; }
  expr::Arena& arena() const { return arena_; }
  /// Takes out of `formulas` what is about the variables of `roots`, or about variables that such formulas
  /// mention, and so on; returns it together with the ranges of all these variables.
  expr::TermId Related(const std::vector<expr::TermId>& roots, std::vector<expr::TermId>& formulas);
  /// Returns that a state, an input or a part of the environment is in its declared range; true if it has
  /// none.
  expr::TermId RangeOf(expr::TermId variable) const;
  /// Returns where a formula is not true, or has no value (`expr::Complement`); `NoneOf`: where none of
  /// several is true.
  expr::TermId Fails(expr::TermId formula) const;
  expr::TermId NoneOf(const std::vector<expr::TermId>& formulas) const;
  expr::TermId Number(const expr::Rational& value) const;
  /// Returns the formula at a moment of the clock.
  expr::TermId AtClock(expr::TermId formula, const expr::Rational& seconds) const;
  /// Returns 0 <= clock <= most, the moments of a motion; `Ended` adds least <= clock, the moments at which
  /// it may end.
  expr::TermId Elapsed(const Duration& d) const;
  expr::TermId Ended(const Duration& d) const;
  /// Returns the variables of a formula; remembers them.
  const std::set<expr::TermId>& VariablesOf(expr::TermId formula);

 private:
  void Add(Obligation obligation);

  const Graph& graph_;
  expr::Arena& arena_;
  std::map<expr::TermId, std::vector<expr::TermId>> ranges_;       // by variable
  std::map<std::pair<expr::TermId, expr::TermId>, size_t> known_;  // formulas with their `rest`: which it is
  std::unordered_map<expr::TermId, std::set<expr::TermId>> variables_;
  Obligations result_;
};

/// Returns the body of a robot. One that is missing is noted as such, and nullptr is returned.
const robot::Shape* BodyOf(Statements& statements, RobotId robot);

/// States what concerns the choreography as a whole: hulls contain bodies, shapes have points, there is a
/// state in which it begins, and in each of them bodies are apart from each other and from obstacles.
void StateWhole(Statements& statements);

/// States what concerns one motion alone: that it can begin, go on and end (Definition 3.4).
void StateContract(Statements& statements, const Instance& instance);

/// States that the motions of a step can be kept at every moment, from wherever `facts` and their
/// preconditions let them begin; `what` names them. States that are not `bridged` begin where they are. Those
/// whose controllers are `proved` keep their contracts anyway.
void StateKeeping(Statements& statements, const Node& step, const std::string& what, const Facts& facts,
                  const std::vector<expr::TermId>& assumptions, const std::set<expr::TermId>& bridged,
                  const std::set<std::string>& proved);

/// Holds the way that a motion has to go where it begins a little beside where an equation of its `during`
/// says that it is.
struct Bridge {
  std::vector<expr::TermId> states;  ///< formulas: on the straight line from where the step begins to there
  std::set<expr::TermId> bridged;    ///< the states that have such a way to go
};

/// Returns the bridge into a step; empty if every motion begins where it says, or may be interrupted at once.
/// Only what an equation determines by what does not move has a bridge.
Bridge BridgeInto(Statements& statements, const Node& step, const Facts& facts,
                  std::vector<expr::TermId> assumptions);

/// States that something can be sent as a message promises, whenever `known` holds: receivers rely on it
/// ([T-Out]).
void StatePromise(Statements& statements, const Node& message, std::vector<expr::TermId> known);

/// Holds one of several things that have to keep apart: a shape, or a region.
struct Member {
  std::string name;
  const robot::Shape* shape = nullptr;
  expr::TermId region;  ///< without a shape
  std::vector<size_t> instances;
};

/// States that no two members have a common point while `known` holds. Of many, each is shown to lie between
/// two planes, and only those whose slabs meet are compared: about linear in their number, if they are spread
/// out.
void StateApart(Statements& statements, ObligationKind kind, diag::Span span,
                const std::vector<Member>& members, const std::vector<expr::TermId>& known);

}  // namespace rondo::choreo
