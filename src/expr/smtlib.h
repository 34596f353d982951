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

/// A complete SMT-LIB 2.6 script: sorts, symbols, the assertions with shared subterms defined once,
/// `(check-sat)`. Lists are an uninterpreted sort with uninterpreted functions; their meaning must be
/// asserted (`ListAxioms`). Deterministic: equal assertions in equal order give equal text.
std::string ToSmtLib(const Arena& arena, std::span<const SmtAssertion> assertions);

/// A closed or open term as an SMT-LIB expression, nothing shared. For messages and small terms.
std::string ToSmtLib(const Arena& arena, TermId term);

/// The name of the uninterpreted function that stands for a list operator on this list sort, e.g.
/// `len<List<Real>>`.
std::string ListFunctionName(const Arena& arena, Op op, SortId list, size_t arity);

}  // namespace rondo::expr
