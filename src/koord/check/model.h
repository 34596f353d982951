#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "koord/syntax/ast.h"
#include "lang/types.h"

namespace rondo::koord {

using lang::TypeId;

enum class VariableKind : uint8_t { kLocal, kAllread, kAllwrite, kSensor, kActuator, kParam };

/// A variable, port or parameter. Locals, ports and `allread` cells exist once for each robot.
struct Variable {
  VariableKind kind;
  std::string name;    ///< as programs write it: `x`, `Motion.psn`
  std::string module;  ///< of a port
  TypeId type;         ///< of one robot's cell for `allread`, else as declared
  diag::Span span;
  ExprId initial;
  /// A sensor that is called like a function, such as a planner: its result type; `type` is then of no use.
  int function = -1;

  bool PerRobot() const { return kind != VariableKind::kAllwrite && kind != VariableKind::kParam; }
  bool Shared() const { return kind == VariableKind::kAllread || kind == VariableKind::kAllwrite; }
};

/// The length of an array with one item for each robot.
inline constexpr const char* kRobotsLength = "N_sys";

/// A function of the program (with a body) or of the world (without: uninterpreted, constrained by summaries
/// only).
struct Function {
  std::string name;
  std::vector<std::string> parameter_names;
  std::vector<TypeId> parameters;
  TypeId result;
  const FunctionDef* def = nullptr;  ///< nullptr if it is only used
  bool declared = false;
  diag::Span span;  ///< of its declaration or first use
  int port = -1;    ///< the variable that it is called through
  bool external() const { return def == nullptr || !def->has_body; }
};

/// What a name, member or index expression refers to.
enum class RefKind : uint8_t {
  kNone,
  kVariable,     ///< the robot's own value; the whole array for `allread`
  kCell,         ///< args[1] is the robot: `x[i]`, and in specifications `v[i]`
  kPortOf,       ///< `M[i].port` in a specification: args[0].args[1] is the robot
  kBinding,      ///< a variable of a quantifier, loop, function or summary: index into `bindings`
  kMember,       ///< member `index` of the enumeration that is the expression's type
  kSystemSize,   ///< N_sys
  kFunction,     ///< of a call: index into `functions`
  kBuiltin,      ///< of a call: index is a Builtin
  kOpaqueField,  ///< a member of an opaque type: the function `index` of the base
};
struct Ref {
  RefKind kind = RefKind::kNone;
  uint32_t index = 0;
};

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
  kOld,
  kRect,
  kGrid  ///< only in the `explore` section
};

/// A variable of a quantifier, loop, function or summary.
struct Binding {
  std::string name;
  TypeId type;
  diag::Span span;
};

/// What `forall i in D` ranges over.
enum class DomainKind : uint8_t { kRobots, kType, kList };

/// The `explore` sections: what makes the program executable in finitely many ways.
struct Exploration {
  ExprId robots;                                    ///< N_sys: a number or a list; invalid if not given
  std::map<size_t, ExprId> values;                  ///< by parameter
  std::map<size_t, ExprId> choices;                 ///< by variable: a list of its values, for each robot
  std::map<size_t, const ExploreEntry*> functions;  ///< by external function; its bindings are in `bound_by`
};

/// A program whose names and types are known. Points into the Program, which must outlive it.
struct Model {
  const Program* program = nullptr;
  lang::TypeTable types;
  std::vector<Variable> variables;
  std::vector<Function> functions;
  std::vector<Binding> bindings;
  std::map<std::string, TypeId> named_types;
  /// The lengths of arrays, by the text that is part of their types; without `kRobotsLength`.
  std::map<std::string, ExprId> lengths;
  std::vector<const EventDef*> events;
  std::vector<const InitDef*> inits;
  std::vector<const AssumeDef*> assumptions;
  std::vector<const SummaryDef*> summaries;
  std::vector<const InvariantDef*> invariants;
  std::vector<const PlatformDef*> platforms;
  Exploration exploration;

  // By expression.
  std::vector<TypeId> type_of;
  std::vector<Ref> ref_of;
  /// By quantifier: for each binder its domain, and for each of its names the binding.
  struct Domains {
    std::vector<DomainKind> kinds;
    std::vector<std::vector<uint32_t>> bindings;
  };
  std::map<ExprId, Domains> domains;
  /// By function definition, loop statement or summary: the bindings of its variables.
  std::map<const void*, std::vector<uint32_t>> bound_by;

  TypeId TypeOf(ExprId e) const { return types.Resolve(type_of[e.index()]); }
  Ref RefOf(ExprId e) const { return ref_of[e.index()]; }
};

}  // namespace rondo::koord
