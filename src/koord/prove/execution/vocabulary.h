#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "expr/arena.h"
#include "koord/check/model.h"

namespace rondo::koord {

using expr::SortId;
using expr::TermId;

/// The state at one moment: for each variable one term; an array over robots for what exists once for each
/// robot.
struct View {
  std::vector<TermId> value;
  TermId stopped;              ///< array over robots: has executed `stop`
  std::string planner_suffix;  ///< which version of the callable ports
};

/// The sorts and symbols that stand for a program's types, variables and functions.
///
/// Variables keep their names. Symbols of our own have a blank in theirs, which no program can write, so that
/// the two never meet.
class Vocabulary {
 public:
  /// `robots`: N_sys as a number when it is fixed; else a constant N_sys >= 1.
  Vocabulary(expr::Arena& arena, const Model& model, std::optional<int64_t> robots);

  SortId SortOf(TypeId type);
  /// The sort of one robot's cell, or of the whole variable if it is shared by all.
  SortId CellSort(size_t variable) { return SortOf(model_.variables[variable].type); }
  View MakeView(const std::string& suffix);
  /// The symbol of an external function; a callable port takes the robot first and has a version.
  expr::SymbolId Function(size_t function, const std::string& planner_suffix);
  expr::SymbolId Dist();
  /// Texts are only known to be equal or not: counterexamples with them are possible, never certain.
  void MarkTexts() { uses_texts_ = true; }
  bool uses_texts() const { return uses_texts_; }
  /// `dist` is known by axioms only, so a model may take a distance that is none.
  bool uses_dist() const { return uses_dist_; }

  /// Can a robot stop at all? If not, no state has to say that it has not.
  bool robots_stop() const { return robots_stop_; }
  TermId robots() const { return robots_; }
  std::optional<int64_t> fixed_robots() const { return fixed_; }
  /// 0 <= i < N_sys
  TermId IsRobot(TermId i);
  /// A constant of the sort of strings for a literal.
  TermId StringLiteral(const std::string& text);
  /// What is true of the vocabulary itself: N_sys >= 1, different literals are different. (For `dist`, see
  /// `Distances`.)
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
  bool uses_texts_ = false;
  bool robots_stop_ = false;
};

}  // namespace rondo::koord
