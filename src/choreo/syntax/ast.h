#pragma once

#include <string>
#include <variant>
#include <vector>

#include "lang/syntax_tree.h"
#include "lang/token.h"

/// The syntax of `.rondo` files: robots with motion primitives, worlds, choreographies (docs/motion.md).
namespace rondo::choreo {

using lang::ExprId;

struct Name {
  std::string text;
  diag::Span span;
};

/// `T = 5 s`: a parameter of a robot or motion; the value is a default, and may be missing.
struct Param {
  Name name;
  ExprId value;
};

/// `state x, y : length in [-10 m, 10 m]`
struct StateGroup {
  diag::Span span;
  std::vector<Name> names;
  Name dimension;
  ExprId least, most;
};

struct ParamGroup {
  diag::Span span;
  std::vector<Param> params;
};

/// One line of a contract: `pre`, `assume`, `during`, `post`, `footprint` with an expression, or `modifies`
/// with names.
struct Clause {
  Name keyword;
  std::vector<Name> names;
  ExprId value;
};

/// `motion Move(d, T = 5 s) noninterruptible [T, T] { ... }`
struct MotionDef {
  diag::Span span;
  Name name;
  std::vector<Param> params;
  bool interruptible = false;
  ExprId least, most;  ///< of the duration
  std::vector<Clause> clauses;
};

using RobotItem = std::variant<ParamGroup, StateGroup, MotionDef>;

struct RobotDef {
  diag::Span span;
  Name name;
  std::vector<RobotItem> items;
};

/// `cart: Cart at (0 m, 0 m, 0 m)`; the place may be missing.
struct Component {
  Name name;
  Name type;
  ExprId place;
};

struct WorldDef {
  diag::Span span;
  Name name;
  std::vector<Component> components;
};

// -- choreographies

/// `eta: time | eta > 0 s`, or a value.
struct Payload {
  Name name, type;  ///< empty for a value
  ExprId value;     ///< the value, or what is known of it; may be missing
};

/// `d = 2 m`, or an argument without a name.
struct Argument {
  Name name;
  ExprId value;
};

struct MotionCall {
  Name robot, motion;
  std::vector<Argument> args;
};

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

/// A thread of `parallel`, or an alternative of `choose`.
struct Branch {
  diag::Span span;            ///< of the line that opens it
  ExprId guard;               ///< kChoose
  std::vector<Clause> facts;  ///< kParallel: `region`, `assume`, `guarantee`
  std::vector<Stmt> body;
};

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

struct ChoreographyDef {
  diag::Span span;
  Name name, world;
  std::vector<Name> options;
  ExprId initially;  ///< may be missing
  std::vector<Stmt> body;
};

using Item = std::variant<RobotDef, WorldDef, ChoreographyDef>;

/// One or more files, items in order.
struct Module {
  lang::ExprPool exprs;
  std::vector<Item> items;
  std::vector<lang::Comment> comments;
};

}  // namespace rondo::choreo
