#pragma once

#include <string>
#include <vector>

#include "lang/smtlib/script.h"

/// Certificates as text: an SMT-LIB script and the steps that refute its assertions.
namespace rondo::solve::certify {

/// Is one step of a proof.
///
///     (let NAME TERM)             a name for a term
///     (substitute VARIABLE TERM)  the variable is known to equal the term, and is replaced by it
///     (squares FORMULA)           a known sum of squares that is at most 0: each square is 0
///     (fact FORMULA)              known, up to arithmetic; for the searches that follow
///     (period VARIABLE C C)       no full turn of the variable changes what is known: it may lie
///                                 between the two numbers, which are a period apart or more
///     (identity (C TERM) ... C)   numbers C: the sum of the products and the last number is 0,
///                                 whatever the variables are; a fact
///     (cases FORMULA)             one of the alternatives of a known disjunction holds
///     (case FORMULA) ... (end)    an alternative and the steps that refute it; `end` comes behind
///                                 the last one
///     (contradiction)             what is known contradicts itself: this case is closed
///     (search (VARIABLES) "TREE") no box holds a solution of the facts: this case is closed
///
/// TREE: a box and its parts, from the outside in: `.` for a box that contraction empties, `V C` and two
/// trees for one that is split at `C`, where `V` counts the variables from 0.
struct Step {
  enum class Kind : uint8_t {
    kSubstitute,
    kSquares,
    kPeriod,
    kFact,
    kIdentity,
    kCases,
    kCase,
    kEnd,
    kContradiction,
    kSearch
  };
  Kind kind;
  diag::Span span;
  std::vector<expr::TermId> terms;  ///< of kIdentity: each number and its term, then the last number
  std::string text;                 ///< of kSearch: the tree
};

/// Is a script, whose assertions are refuted, and the proof behind it.
struct Certificate {
  lang::smtlib::Script script;
  std::vector<Step> steps;
};

/// Reads a certificate. Reports everything that is not well-formed; then it must not be used.
void ReadCertificate(const diag::SourceSet& sources, diag::FileId file, Certificate& certificate,
                     diag::Diagnostics& diagnostics);

}  // namespace rondo::solve::certify
