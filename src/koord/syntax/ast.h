#pragma once

#include <string>
#include <variant>
#include <vector>

#include "lang/syntax_tree.h"
#include "lang/token.h"

/// The syntax of Koord programs and their specifications, as written (Koord paper, Fig. 4, and the superset
/// of all dialects that docs/language.md describes).
namespace rondo::koord {

using lang::ExprId;

enum class StmtKind : uint8_t {
  kAssign,     // target = value
  kAddAssign,  // target += value
  kIncrement,  // target++
  kCall,       // value
  kStream,     // target << operands
  kStop,
  kBreak,
  kContinue,
  kReturn,    // value, or none
  kIf,        // value: condition; body; orelse
  kForIn,     // names in value: body
  kForRange,  // names[0] = value, operands[0]: body
  kAtomic,    // body
};

struct Stmt {
  StmtKind kind = StmtKind::kStop;
  diag::Span span;  ///< of the first line for statements with a body
  ExprId target;
  ExprId value;
  std::vector<ExprId> operands;
  std::vector<std::string> names;
  std::vector<diag::Span> name_spans;
  std::vector<Stmt> body;
  std::vector<Stmt> orelse;
  bool has_else = false;
  bool elif = false;  ///< an `if` that was written `elif`: the only statement of its parent's `orelse`
};

struct Decl {
  lang::TypeSyntax type;
  std::string name;
  diag::Span span;                 ///< of the name
  std::vector<ExprId> dimensions;  ///< written after the name; an invalid id for `[]` and `[*]`
  ExprId initial;
  std::vector<std::string> members;  ///< `enum {a, b} name` declares an enumeration in place
};

struct FunctionDef {
  std::string name;
  diag::Span span;
  std::vector<Decl> parameters;
  lang::TypeSyntax result;  ///< no name if absent
  std::vector<Stmt> body;
  bool has_body = true;
};
struct AdtDef {
  std::string name;
  diag::Span span;
  std::vector<Decl> fields;
};
struct EnumDef {
  std::string name;
  diag::Span span;
  std::vector<std::string> members;
  std::vector<diag::Span> member_spans;
};
struct PortGroup {
  bool sensors;
  diag::Span span;
  std::vector<Decl> ports;
};
struct ModuleDef {
  std::string name;
  diag::Span span;
  std::vector<PortGroup> groups;
};
enum class SectionKind : uint8_t { kAllread, kAllwrite, kLocal };
struct Section {
  SectionKind kind;
  diag::Span span;
  std::vector<Decl> decls;
};
struct InitDef {
  diag::Span span;
  std::vector<Stmt> body;
};
struct EventDef {
  std::string name;
  diag::Span span;
  ExprId pre;  ///< invalid: always enabled
  bool urgent = false;
  std::vector<Stmt> body;
};
struct AgentHeader {
  std::string name;
  diag::Span span;
};

// -- specifications
struct ParamDef {
  Decl decl;
  diag::Span span;
};
enum class AssumeKind : uint8_t {
  kFact,       // of parameters and functions, at any time
  kInitially,  // of the initial state, for each robot
  kPort,       // `assume M.name when P always Q`
};
struct AssumeDef {
  AssumeKind kind;
  std::string module;  ///< for kPort
  std::string name;    ///< may be empty
  diag::Span span;
  ExprId when;  ///< invalid: always
  ExprId body;
};
struct SummaryDef {
  std::string function;
  diag::Span span;
  std::vector<std::string> parameters;
  std::vector<diag::Span> parameter_spans;
  std::string result;
  ExprId body;
};
struct InvariantDef {
  std::string name;  ///< may be empty
  diag::Span span;
  ExprId body;
};

enum class ExploreKind : uint8_t {
  kValue,     // name = body
  kChoice,    // name in body
  kFunction,  // name(parameters) = body
};
struct ExploreEntry {
  ExploreKind kind;
  std::string name;  ///< `x`, `M.port`, `N_sys`
  diag::Span span;   ///< of the name
  std::vector<std::string> parameters;
  std::vector<diag::Span> parameter_spans;
  ExprId body;
};
/// What makes a program executable in finitely many ways: values of parameters, sets that ports and initial
/// values are taken from, bodies of external functions.
struct ExploreDef {
  diag::Span span;
  std::vector<ExploreEntry> entries;
};

/// platform Motion = Quadrotor from "quadrotor.rondo" every 0.1
///
/// What the ports of a module are made of: a robot type with dynamics and a controller, and how long a round
/// takes.
struct PlatformDef {
  std::string module;
  std::string type;
  std::string file;  ///< relative to the file that it stands in
  diag::Span span;   ///< of the module
  diag::Span file_span;
  ExprId period;  ///< seconds
};

using Item = std::variant<AgentHeader, FunctionDef, AdtDef, EnumDef, ModuleDef, Section, InitDef, EventDef,
                          ParamDef, AssumeDef, SummaryDef, InvariantDef, ExploreDef, PlatformDef>;

/// One file, or a program with the specification beside it: items in source order.
struct Program {
  lang::ExprPool exprs;
  std::vector<Item> items;
  std::vector<lang::Comment> comments;
  std::vector<diag::Span> item_spans;  ///< from the first to the last token of each item
};

}  // namespace rondo::koord
