#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "driver/load.h"
#include "koord/prove/prove.h"

namespace rondo::driver {

/// What was asked: file, number of obligations, scope.
std::string ProveHeader(const std::string& file, const koord::Report& report,
                        const koord::ProveOptions& options, size_t cached);
/// One line for each invariant, one word for each obligation.
std::string ProveTable(const koord::Report& report);
/// The verdict, what it rests on, and what to do next. `discharged`: what reachability has proved.
std::string ProveSummary(const koord::Report& report, const koord::ProveOptions& options, int status,
                         const std::vector<std::string>& discharged);

/// The same as data; `report` is nullptr when the program was not proved because of errors.
nlohmann::json ProveJson(const Session& session, const std::string& file, const koord::Report* report,
                         int status);

std::string_view VerdictName(koord::Verdict verdict);

}  // namespace rondo::driver
