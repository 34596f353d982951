#pragma once

#include <unordered_map>

#include "expr/arena.h"

/// Terms of one arena in another.
namespace rondo::expr {

/// Copies terms from one arena to another, so that threads can build terms without each other. Symbols keep
/// their names. Terms over truth values, integers and reals only: no uninterpreted functions, no quantifiers,
/// no data. `from` is only read. Cost: linear in the number of distinct subterms, each once.
class Importer {
 public:
  Importer(const Arena& from, Arena& to) : from_(from), to_(to) {}
  /// Returns the copy of a term of `from`. What an earlier call has copied is not copied again.
  TermId operator()(TermId term);

 private:
  TermId One(TermId term);
  SortId SortOf(TermId term) const;

  const Arena& from_;
  Arena& to_;
  std::unordered_map<TermId, TermId> known_;
};

}  // namespace rondo::expr
