#pragma once

#include <map>
#include <set>
#include <string>

#include "contracts/contract.h"

namespace rondo::contracts {

/// Tubes of contracts that are proved, for those of other robots and other places. Where dynamics, controller
/// and start are the same but for a translation, so is the tube: every claim needs to be the same, too, or to
/// hold on its boxes. Contracts that are the same but for parameters that do not matter
/// (robot/dynamics/symmetry.h: headings among them) are proved together.
class TubeReuse {
 public:
  struct Cover {
    std::string contract;  ///< that shows this one; empty if there is none
    /// Of the same tube; nothing if this contract's own tube is another one: then the verdict is about that
    /// of the other contract.
    std::optional<reach::certify::Certificate> certificate;
    std::optional<reach::certify::Acceptance> certified;
  };
  Cover Covers(const ContractResult& contract) const;
  /// Keeps what is proved.
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
