#pragma once

#include <map>
#include <set>
#include <string>

#include "contracts/contract.h"

/// Saves proofs of contracts that differ from proved ones in places only.
namespace rondo::contracts {

/// Keeps the tubes of contracts that are proved, for those of other robots and other places. Where dynamics,
/// controller and start are the same but for a translation, so is the tube: every claim needs to be the same,
/// too, or to hold on its boxes. Contracts that are the same but for parameters that do not matter
/// (robot/dynamics/symmetry.h: headings among them) are proved together (docs/theory.md, "Symmetry").
class TubeReuse {
 public:
  /// Tells which contract shows another one.
  struct Cover {
    std::string contract;  ///< that shows this one; empty if there is none
    /// Holds the certificate of the same tube; nothing if this contract's own tube is another one: then the
    /// verdict is about that of the other contract.
    std::optional<reach::certify::Certificate> certificate;
    std::optional<reach::certify::Acceptance> certified;
  };
  /// Returns a contract that was remembered and whose proof is also one of this contract; an empty cover if
  /// there is none.
  Cover Covers(const ContractResult& contract) const;
  /// Keeps the tube of a contract that is proved, for later calls of `Covers`; does nothing with other
  /// contracts.
  void Remember(const ContractResult& contract, reach::certify::Certificate certificate);

 private:
  struct Tube {
    std::string contract;
    std::vector<reach::Leaf> leaves;  ///< in centred coordinates
    reach::certify::Certificate certificate;
    std::set<std::string> claims;  ///< that were proved, as text
  };
  std::map<std::string, Tube> tubes_;      ///< by the text of the centred problem without claims
  std::map<std::string, Cover> anywhere_;  ///< by the text of what is left without places
};

}  // namespace rondo::contracts
