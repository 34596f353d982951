#pragma once

#include "koord/prove/obligations/problem.h"
#include "koord/prove/prove.h"
#include "koord/prove/witness.h"

namespace rondo::koord {

/// Turns what the solver said into verdicts and diagnostics that a robotics engineer can act on.
class Reporter {
 public:
  Reporter(const Model& model, const ProveOptions& options, Problems& problems,
           diag::Diagnostics& diagnostics, Report& report, const std::map<size_t, Witness>& witnesses)
      : model_(model),
        options_(options),
        problems_(problems),
        diagnostics_(diagnostics),
        report_(report),
        witnesses_(witnesses) {}

  /// The assumptions named in `core` cannot all be true.
  void Contradiction(const std::string& what, const std::vector<std::string>& core);
  void NeverEnabled(size_t action, const std::vector<std::string>& core);
  /// Promise `p` does not hold yet when the environment takes over.
  void Unrealisable(size_t p);
  /// Reports each invariant that could not be proved, with its witness or what is known instead.
  void Failures();
  /// Verdicts of the rows that did not fail: proved, unless a proof rests on what is not proved.
  void Verdicts();

 private:
  void FailedInvariant(size_t i);
  void Told(Row& row, const InvariantDef& def, const Witness& witness);
  void FailedDefinedness(Cell& cell, size_t place);
  void Undecided(Row& row, const Cell& cell, diag::Span span, const Witness* candidate);
  diag::Span SpanOf(const std::string& assumption) const;
  std::string Scope() const;

  const Model& model_;
  const ProveOptions& options_;
  Problems& problems_;
  diag::Diagnostics& diagnostics_;
  Report& report_;
  const std::map<size_t, Witness>& witnesses_;
};

}  // namespace rondo::koord
