#pragma once

#include <string>
#include <vector>

#include "verdict/verdict.h"

namespace rondo::driver {

/// What `rondo prove` is asked about choreographies.
struct ProveChoreographiesOptions {
  std::vector<std::string> files;
  std::vector<std::string> admitted;  ///< options for every choreography
  unsigned jobs = 0;
  double timeout = 10;  ///< seconds for each obligation
  std::string smt_out;
  std::string certificates;
  std::string svg;
  bool certify = true;
  bool cache = true;
  bool json = false;
};

/// Structure, obligations and processes of every choreography in the files.
verdict::ExitStatus ProveChoreographies(const ProveChoreographiesOptions& options);

}  // namespace rondo::driver
