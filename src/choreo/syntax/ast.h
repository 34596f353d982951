#pragma once

#include <string>
#include <variant>
#include <vector>

#include "lang/syntax_tree.h"
#include "lang/token.h"
#include "robot/syntax/ast.h"

/// Represents the syntax of `.rondo` files: robots with motion primitives, worlds, choreographies
/// (docs/motion.md), and that of the original tools. Ids of expressions that are absent are invalid; names
/// that are absent are empty.
namespace rondo::choreo {

using lang::ExprId;
using robot::Argument;
using robot::Clause;
using robot::Component;
using robot::MotionDef;
using robot::Name;
using robot::Param;
using robot::ParamGroup;
using robot::RobotDef;
using robot::RobotItem;
using robot::StateGroup;
using robot::WorldDef;

// -- choreographies

/// Represents what a message carries: `eta: time | eta > 0 s`, or a value.
struct Payload {
  Name name, type;  ///< empty for a value
  ExprId value;     ///< the value, or what is known of it; may be missing
};

/// Represents the call of a motion, of a robot where it has to be named.
struct MotionCall {
  Name robot, motion;
  std::vector<Argument> args;
};

/// Names the statements of a choreography.
enum class StmtKind : uint8_t {
  kMessage,   // a -> b: label(payload) when guard
  kMotion,    // a: M(args), or { a: M(args), b: N(args) }
  kParallel,  // parallel { thread ... { } ... }
  kChoose,    // choose at a { when guard { } ... }
  kLoop,      // loop { }
  kWhile,     // while guard { }
  kRec,       // rec X { }
  kContinue,  // continue X
};

struct Stmt;

/// Represents a thread of `parallel`, or an alternative of `choose`.
struct Branch {
  diag::Span span;            ///< of the line that opens it
  ExprId guard;               ///< kChoose
  Name contract;              ///< kParallel: a `contract` whose facts hold, too; empty if none
  std::vector<Name> robots;   ///< kParallel: whom it should be about; empty if that is not said
  std::vector<Clause> facts;  ///< kParallel: `region`, `assume`, `guarantee`
  std::vector<Stmt> body;
};

/// Represents a statement of a choreography. Which fields are used depends on its kind.
struct Stmt {
  StmtKind kind = StmtKind::kLoop;
  diag::Span span;  ///< of the first line for statements with a body
  Name from, to;    ///< kMessage
  Name label;       ///< of a message, or the name of a recursion
  std::vector<Payload> payload;
  ExprId guard;  ///< kMessage (may be missing), kWhile
  std::vector<MotionCall> motions;
  Name chooser;
  std::vector<Branch> branches;
  std::vector<Stmt> body;
};

// -- choreographies as equations (`.chor`)

/// Names the equations of a `.chor` file, as the nodes of graphs are named.
enum class EquationKind : uint8_t { kMessage, kMotion, kChoice, kMerge, kFork, kJoin, kEnd };

/// Represents an equation between states: `x1 = a -> b: hello(); x2`, `x3 + x4 = x5`, `x6 = { region } x7 ||
/// { region } x8`, ...
struct Equation {
  EquationKind kind = EquationKind::kEnd;
  diag::Span span;
  std::vector<Name> from, to;
  Stmt step;  ///< what a message, motion, choice or fork says; its branches have no bodies
};

/// Represents a choreography, with a body or with equations.
struct ChoreographyDef {
  diag::Span span;
  Name name, world;
  std::vector<Name> options;
  ExprId initially;  ///< may be missing
  std::vector<Stmt> body;
  std::vector<Equation> equations;  ///< instead of a body
  Name first;                       ///< where equations begin
};

/// Represents `contract Docked { assume ... guarantee ... }`: facts of threads that have a name.
struct ContractDef {
  diag::Span span;
  Name name;
  std::vector<Clause> facts;
};

// -- processes

/// Names the acts of a process.
enum class ActKind : uint8_t {
  kSend,      // send peer.label(values)
  kReceive,   // receive from peer while Idle() { label(names) => { } ... }
  kMotion,    // Move(args)
  kIf,        // if guard { } else { }
  kWhile,     // while guard { }
  kLoop,      // loop { }
  kRec,       // rec X { }
  kContinue,  // continue X
  kAssign,    // x = value
  kExit,      // exit
};

struct Act;

/// Represents one case of a `receive`: a message and what follows it.
struct Case {
  diag::Span span;
  Name peer, label;
  std::vector<Name> names;  ///< for what the message carries
  std::vector<Act> body;
};

/// Represents one act of a process. Which fields are used depends on its kind.
struct Act {
  ActKind kind = ActKind::kExit;
  diag::Span span;  ///< of the first line for acts with a body
  Name peer, label;
  std::vector<ExprId> values;
  MotionCall motion;  ///< kReceive: what it does meanwhile; without a name if nothing
  std::vector<Case> cases;
  ExprId guard;
  Name variable;
  std::vector<Act> body, otherwise;
};

/// Represents a process: what one robot does of a choreography.
struct ProcessDef {
  diag::Span span;
  Name robot;
  Name choreography;  ///< empty: the only one there is
  std::vector<Act> body;
  /// Says that motions may be spelled as the original interpreter found them: `moveCart`, `m_MoveCart`.
  bool loose_names = false;
};

/// Represents an import such as `import "models/cart.rondo"`.
struct ImportDef {
  diag::Span span;
  std::string path;
};

using Item = std::variant<ImportDef, RobotDef, WorldDef, ContractDef, ChoreographyDef, ProcessDef>;

/// Holds one or more files, their items in order.
struct Module {
  lang::ExprPool exprs;
  std::vector<Item> items;
  std::vector<lang::Comment> comments;
};

}  // namespace rondo::choreo
