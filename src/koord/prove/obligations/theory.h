#pragma once

#include <string>
#include <vector>

#include "koord/prove/obligations/round.h"

/// States specifications of Koord programs as formulas.
namespace rondo::koord {

/// States the parts of a specification as named formulas over views. Names are what reports call the parts,
/// so that unsatisfiable cores say what a proof used.
class Theory {
 public:
  Theory(Vocabulary& vocabulary, Executor& executor);

  /// Returns `for all robots r: body(r)`; spelled out as a conjunction when the executor spells robots out.
  TermId ForEachRobot(const std::function<TermId(TermId)>& body);

  /// Returns the functions whose summaries speak of nothing but their own arguments and result, a plain
  /// value: for these, it can be asked whether a result is possible at all.
  std::vector<size_t> SummarisedFunctions();
  /// Returns the formula that for some arguments every result contradicts a summary of function `f`.
  TermId NoResult(size_t f);
  /// Returns the general assumptions that call no function, and the values of parameters.
  std::vector<solve::Assertion> Facts();

  /// Returns what is true at any time: axioms of the vocabulary, general assumptions, summaries, values of
  /// parameters.
  std::vector<solve::Assertion> Background();
  /// Returns that variables have their declared initial values at `view`, for each robot, and that no robot
  /// has stopped.
  std::vector<solve::Assertion> DeclaredValues(const View& view);
  /// Returns the assumptions `assume initially`, at `view`.
  std::vector<solve::Assertion> Initially(const View& view);
  /// Returns the controller assumptions without `when` and `old`: they are true of the ports of every robot
  /// at every moment.
  std::vector<solve::Assertion> PortFacts(const View& view);
  /// Returns the controller assumptions about the environment transition of one robot, for each leg of the round: P at
  /// its start implies Q at its end (rule RobotEnv).
  std::vector<solve::Assertion> PortPromises(Round& round, TermId robot, bool over);

  /// Holds a controller assumption (the paper's (P, Q)) of one robot.
  struct Promise {
    const AssumeDef* def;
    std::string name;
    TermId condition;  ///< P, at the settled view
    TermId promise;    ///< Q, at the end
  };
  /// Returns the assumptions with `when` (or `old`) for one robot, with P at `settled` and Q at `end`.
  std::vector<Promise> Promises(const View& settled, const View& end, TermId robot);

  size_t invariants() const { return model_.invariants.size(); }
  /// Returns invariant `i` at `view`, for every robot if it is about robots.
  TermId Invariant(size_t i, const View& view);
  /// Returns all invariants at `view`, each in its group `invariant NAME`; at any moment without those that hold between
  /// rounds only.
  std::vector<solve::Assertion> Invariants(const View& view, bool between_rounds);

  /// Returns the number of the function that a summary is about.
  size_t FunctionOf(const SummaryDef& def) const;
  /// Returns the names of external functions that are called: with `summarised` those that have a summary,
  /// else those that have none.
  std::vector<std::string> External(bool summarised) const;

 private:
  TermId PerRobot(ExprId e, const View& view);
  TermId Summary(const SummaryDef& def);
  bool CallsFunctions(ExprId e) const;

  Vocabulary& vocabulary_;
  Executor& executor_;
  expr::Arena& arena_;
  const Model& model_;
};

}  // namespace rondo::koord
