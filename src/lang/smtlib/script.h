#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "diag/diagnostic.h"
#include "expr/arena.h"
#include "lang/smtlib/term_reader.h"

/// SMT-LIB 2 scripts of nonlinear real arithmetic, in the dialect of dReal: elementary functions, bounds in
/// declarations, `:precision`, numbers with a sign.
namespace rondo::lang::smtlib {

/// Is a command of a script, as it is run. Definitions and options take effect while the script is read.
struct Command {
  enum class Kind : uint8_t {
    kDeclare,
    kAssert,
    kPush,
    kPop,
    kCheckSat,
    kGetModel,
    kGetValue,
    kEcho,
    kResetAssertions,
    kReset
  };
  Kind kind;
  diag::Span span;
  /// The terms of the command: one for kDeclare (the constant) and kAssert (the formula), any number for
  /// kGetValue, and for kCheckSat what is assumed besides the assertions.
  std::vector<expr::TermId> terms;
  size_t levels = 1;  ///< kPush, kPop: how many
  std::string text;   ///< kEcho: what is printed
};

/// Is a script that was read: its commands, in order, and the arena of their terms.
struct Script {
  expr::Arena arena;
  std::vector<Command> commands;            ///< those before `(exit)`
  std::vector<expr::TermId> variables;      ///< all that are ever declared, each once
  std::optional<expr::Rational> precision;  ///< of `(set-option :precision p)`
  /// What the script calls each variable that had to get another name in the arena.
  std::map<expr::TermId, std::string> names;
  /// Returns what the script calls the variable.
  std::string NameOf(expr::TermId variable) const;
};

/// Reads a command that is none of SMT-LIB's; returns false if it does not know it either.
using Extension = std::function<bool(const SExpr& command, TermReader& terms)>;

/// Reads a script. Everything that is wrong is reported; then the script must not be run.
///
/// Declarations and definitions stay in sight after `pop` and `(reset-assertions)`, but their names can be
/// declared again. After `(reset)` they are gone.
void ReadScript(const diag::SourceSet& sources, diag::FileId file, Script& script,
                diag::Diagnostics& diagnostics, const Extension& extension = {});

}  // namespace rondo::lang::smtlib
