#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "koord/prove/obligations/distances.h"
#include "koord/prove/obligations/extremes.h"
#include "koord/prove/obligations/roundings.h"
#include "koord/prove/obligations/theory.h"
#include "solve/instantiate.h"

/// States the questions of a proof, ready for a solver.
namespace rondo::koord {

/// Holds a question whose answer should be "unsatisfiable" (an obligation) or "satisfiable" (a sanity check).
struct Problem {
  std::vector<solve::Assertion> assertions;  ///< with quantifiers
  solve::Query query;                        ///< without; see `Problems::Ground`
  bool complete = false;                     ///< nothing was lost: satisfiable means satisfiable
  std::vector<TermId> participants;
  std::unordered_set<TermId> lists;  ///< the lists whose axioms are among the assertions

  /// Returns the query with whatever its instances do not cover: what satisfies it satisfies the problem.
  solve::Query Whole() const;
};

/// States the proof obligations of docs/theory.md for one program and one number of robots: any (symbolic),
/// or a small fixed one with all quantifiers over robots spelled out, whose models are witnesses.
class Problems {
 public:
  struct Options {
    std::optional<int64_t> robots;
    bool expand = false;
  };
  Problems(expr::Arena& arena, const Model& model, const Options& options, diag::Diagnostics& diagnostics);

  Theory& theory() { return theory_; }
  Round& round() { return round_; }
  bool has_init() const { return init_.has_value(); }
  size_t columns() const { return round_.actions().size(); }

  /// States [Init]: every initial state satisfies invariant i.
  Problem Initially(size_t invariant);
  /// States [Step]: from a state that satisfies all invariants, invariant i holds at every moment of a round
  /// in which `action` is the first, in program order, that a participant takes (0: all skip; none: any
  /// round).
  /// @param reachable  the state at the start is initial as well.
  Problem Step(size_t invariant, std::optional<size_t> action, bool reachable);
  /// States [Cut]: the same, for rounds in which robots may be cut off from the others.
  Problem CutOff(size_t invariant, std::optional<size_t> action, CutOffLimits leaves_out,
                 bool reachable = false);
  /// Returns the round of these problems.
  Round& cut_off(CutOffLimits leaves_out);
  /// Reports whether there are robots that the denied invariant reads, whose actions are the cases of `Step`.
  /// Else a round has one case: what any robot does.
  bool HasCases(size_t invariant);
  /// States [Follows]: at any moment, invariant i follows from the premises, invariants that hold at the same
  /// moment.
  Problem Follows(size_t invariant, const std::vector<size_t>& premises);
  /// States [Def]: every operation of the action, or of a part of the specification, is defined wherever it
  /// is reached.
  Problem Defined(size_t place);
  /// States [Def] for one operation of one robot, which is one of `ChecksAt(place, robot)`.
  Problem DefinedAt(size_t place, const DefinednessCheck& check, TermId robot);
  /// Returns the operations of `place`, an action or `specification(part)`, as `robot` runs it.
  std::vector<DefinednessCheck> ChecksAt(size_t place, TermId robot);
  /// Returns the same for the robot of the problems about one robot.
  std::vector<DefinednessCheck> ChecksOf(size_t place) { return ChecksAt(place, robot_); }
  /// Names the parts of the specification, which are places behind those of the actions. Every operation must
  /// have a value, where what is assumed of the same part holds.
  enum class Part : uint8_t { kInvariants, kPorts, kInitial, kFacts };
  static constexpr size_t kParts = 4;
  size_t specification(Part part) const { return round_.actions().size() + static_cast<size_t>(part); }
  /// Returns what reports call an action or part of the specification.
  std::string NameOf(size_t place) const;
  /// Returns the place of a fallback, by its number in the model.
  size_t fallback(size_t f) const { return round_.actions().size() + kParts + f; }

  /// States a sanity check: satisfiable if for some arguments no result of function `f` satisfies its
  /// summaries.
  Problem ImpossibleSummary(size_t f);
  /// States [Sat]: there is an initial state.
  Problem SomeInitialState();
  /// States [Sat]: general assumptions and summaries allow the values that the action computes.
  Problem SomeValues(size_t action);
  /// States [Sat]: some state that satisfies the invariants enables the event.
  Problem SomeEnabled(size_t action);
  /// States [Sat]: where the condition of promise `p` holds, the environment can keep it and all others.
  /// @param with  states that it keeps them; else only that the condition holds.
  Problem SomePromise(size_t p, bool with);
  /// Asks for a state that satisfies the invariants, in which both of these promises are due; `kept`: and for what the
  /// environment can make of it that keeps both.
  Problem BothPromises(size_t a, size_t b, bool kept);
  /// States [Now]: where the invariants and the condition of promise `p` hold, the promise holds at t = 0.
  Problem PromiseNow(size_t p);
  /// Returns the promises of one robot in a round; their places are the numbers `p` above.
  std::vector<Theory::Promise> promises() { return theory_.Promises(round_.settled(), round_.end(), robot_); }

  /// Says how quantifiers are instantiated from now on, and what is said of distances.
  solve::InstantiationLimits limits;
  Distances::Detail distances = Distances::Detail::kAll;

  /// Returns the robot of the problems about one robot: any.
  TermId robot() const { return robot_; }
  TermId size() const { return vocabulary_.robots(); }
  bool uses_dist() const { return vocabulary_.uses_dist(); }
  Vocabulary& vocabulary() { return vocabulary_; }

 private:
  const std::vector<solve::Assertion>& Everything(const View& view, bool between_rounds);
  std::vector<TermId> Everyone();
  void Instantiate(Problem& problem);
  void AddDistances(Problem& problem);
  Problem WithWitnesses(TermId refuted, const std::function<Problem(const std::vector<TermId>&)>& state);
  Problem InitiallyFor(TermId refuted, const std::vector<TermId>& others);
  void ActuatorsStay(std::vector<solve::Assertion>& assertions);
  Problem StepFor(Round& round, TermId refuted, const std::vector<TermId>& others,
                  std::optional<size_t> action, bool reachable, bool at_rounds);
  std::vector<TermId> Witnesses(const Problem& problem);
  TermId Succeeds(Round& round);
  TermId First(Round& round, size_t action);
  TermId Refute(TermId goal);
  const Effect& EffectAt(size_t action, TermId robot);
  std::vector<DefinednessCheck> ChecksOfPart(Part part, TermId robot);
  Problem Undefined(size_t place, TermId undefined, TermId robot);
  Problem Ground(std::vector<solve::Assertion> assertions, std::vector<TermId> participants);

  expr::Arena& arena_;
  const Model& model_;
  Options options_;
  Vocabulary vocabulary_;
  Executor executor_;
  Theory theory_;
  Round round_;
  std::optional<Round> init_;
  std::map<std::pair<bool, bool>, Round> cut_offs_;  // by their limits
  TermId robot_;
  // By the array `stopped` of the view, and whether it is between rounds.
  std::map<std::pair<TermId, bool>, std::vector<solve::Assertion>> everything_;
  // By robot, and whether the round is over.
  std::map<std::tuple<const Round*, TermId, bool>, std::vector<solve::Assertion>> promises_;
  std::vector<solve::Assertion> background_;
  std::optional<Extremes> extremes_;
  solve::Witnesses witnesses_;
};

/// Puts assertions behind others.
inline void Append(std::vector<solve::Assertion>& to, std::vector<solve::Assertion> from) {
  for (solve::Assertion& a : from) to.push_back(std::move(a));
}

}  // namespace rondo::koord
