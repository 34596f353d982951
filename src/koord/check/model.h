#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "koord/syntax/ast.h"
#include "lang/types.h"

/// Holds Koord programs after name and type resolution, for every engine.
namespace rondo::koord {

using lang::TypeId;

/// Names who may read and write a variable: its robot alone (kLocal), its robot writes and all read
/// (kAllread), all (kAllwrite), the environment (kSensor), the program towards the controller (kActuator),
/// nobody (kParam).
enum class VariableKind : uint8_t { kLocal, kAllread, kAllwrite, kSensor, kActuator, kParam };

/// Describes a variable, port or parameter. Locals, ports and `allread` cells exist once for each robot.
struct Variable {
  VariableKind kind;
  std::string name;    ///< as programs write it: `x`, `Motion.psn`
  std::string module;  ///< of a port, else empty
  TypeId type;         ///< of one robot's cell for `allread`, else as declared
  diag::Span span;
  ExprId initial;
  /// Gives the function of a sensor that is called like one, such as a planner; `type` is then of no use. -1
  /// for all others.
  int function = -1;

  /// Reports whether each robot has its own.
  bool PerRobot() const { return kind != VariableKind::kAllwrite && kind != VariableKind::kParam; }
  /// Reports whether every robot can read it.
  bool Shared() const { return kind == VariableKind::kAllread || kind == VariableKind::kAllwrite; }
};

/// Names the length of an array with one item for each robot.
inline constexpr const char* kRobotsLength = "N_sys";

/// Describes a function of the program (with a body) or of the world (without: uninterpreted, constrained by
/// summaries only).
struct Function {
  std::string name;
  std::vector<std::string> parameter_names;
  std::vector<TypeId> parameters;
  TypeId result;
  const FunctionDef* def = nullptr;  ///< nullptr if it is only used
  bool declared = false;
  diag::Span span;  ///< of its declaration or first use
  int port = -1;    ///< the variable that it is called through; -1 if it is no port
  /// Reports whether the program has no body for it.
  bool external() const { return def == nullptr || !def->has_body; }
};

/// Names what a name, member or index expression refers to.
enum class RefKind : uint8_t {
  kNone,
  kVariable,     ///< the robot's own value; the whole array for `allread`
  kCell,         ///< args[1] is the robot: `x[i]`, and in specifications `v[i]`
  kPortOf,       ///< `M[i].port` in a specification: args[0].args[1] is the robot
  kBinding,      ///< a variable of a quantifier, loop, function or summary: index into `bindings`
  kMember,       ///< member `index` of the enumeration that is the expression's type
  kSystemSize,   ///< N_sys
  kStopped,      ///< `stopped[i]` in a specification: args[1] is the robot
  kFunction,     ///< of a call: index into `functions`
  kBuiltin,      ///< of a call: index is a Builtin
  kOpaqueField,  ///< a member of an opaque type: the function `index` of the base
};
/// Tells what an expression refers to; what `index` counts depends on the kind.
struct Ref {
  RefKind kind = RefKind::kNone;
  uint32_t index = 0;
};

/// Names the functions that every program can call.
enum class Builtin : uint8_t {
  kPos,
  kMid,
  kDist,
  kLen,
  kAbs,
  kMin,
  kMax,
  kRemove,
  kAppend,
  kClear,
  kContains,
  kFront,  ///< the first item
  kInsert,
  kPop,    ///< takes away the item at an index, or the first of a queue
  kSlice,  ///< `l[a:b]`
  kOld,
  kRecord,  ///< `Order(1, p)`: a value of the record type that is the expression's
  kSqrt,
  kHypot,
  kFloor,
  kCeil,
  kRound,  ///< to the nearest integer, a half away from zero
  kSign,   ///< -1, 0 or 1
  kRect,
  kGrid  ///< only in the `explore` section
};

/// Names what `sum i in ID: e` and its like make of the values of all robots: how many are true, the sum, the least or the
/// greatest value, or the first robot that has it.
enum class FoldKind : uint8_t { kCount, kSum, kMin, kMax, kArgmin, kArgmax };
/// Returns the fold that a word means.
std::optional<FoldKind> FoldOf(std::string_view word);

/// Describes a variable of a quantifier, loop, function or summary.
struct Binding {
  std::string name;
  TypeId type;
  diag::Span span;
};

/// Names what the D of `forall i in D` is: all robots, all values of a type, the items of a list.
enum class DomainKind : uint8_t { kRobots, kType, kList };

/// Holds what the `explore` sections say, which makes the program executable in finitely many ways.
struct Exploration {
  ExprId robots;                                    ///< N_sys: a number or a list; invalid if not given
  std::map<size_t, ExprId> values;                  ///< by parameter
  std::map<size_t, ExprId> choices;                 ///< by variable: a list of its values, for each robot
  std::map<size_t, const ExploreEntry*> functions;  ///< by external function; its bindings are in `bound_by`
};

/// Holds a program whose names and types are known. Points into the Program, which must outlive it.
struct Model {
  const Program* program = nullptr;
  lang::TypeTable types;
  std::vector<Variable> variables;
  std::vector<Function> functions;
  std::vector<Binding> bindings;
  std::map<std::string, TypeId> named_types;
  /// Holds the lengths of arrays, by the text that is part of their types; without `kRobotsLength`.
  std::map<std::string, ExprId> lengths;
  /// Holds the arrays whose initial value is that of each item: `int a[3] = 0`.
  std::set<size_t> filled;
  std::vector<const EventDef*> events;
  std::vector<const InitDef*> inits;
  std::vector<const FallbackDef*> fallbacks;  ///< at most one for each module
  std::vector<const AssumeDef*> assumptions;
  std::vector<const SummaryDef*> summaries;
  std::vector<const InvariantDef*> invariants;
  std::vector<const ResponseDef*> responses;
  std::vector<const PlatformDef*> platforms;
  Exploration exploration;

  // Both by number of the expression (ExprId::index): its type, and what it refers to.
  std::vector<TypeId> type_of;
  std::vector<Ref> ref_of;
  /// Holds, by quantifier, for each binder its domain, and for each of its names the binding.
  struct Domains {
    std::vector<DomainKind> kinds;
    std::vector<std::vector<uint32_t>> bindings;
  };
  std::map<ExprId, Domains> domains;
  /// Holds, by function definition, loop statement or summary, the bindings of its variables.
  std::map<const void*, std::vector<uint32_t>> bound_by;

  /// Reports whether an actuator belongs to a module with a fallback.
  bool FallsBack(size_t variable) const;

  TypeId TypeOf(ExprId e) const { return types.Resolve(type_of[e.index()]); }
  Ref RefOf(ExprId e) const { return ref_of[e.index()]; }
};

}  // namespace rondo::koord
