#include "contracts/contract.h"

namespace rondo::contracts {

verdict::Verdict VerdictOf(const ContractResult& r) {
  if (!r.impossible.empty()) return verdict::Verdict::kUnknown;
  if (!r.same_as.empty()) return verdict::Verdict::kProved;
  return r.outcome ? reach::VerdictOf(*r.outcome) : verdict::Verdict::kUnknown;
}

std::string_view Word(const ContractResult& r) {
  const bool begun = !r.impossible.empty() || !r.same_as.empty() || r.outcome;
  return begun ? verdict::Name(VerdictOf(r)) : "not begun";
}

verdict::Basis BasisOf(const ContractResult& r) { return {r.made.assumed, {}, {}}; }

}  // namespace rondo::contracts
