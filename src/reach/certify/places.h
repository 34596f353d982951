#pragma once

#include "reach/problem/formula.h"
#include "reach/problem/invariant.h"

/// An invariant of modes as its checker sees it, compiled.
namespace rondo::reach::certify {

/// Says how far around an invariant rates are looked at, if need be: any number above zero would do.
inline constexpr double kAround = 0x1p-24;

/// Says what leads out of a mode.
struct Way {
  size_t to = 0;  ///< the place; SIZE_MAX if the invariant does not mention it
  Formula condition;
  size_t first = 0;    ///< where its terms begin among the outputs of the program
  bool known = false;  ///< whether all of its terms are continuous: else nothing is said about where it holds
};

/// Is a mode as the invariant has it. Outputs of the program: rates, conjuncts, conditions, claims. Variables:
/// states, then inputs.
struct Place {
  Mode mode;
  std::vector<TermId> terms;  ///< of conjuncts: each is at most zero
  std::vector<Way> ways;
  std::vector<std::pair<size_t, Formula>> claims;  ///< where their terms begin, as in the problem
  Program program;
  interval::Box box;  ///< encloses where the conjuncts hold, up to a little more (`kAround`); perhaps empty
};

/// Holds all modes that an invariant mentions, and what is assumed at the start.
class Places {
 public:
  /// Compiles the invariant. The problem must outlive the result.
  ///
  /// @error says why this is no invariant of the problem: the first mode, or what an event leads to, makes no sense,
  /// something may jump, or a state is not bounded.
  static base::Result<Places> Of(const Problem& problem, const Invariant& invariant);

  const std::vector<Place>& all() const { return all_; }
  const Place& operator[](size_t place) const { return all_[place]; }
  /// Returns the place of the first mode.
  size_t first() const { return Find(modes_.start()); }
  /// Returns the place of the mode; SIZE_MAX if there is none.
  size_t Find(const Mode& mode) const;
  const Modes& modes() const { return modes_; }
  const std::vector<TermId>& variables() const { return variables_; }
  /// Returns what every start satisfies, bounds of the initial box among it, and its terms compiled.
  const Formula& assumed() const { return assumed_; }
  const Program& assumed_terms() const { return assumed_terms_; }
  /// Reports whether every term of the formula, whose terms begin there among the outputs, is continuous.
  static bool AreContinuous(const Place& place, size_t first, const Formula& formula);

 private:
  std::string Compile(const Invariant& invariant);
  std::string CompilePlace(Place& place);
  TermId InFirstBox() const;
  bool Enclose();

  const Problem* problem_ = nullptr;
  std::vector<TermId> variables_;
  Modes modes_;
  std::vector<Place> all_;
  Formula assumed_;
  Program assumed_terms_;
};

}  // namespace rondo::reach::certify
