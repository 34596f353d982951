#include "expr/import.h"

#include "base/check.h"
#include "expr/substitute.h"

namespace rondo::expr {

TermId Importer::operator()(TermId term) {
  if (const auto it = known_.find(term); it != known_.end()) return it->second;
  std::unordered_set<TermId> seen;
  VisitPostorder(from_, term, seen, [&](TermId t) {
    if (!known_.contains(t)) known_.emplace(t, One(t));
  });
  return known_.at(term);
}

SortId Importer::SortOf(TermId term) const {
  switch (from_.sort(from_.sort_of(term)).kind) {
    case SortKind::kBool:
      return to_.Bool();
    case SortKind::kInt:
      return to_.Int();
    case SortKind::kReal:
      return to_.Real();
    default:
      break;
  }
  CHECK(false) << "a term of sort " << from_.sort(from_.sort_of(term)).name << " cannot be copied";
  return {};
}

TermId Importer::One(TermId term) {
  const SortId sort = SortOf(term);
  Term like = from_.term(term);
  std::vector<TermId> args;
  for (const TermId a : from_.args(term)) args.push_back(known_.at(a));
  switch (like.op) {
    case Op::kBool:
      return to_.Constant(term == from_.True());
    case Op::kNumber:
      return to_.Number(sort, from_.number(term));
    case Op::kVariable:
      return to_.Variable(to_.Declare(from_.symbol(from_.symbol_of(term)).name, {}, sort));
    case Op::kApply:
    case Op::kForall:
    case Op::kExists:
      CHECK(false) << "a term made with " << Name(like.op) << " cannot be copied";
      break;
    default:
      break;
  }
  like.sort = sort;
  return to_.Rebuild(like, std::move(args));
}

}  // namespace rondo::expr
