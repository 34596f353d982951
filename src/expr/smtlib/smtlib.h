#pragma once

#include <span>
#include <string>

#include "expr/arena.h"

/// Terms and questions as SMT-LIB 2.6 text, for other solvers, certificates and people.
namespace rondo::expr {

/// Is one assertion of a script; `comment` is printed above it.
struct SmtAssertion {
  TermId formula;
  std::string comment;
};

/// Says how abs, min and max are written: spelled out, since they have no name that all solvers know, or as
/// dReal and Rondo name them. Spelled out, symbols never have names that some solver has a meaning for.
enum class SmtFunctions : uint8_t { kSpelledOut, kNamed };

/// Prints terms as SMT-LIB expressions, those that were given a name by their names.
class SmtPrinter {
 public:
  explicit SmtPrinter(const Arena& arena, SmtFunctions functions = SmtFunctions::kSpelledOut)
      : arena_(arena), functions_(functions) {}

  /// Gives the term a name; later terms that contain it are printed with the name in its place.
  void Define(TermId t, std::string name) { names_[t] = std::move(name); }
  bool IsDefined(TermId t) const { return names_.contains(t); }
  /// Returns the term as an expression. `definition`: as it is made, even if it has a name itself.
  std::string Print(TermId t, bool definition = false) const;
  std::string SymbolName(SymbolId id) const;
  std::string SortName(SortId id) const;
  std::string FieldName(SortId record, uint32_t field) const;

 private:
  const Arena& arena_;
  SmtFunctions functions_;
  std::unordered_map<TermId, std::string> names_;
};

/// Returns a name as a symbol of SMT-LIB: between bars where it must be.
std::string Quoted(std::string_view name);

/// Returns a complete SMT-LIB 2.6 script: sorts, symbols, the assertions with shared subterms defined once,
/// `(check-sat)`. Lists are an uninterpreted sort with uninterpreted functions; their meaning must be
/// asserted (`ListAxioms`). Deterministic: equal assertions in equal order give equal text.
std::string ToSmtLib(const Arena& arena, std::span<const SmtAssertion> assertions,
                     SmtFunctions functions = SmtFunctions::kSpelledOut);

/// Returns a closed or open term as an SMT-LIB expression, nothing shared. For messages and small terms: the
/// text may be exponentially longer than the term is large.
std::string ToSmtLib(const Arena& arena, TermId term);

/// Returns the name of the uninterpreted function that stands for a list operator on this list sort, e.g.
/// `len<List<Real>>`.
std::string ListFunctionName(const Arena& arena, Op op, SortId list, size_t arity);

}  // namespace rondo::expr
