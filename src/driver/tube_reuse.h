#pragma once

#include <map>
#include <set>
#include <string>

#include "driver/reachability.h"

namespace rondo::driver {

/// Tubes of contracts that are proved, for those of other robots and other places: where dynamics, controller
/// and start are the same but for a translation, so is the tube. Then every claim needs to be the same, too,
/// or to hold on the boxes of the tube.
class TubeReuse {
 public:
  /// The contract whose tube shows that this one is kept, and its certificate; empty if there is none.
  std::string Covers(const ContractResult& contract, reach::certify::Certificate& certificate) const;
  /// Keeps what is proved.
  void Remember(const ContractResult& contract, reach::certify::Certificate certificate);

 private:
  struct Tube {
    std::string contract;
    std::vector<reach::Leaf> leaves;  ///< in centred coordinates
    reach::certify::Certificate certificate;
    std::set<std::string> claims;  ///< that were proved, as text
  };
  std::map<std::string, Tube> tubes_;  ///< by the text of the centred problem without claims
};

}  // namespace rondo::driver
