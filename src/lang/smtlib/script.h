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
  /// kDeclare, kAssert: one; kGetValue: any number; kCheckSat: what is assumed
  std::vector<expr::TermId> terms;
  size_t levels = 1;  ///< kPush, kPop
  std::string text;   ///< kEcho
};

struct Script {
  expr::Arena arena;
  std::vector<Command> commands;            ///< up to `(exit)`
  std::vector<expr::TermId> variables;      ///< all that are ever declared, each once
  std::optional<expr::Rational> precision;  ///< of `(set-option :precision p)`
  /// What the script calls a variable that had to get another name in the arena.
  std::map<expr::TermId, std::string> names;
  std::string NameOf(expr::TermId variable) const;
};

/// Reads a command that is none of SMT-LIB's; false: it does not know it either.
using Extension = std::function<bool(const SExpr& command, TermReader& terms)>;

/// Reads a script. Everything that is wrong is reported; then the script must not be run. Declarations and
/// definitions stay in sight after `pop` and `(reset-assertions)`, but their names can be declared again.
/// After `(reset)` they are gone.
void ReadScript(const diag::SourceSet& sources, diag::FileId file, Script& script,
                diag::Diagnostics& diagnostics, const Extension& extension = {});

}  // namespace rondo::lang::smtlib
