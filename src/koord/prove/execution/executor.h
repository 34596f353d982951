#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <unordered_set>
#include <utility>
#include <vector>

#include "diag/diagnostic.h"
#include "koord/prove/execution/vocabulary.h"

/// Executes Koord symbolically: expressions become terms, an event becomes its guard and the values that it
/// leaves (Koord paper, Figs. 6-8; rules are named at the code that follows them).
namespace rondo::koord {

/// Names why an operation may be undefined: an index, a zero divisor, the root of a negative number, an absent item, a loop over a
/// longer list than was unrolled, one that is repeated more often than it says, a function without a result, an `any` without values.
enum class CheckKind : uint8_t {
  kIndex,
  kDivision,
  kRoot,
  kRemove,
  kUnrolling,
  kRepeating,
  kReturn,
  kChoice
};
/// States what must hold for one operation to be defined: where control reaches it (`reached`), `holds`.
struct DefinednessCheck {
  CheckKind kind;
  diag::Span span;
  TermId reached;
  TermId holds;
};

/// Records a read of something that other robots or the environment write, for the table of a witness.
struct ReadRecord {
  size_t variable;
  TermId index;  ///< the robot whose cell was read; invalid for a port or a variable shared by all
  TermId value;
  TermId reached;
};

/// Records a write to a variable that every robot may write, if `condition` holds: to the whole, if there are
/// no indices.
struct SharedWrite {
  size_t variable;
  TermId condition;
  std::vector<TermId> indices;  ///< of a cell, or of the part of an array that has all cells behind them
};

/// Describes what one robot does when it executes an event, in terms of the values at the start of the round.
struct Effect {
  TermId enabled;
  TermId locks;  ///< it takes the lock of the event (`atomic`)
  TermId stops;
  TermId chosen;              ///< what `any` chooses is among its values
  std::vector<TermId> value;  ///< afterwards: its own cell of what exists for each robot, else the whole
  std::vector<SharedWrite> writes;
  std::vector<DefinednessCheck> checks;
  std::vector<ReadRecord> reads;
};

/// Says how far execution goes.
struct ExecutionOptions {
  int64_t unrolling = 256;     ///< how many iterations of one loop are executed at most
  bool expand_robots = false;  ///< quantifiers over robots become conjunctions; N_sys must be fixed
};

/// Executes events and evaluates specifications of one program over terms.
class Executor {
 public:
  Executor(Vocabulary& vocabulary, diag::Diagnostics& diagnostics, ExecutionOptions options = {});

  /// Executes an event: rule SelectEvent and its statements, for `robot`, from `start`. Everything is read
  /// from the robot's own copy: the values at `start` and its own writes (Var-Lookup).
  Effect Run(const EventDef& event, const View& start, TermId robot);
  /// Executes the `init` blocks in order, as one event without guard.
  Effect RunInit(const View& start, TermId robot);

  /// Returns the value of an expression of a specification at `view`. `robot` stands for the robot of names
  /// without one; it is only looked at if there are such names. `old` is the moment of `old(...)`, or
  /// nullptr.
  TermId Specification(ExprId e, const View& view, TermId robot, const View* old,
                       const std::map<uint32_t, TermId>& bindings);
  /// Returns the formula that `whole`, a variable or the cell of a robot, has its declared initial value. Reports it if the
  /// value may not exist.
  TermId HasInitialValue(size_t variable, TermId whole, const View& parameters, TermId robot);
  /// Returns an initial value for `robot`: an expression over parameters, as a value of `type`. Reports it if
  /// it may have none.
  TermId Value(ExprId e, TypeId type, const View& parameters, TermId robot);
  /// Returns what is known of the folds over robots that were evaluated so far (`min i in ID: e`), unless they were spelled
  /// out: of `min` and the like everything; of `count` whether it is 0, 1, more, or all; of `sum` its sign by those of its parts;
  /// of both, how their values at different moments differ if at most one robot changes, or all in one direction.
  const std::vector<TermId>& Folds() const { return folds_; }
  /// Reports whether a formula speaks of a fold that is not spelled out.
  bool MentionsFold(TermId formula) const;
  /// Reports whether quantifiers over robots become conjunctions.
  bool expands_robots() const { return options_.expand_robots; }
  /// Reports whether the last specification mentioned the robot.
  bool used_robot() const { return used_robot_; }
  /// Returns what must hold for the specifications evaluated since the last call to have values: each
  /// operation of theirs is defined where it is reached.
  std::vector<DefinednessCheck> TakeSpecificationChecks() { return std::exchange(specification_checks_, {}); }

 private:
  struct State {
    std::vector<TermId> value;
    TermId path;       // control reaches this point
    TermId broke;      // left the innermost loop
    TermId continued;  // left the current iteration
    TermId ended;      // left the event or function
    TermId locked;
    TermId stopped;
    TermId result;  // of the function that is being executed
  };
  struct Frame {
    const View* view = nullptr;
    const View* old = nullptr;
    TermId robot;
    bool in_specification =
        false;  // a function is executed for its value: names mean what they mean at `view`
    State* state = nullptr;
    Effect* effect = nullptr;
    std::map<uint32_t, TermId> bindings;
  };

  State StartState(const View& start, TermId robot);
  Effect Finish(State& state, Effect effect);

  // evaluate.cc
  TermId Eval(ExprId id);
  TermId EvalAs(ExprId id, TypeId type);
  TermId As(TermId term, SortId sort);
  TermId Unary(const lang::Expr& e);
  TermId Binary(const lang::Expr& e);
  TermId Arithmetic(const lang::Expr& e);
  TermId Membership(const lang::Expr& e);
  TermId Contains(TermId list, TermId element);
  /// Returns what `+` makes of two strings: to proofs only that it is a function matters.
  TermId Concatenate(TermId a, TermId b);
  TermId Quantifier(ExprId id, const lang::Expr& e);
  TermId Any(ExprId id, const lang::Expr& e);
  // folds.cc
  TermId Fold(ExprId id, const lang::Expr& e);
  TermId Folded(FoldKind kind, const std::vector<TermId>& values);
  TermId Plus(TermId a, TermId b);
  TermId Defined(FoldKind kind, TermId robot, TermId body, const std::vector<TermId>& parameters);
  // A number of robots, or a sum over them: of what, and its value.
  struct Additive {
    TermId robot, body, value;
  };
  void Compare(FoldKind kind, ExprId id, const Additive& now);
  TermId SomeRobot(const char* name);
  TermId Of(const Additive& fold, TermId robot);
  void OneOrTwo(const std::function<TermId(TermId)>& is_so, TermId first, TermId another);
  void Signs(const Additive& sum);
  void Changes(const Additive& from, const Additive& to);
  void Grows(const Additive& from, const Additive& to);
  void Differences(const Additive& a, const Additive& b);
  TermId MakeArray(ExprId id, const lang::Expr& e);
  TermId Filled(TermId whole, TypeId type, TermId value);
  TermId ReadVariable(size_t variable);
  TermId ReadCell(size_t variable, TermId robot, ExprId at);
  TermId Index(ExprId id, const lang::Expr& e);
  TermId Junction(bool conjunction, const std::vector<TermId>& parts);
  TermId Robot();
  bool InProgram() const { return frame_.state != nullptr && !frame_.in_specification; }
  /// Evaluates `e` where control reaches it only if `condition` holds.
  TermId Under(TermId condition, ExprId e);
  void Check(CheckKind kind, diag::Span span, TermId holds);
  TermId Reached() const;

  // calls.cc
  TermId Call(ExprId id, const lang::Expr& e);
  TermId CallFunction(const lang::Expr& e, size_t function);
  TermId CallBuiltin(const lang::Expr& e, Builtin builtin, TypeId type);
  TermId Rounded(TermId x, Builtin builtin);
  TermId Inline(const lang::Expr& e, const Function& function);

  // execute.cc
  void Body(const std::vector<Stmt>& body);
  void Execute(const Stmt& stmt);
  void If(const Stmt& stmt);
  void LoopIn(const Stmt& stmt);
  void LoopRange(const Stmt& stmt);
  void LoopWhile(const Stmt& stmt);
  void Iterate(TermId happens, const std::vector<Stmt>& body);
  void InLoop(const std::function<void()>& iterations);
  void Assign(ExprId target, TermId value);
  void AssignRoot(size_t variable, TermId value, TermId robot, std::vector<TermId> indices);
  void AssignCell(ExprId target, TermId value);
  std::optional<size_t> SharedArrayOf(ExprId target, std::vector<ExprId>& indices) const;
  void Method(const Stmt& stmt);
  void ChangeAt(const Stmt& stmt, ExprId target, TermId list, Builtin builtin);
  State Merge(TermId condition, const State& then, const State& otherwise);
  TermId Live() const;
  /// Returns the declared length of an array; of a list, a bound that an invariant or assumption states.
  std::optional<int64_t> LengthBound(ExprId list);
  TermId ArrayLength(TypeId array);
  TermId InRange(TermId index, TermId length);
  TermId EqualValues(TermId a, TermId b, TypeId type);
  std::optional<int64_t> ListBound(size_t variable) const;
  std::optional<int64_t> ConstantInt(TermId term);

  Vocabulary& vocabulary_;
  expr::Arena& arena_;
  const Model& model_;
  const lang::ExprPool& exprs_;
  diag::Diagnostics& diagnostics_;
  ExecutionOptions options_;
  Frame frame_;
  std::vector<TermId> conditions_;  // of short-circuit operators around the expression in hand
  std::vector<TermId> quantified_;  // variables of quantifiers around it
  bool used_robot_ = false;
  std::vector<TermId> fold_robots_;  // the variable of a fold, by how many are around it
  size_t fold_depth_ = 0;
  std::map<std::tuple<FoldKind, TermId, std::vector<TermId>>, TermId>
      folded_;  // by body and what is free in it
  std::vector<TermId> folds_;
  std::map<ExprId, std::vector<Additive>> additive_;  // by fold: at the moments that were looked at
  std::set<std::pair<TermId, TermId>> compared_;
  std::unordered_set<expr::SymbolId> fold_functions_;
  std::vector<DefinednessCheck> specification_checks_;
};

}  // namespace rondo::koord
