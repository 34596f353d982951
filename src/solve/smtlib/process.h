#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/stop.h"

/// Other programs, run as children.
namespace rondo::solve::smtlib {

/// Is what a program left behind.
struct ProcessOutput {
  int status = 0;          ///< exit status; 128 + signal if it was killed
  bool timed_out = false;  ///< it was killed: the limit passed, or `stop` asked
  std::string text;        ///< its standard output; standard error is thrown away
};

/// Runs `command` (searched in PATH) with `input` on its standard input until it closes its standard output,
/// `limit` passes or `stop` asks. The child is killed in the latter cases. @error when it cannot be started.
base::Result<ProcessOutput> RunProcess(const std::vector<std::string>& command, const std::string& input,
                                       std::chrono::milliseconds limit, const base::StopToken& stop);

}  // namespace rondo::solve::smtlib
