#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "koord/prove/prove.h"

/// Presents what was proved of a Koord program, as text and as data.
namespace rondo::contracts {

/// Returns what was asked: file, number of obligations, scope.
std::string ProveHeader(const std::string& file, const koord::Report& report,
                        const koord::ProveOptions& options, size_t cached);
/// Returns a table with one line for each invariant, one word for each obligation.
std::string ProveTable(const koord::Report& report);
/// Returns the verdict, and what it rests on.
std::string ProveSummary(const koord::Report& report, const koord::ProveOptions& options);

/// Returns the report as JSON: {invariants: [{name, verdict, place, obligations: [{id, case, verdict,
/// seconds, used}]}], rests_on, ...}.
nlohmann::json ToJson(const koord::Report& report, const diag::SourceSet& sources);

}  // namespace rondo::contracts
