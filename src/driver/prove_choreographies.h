#pragma once

#include <string>
#include <vector>

#include "verdict/verdict.h"

/// Carries out `rondo prove` for choreographies.
namespace rondo::driver {

/// Says what `rondo prove` is asked about choreographies.
struct ProveChoreographiesOptions {
  std::vector<std::string> files;
  std::vector<std::string> admitted;  ///< options for every choreography
  unsigned jobs = 0;
  double timeout = 10;       ///< seconds for each obligation
  std::string smt_out;       ///< a folder for the obligations as SMT-LIB 2; empty: none
  std::string certificates;  ///< a folder for certificates; empty: none
  std::string svg;           ///< a file for a picture of the scene; empty: none
  bool certify = true;
  bool cache = true;
  bool json = false;
};

/// Checks and proves every choreography in the files: structure, processes, obligations. Prints what it
/// finds, and returns the exit status.
verdict::ExitStatus ProveChoreographies(const ProveChoreographiesOptions& options);

}  // namespace rondo::driver
