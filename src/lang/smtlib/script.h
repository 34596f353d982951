#pragma once

#include <functional>
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
  enum class Kind : uint8_t { kAssert, kPush, kPop, kCheckSat, kGetModel, kGetValue, kEcho, kReset };
  Kind kind;
  diag::Span span;
  std::vector<expr::TermId> terms;  ///< kAssert: one; kGetValue: any number
  size_t levels = 1;                ///< kPush, kPop
  std::string text;                 ///< kEcho
};

struct Script {
  expr::Arena arena;
  std::vector<Command> commands;            ///< up to `(exit)`
  std::vector<expr::TermId> variables;      ///< in order of declaration
  std::optional<expr::Rational> precision;  ///< of `(set-option :precision p)`
};

/// Reads a command that is none of SMT-LIB's; false: it does not know it either.
using Extension = std::function<bool(const SExpr& command, TermReader& terms)>;

/// Reads a script. Everything that is wrong is reported; then the script must not be run. Declarations and
/// definitions are global: `pop` does not remove them.
void ReadScript(const diag::SourceSet& sources, diag::FileId file, Script& script,
                diag::Diagnostics& diagnostics, const Extension& extension = {});

}  // namespace rondo::lang::smtlib
