#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "expr/arena.h"
#include "koord/check/model.h"

/// Maps the types, variables and functions of a program to sorts and symbols of the solver.
namespace rondo::koord {

using expr::SortId;
using expr::TermId;

/// Holds the state at one moment: for each variable one term, which is an array over robots for what exists
/// once for each robot.
struct View {
  std::vector<TermId> value;
  TermId stopped;              ///< an array over robots: whether the robot has executed `stop`
  std::string planner_suffix;  ///< names the version of the callable ports at this moment
};

/// Makes the sorts and symbols that stand for a program's types, variables and functions.
///
/// Variables keep their names. Symbols of our own have a blank in theirs, which no program can write, so that
/// the two never meet.
class Vocabulary {
 public:
  /// Declares what a proof needs. `robots`: N_sys as a number when it is fixed; else N_sys is a constant of
  /// which N_sys >= 1 is known.
  Vocabulary(expr::Arena& arena, const Model& model, std::optional<int64_t> robots);

  /// Returns the sort of the values of a type.
  SortId SortOf(TypeId type);
  /// Returns the sort of one robot's cell, or of the whole variable if it is shared by all.
  SortId CellSort(size_t variable) { return SortOf(model_.variables[variable].type); }
  /// Returns a state of which nothing is known; the names of its symbols end with `suffix`. The same suffix
  /// gives the same state.
  View MakeView(const std::string& suffix);
  /// Returns the symbol of an external function; that of a callable port takes the robot first and has a
  /// version.
  expr::SymbolId Function(size_t function, const std::string& planner_suffix);
  /// Returns the symbol of the distance of two points (see `Distances`).
  expr::SymbolId Dist();
  /// Returns the symbols of `floor`, from a real to an int, and of `sqrt` (see `Roundings`).
  expr::SymbolId Floor();
  expr::SymbolId Sqrt();
  /// Reports whether one of them occurs.
  bool uses_roundings() const { return uses_roundings_; }
  /// Notes that the problem has texts. These are only known to be equal or not: counterexamples with them are
  /// possible, never certain.
  void MarkTexts() { uses_texts_ = true; }
  bool uses_texts() const { return uses_texts_; }
  /// Reports whether `dist` occurs. It is known by axioms only, so a model may take a distance that is none.
  bool uses_dist() const { return uses_dist_; }

  /// Reports whether a robot can stop at all. If not, no state has to say that it has not.
  bool robots_stop() const { return robots_stop_; }
  /// Returns N_sys.
  TermId robots() const { return robots_; }
  std::optional<int64_t> fixed_robots() const { return fixed_; }
  /// Returns the formula 0 <= i < N_sys.
  TermId IsRobot(TermId i);
  /// Returns the constant, of the sort of strings, that stands for a literal; one for each text.
  TermId StringLiteral(const std::string& text);
  /// Returns what is true of the vocabulary itself: N_sys >= 1, different literals are different. (For
  /// `dist`, see `Distances`.)
  std::vector<TermId> Axioms();

  expr::Arena& arena() { return arena_; }
  const Model& model() const { return model_; }

 private:
  expr::Arena& arena_;
  const Model& model_;
  std::optional<int64_t> fixed_;
  TermId robots_;
  std::unordered_map<TypeId, SortId> sorts_;
  std::vector<TermId> literals_;
  bool uses_dist_ = false;
  bool uses_roundings_ = false;
  bool uses_texts_ = false;
  bool robots_stop_ = false;
};

}  // namespace rondo::koord
