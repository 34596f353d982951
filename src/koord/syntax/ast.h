#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "lang/syntax_tree.h"
#include "lang/token.h"

/// Represents the syntax of Koord programs and their specifications, as written (Koord paper, Fig. 4, and the
/// superset of all dialects that docs/language.md describes). Ids of expressions that are absent are invalid.
namespace rondo::koord {

using lang::ExprId;

/// Names the kinds of statements; statements.def lists them.
enum class StmtKind : uint8_t {
#define RONDO_STATEMENT(kind, name, word) k##kind,
#include "koord/syntax/statements.def"
#undef RONDO_STATEMENT
};

/// Holds what a kind of statement is called in JSON, and the word that it begins with; empty if there is
/// none.
struct StmtWords {
  std::string_view name, word;
};
inline constexpr StmtWords kStmtWords[] = {
#define RONDO_STATEMENT(kind, name, word) {name, word},
#include "koord/syntax/statements.def"
#undef RONDO_STATEMENT
};
constexpr const StmtWords& WordsOf(StmtKind kind) { return kStmtWords[static_cast<size_t>(kind)]; }

/// Represents a statement. Which fields are used depends on its kind; an `if` has its condition in `value`,
/// its branches in `body` and `orelse`.
struct Stmt {
  StmtKind kind = StmtKind::kStop;
  diag::Span span;  ///< of the first line for statements with a body
  ExprId target;
  ExprId value;
  /// `-`, `*` or `/` for an assignment that was written `target -= operand`; its value is `target - operand`.
  std::string update;
  lang::TypeSyntax type;  ///< of a local variable
  std::vector<ExprId> operands;
  std::vector<std::string> names;
  std::vector<diag::Span> name_spans;
  std::vector<Stmt> body;
  std::vector<Stmt> orelse;
  bool has_else = false;
  bool elif = false;  ///< an `if` that was written `elif`: the only statement of its parent's `orelse`
};

/// Represents the declaration of a variable, port, parameter or field.
struct Decl {
  lang::TypeSyntax type;
  std::string name;
  diag::Span span;                 ///< of the name
  std::vector<ExprId> dimensions;  ///< written after the name; an invalid id for `[]` and `[*]`
  ExprId initial;
  std::vector<std::string> members;  ///< `enum {a, b} name` declares an enumeration in place
};

/// Represents `def f(...)`: a function with a body, or an external one without.
struct FunctionDef {
  std::string name;
  diag::Span span;
  std::vector<Decl> parameters;
  lang::TypeSyntax result;  ///< no name if absent
  std::vector<Stmt> body;
  bool has_body = true;
};
/// Represents the declaration of a record type.
struct AdtDef {
  std::string name;
  diag::Span span;
  std::vector<Decl> fields;
};
/// Represents the declaration of an enumeration.
struct EnumDef {
  std::string name;
  diag::Span span;
  std::vector<std::string> members;
  std::vector<diag::Span> member_spans;
};
/// Represents the `sensors` or the `actuators` of a module.
struct PortGroup {
  bool sensors;
  diag::Span span;
  std::vector<Decl> ports;
};
/// Represents a module: the ports through which a program reaches a controller.
struct ModuleDef {
  std::string name;
  diag::Span span;
  std::vector<PortGroup> groups;
};
/// Names who may write the variables of a section; see `Section`.
enum class SectionKind : uint8_t { kAllread, kAllwrite, kLocal };
/// Represents a section of variables: `allread` (each robot writes its own cell), `allwrite` or `local`.
struct Section {
  SectionKind kind;
  diag::Span span;
  std::vector<Decl> decls;
};
/// Represents an `init` block, which every robot runs once before the first round.
struct InitDef {
  diag::Span span;
  std::vector<Stmt> body;
};
/// Represents an event: its guard and its effect.
struct EventDef {
  std::string name;
  diag::Span span;
  ExprId pre;  ///< the guard; invalid: the event is always enabled
  bool urgent = false;
  std::vector<Stmt> body;
};
/// Represents `fallback M: statements`: what the actuators of module M get when a robot may no longer act on what the team
/// agrees on (docs/runtime.md). `code` is an event without a guard that is called `fallback M`.
struct FallbackDef {
  std::string module;
  diag::Span span;  ///< of the name of the module
  EventDef code;
};
/// Represents the line that names the program.
struct AgentHeader {
  std::string name;
  diag::Span span;
};

// -- specifications
/// Represents a parameter of the program: a constant, with or without a value.
struct ParamDef {
  Decl decl;
  diag::Span span;
};
/// Names what an assumption is about.
enum class AssumeKind : uint8_t {
  kFact,       // of parameters and functions, at any time
  kInitially,  // of the initial state, for each robot
  kPort,       // `assume M.name when P always Q`, or `... finally Q`
};
/// Represents an assumption of the specification (docs/theory.md, "Assumptions").
struct AssumeDef {
  AssumeKind kind;
  std::string module;  ///< for kPort
  std::string name;    ///< may be empty
  diag::Span span;
  ExprId when;  ///< P of a controller assumption; invalid: Q holds always
  ExprId body;
  bool at_end = false;  ///< `finally Q`: Q holds when the round is over
};
/// Represents `summary f(x) -> y: F`: F(x, f(x)) holds for all x.
struct SummaryDef {
  std::string function;
  diag::Span span;
  std::vector<std::string> parameters;
  std::vector<diag::Span> parameter_spans;
  std::string result;
  ExprId body;
};
/// Represents `response NAME: P within 5 rounds Q`: of each robot, Q holds between rounds at most so many rounds after P did.
struct ResponseDef {
  std::string name;
  diag::Span span;
  ExprId when;
  uint32_t rounds = 0;
  ExprId then;
};
/// Represents an invariant that is to be proved or checked.
struct InvariantDef {
  std::string name;        ///< may be empty
  bool at_rounds = false;  ///< it has to hold between rounds only
  diag::Span span;
  ExprId body;
};

/// Names the forms of an entry of an `explore` section.
enum class ExploreKind : uint8_t {
  kValue,     // name = body
  kChoice,    // name in body
  kFunction,  // name(parameters) = body
};
/// Represents one entry of an `explore` section.
struct ExploreEntry {
  ExploreKind kind;
  std::string name;  ///< `x`, `M.port`, `N_sys`
  diag::Span span;   ///< of the name
  std::vector<std::string> parameters;
  std::vector<diag::Span> parameter_spans;
  ExprId body;
};
/// Represents an `explore` section, which makes a program executable in finitely many ways: values of
/// parameters, sets that ports and initial values are taken from, bodies of external functions.
struct ExploreDef {
  diag::Span span;
  std::vector<ExploreEntry> entries;
};

/// Represents `platform Motion = Quadrotor from "quadrotor.rondo" every 0.1`: what the ports of a module are
/// made of, a robot type with dynamics and a controller, and how long a round takes.
struct PlatformDef {
  std::string module;
  std::string type;
  std::string file;  ///< relative to the file that it stands in
  diag::Span span;   ///< where the module is named
  diag::Span file_span;
  ExprId period;  ///< the length of a round, in seconds
};

using Item = std::variant<AgentHeader, FunctionDef, AdtDef, EnumDef, ModuleDef, Section, InitDef, EventDef,
                          FallbackDef, ParamDef, AssumeDef, SummaryDef, InvariantDef, ResponseDef, ExploreDef,
                          PlatformDef>;

/// Holds one file, or a program with the specification beside it: items in source order.
struct Program {
  lang::ExprPool exprs;
  std::vector<Item> items;
  std::vector<lang::Comment> comments;
  std::vector<diag::Span> item_spans;  ///< from the first to the last token of each item

  /// Returns the files that it was read from: that of the program first.
  std::vector<diag::FileId> Files() const {
    std::vector<diag::FileId> files;
    for (const diag::Span span : item_spans) {
      if (span.file.valid() && std::ranges::find(files, span.file) == files.end()) files.push_back(span.file);
    }
    return files;
  }
};

}  // namespace rondo::koord
