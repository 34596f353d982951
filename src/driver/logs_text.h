#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "deploy/judge_logs.h"
#include "verdict/verdict.h"

namespace rondo::driver {

/// Returns what logs of a fleet say together, for people: lines that begin with two spaces.
std::string LogsText(const deploy::LogsReport& report);
/// Returns the same as data.
nlohmann::json LogsJson(const deploy::LogsReport& report);
/// Returns the status that follows: rejected if something is wrong, undecided if not everything could be judged.
verdict::ExitStatus LogsStatus(const deploy::LogsReport& report);

/// Returns, of increasing numbers, that which so large a share of them does not exceed.
double Quantile(const std::vector<double>& sorted, double share);

}  // namespace rondo::driver
