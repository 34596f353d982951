#pragma once

#include <string>
#include <vector>

#include "koord/prove/obligations/round.h"

namespace rondo::koord {

/// The specification as named formulas over views. Names are what reports call them.
class Theory {
 public:
  Theory(Vocabulary& vocabulary, Executor& executor);

  /// `for all robots r: body(r)`; spelled out when the robots are.
  TermId ForEachRobot(const std::function<TermId(TermId)>& body);

  /// Functions whose summaries speak of nothing but their own arguments and result.
  std::vector<size_t> SummarisedFunctions();
  /// For some arguments, every result contradicts a summary of function `f`.
  TermId NoResult(size_t f);
  /// The general assumptions that mention no function.
  std::vector<solve::Assertion> Facts();

  /// Axioms of the vocabulary, general assumptions, summaries: true at any time.
  std::vector<solve::Assertion> Background();
  /// Declared initial values, at `view`, for each robot.
  std::vector<solve::Assertion> DeclaredValues(const View& view);
  /// `assume initially`, at `view`.
  std::vector<solve::Assertion> Initially(const View& view);
  /// Controller assumptions without `when`: true of the ports of every robot at every moment.
  std::vector<solve::Assertion> PortFacts(const View& view);
  /// Controller assumptions about the environment transition of one robot: P at `round.settled()` implies Q
  /// at the end.
  std::vector<solve::Assertion> PortPromises(Round& round, TermId robot);

  struct Promise {
    const AssumeDef* def;
    std::string name;
    TermId condition;  ///< P, at the settled view
    TermId promise;    ///< Q, at `end`
  };
  /// The assumptions with `when` (or `old`) for one robot, their Q evaluated at `end`.
  std::vector<Promise> Promises(const View& settled, const View& end, TermId robot);

  size_t invariants() const { return model_.invariants.size(); }
  TermId Invariant(size_t i, const View& view);
  /// All invariants at `view`, each in its group `invariant NAME`.
  std::vector<solve::Assertion> Invariants(const View& view);

  size_t FunctionOf(const SummaryDef& def) const;
  /// External functions that are called; `summarised`: those with a summary, else those without.
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
