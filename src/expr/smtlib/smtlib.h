#pragma once

#include <span>
#include <string>

#include "expr/arena.h"

namespace rondo::expr {

/// One assertion of a script; `comment` is printed above it.
struct SmtAssertion {
  TermId formula;
  std::string comment;
};

/// How abs, min and max are written: spelled out, since they have no name that all solvers know, or as dReal
/// and Rondo name them. Spelled out, symbols never have names that some solver has a meaning for.
enum class SmtFunctions : uint8_t { kSpelledOut, kNamed };

/// Prints terms, some of them by names.
class SmtPrinter {
 public:
  explicit SmtPrinter(const Arena& arena, SmtFunctions functions = SmtFunctions::kSpelledOut)
      : arena_(arena), functions_(functions) {}

  void Define(TermId t, std::string name) { names_[t] = std::move(name); }
  bool IsDefined(TermId t) const { return names_.contains(t); }
  /// `definition`: as it is made, even if it has a name itself.
  std::string Print(TermId t, bool definition = false) const;
  std::string SymbolName(SymbolId id) const;
  std::string SortName(SortId id) const;
  std::string FieldName(SortId record, uint32_t field) const;

 private:
  const Arena& arena_;
  SmtFunctions functions_;
  std::unordered_map<TermId, std::string> names_;
};

/// A name as a symbol: quoted where it must be.
std::string Quoted(std::string_view name);

/// A complete SMT-LIB 2.6 script: sorts, symbols, the assertions with shared subterms defined once,
/// `(check-sat)`. Lists are an uninterpreted sort with uninterpreted functions; their meaning must be
/// asserted (`ListAxioms`). Deterministic: equal assertions in equal order give equal text.
std::string ToSmtLib(const Arena& arena, std::span<const SmtAssertion> assertions,
                     SmtFunctions functions = SmtFunctions::kSpelledOut);

/// A closed or open term as an SMT-LIB expression, nothing shared. For messages and small terms.
std::string ToSmtLib(const Arena& arena, TermId term);

/// The name of the uninterpreted function that stands for a list operator on this list sort, e.g.
/// `len<List<Real>>`.
std::string ListFunctionName(const Arena& arena, Op op, SortId list, size_t arity);

}  // namespace rondo::expr
