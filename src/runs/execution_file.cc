#include "runs/execution_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/file.h"
#include "contracts/contract_file.h"

namespace rondo::runs {

namespace {

constexpr const char* kFormat = "rondo-execution/1";

}  // namespace

base::Result<bool> SaveExecution(const std::string& path, const ExecutionFile& file) {
  nlohmann::json json = contracts::ContractToJson(kFormat, {file.files, file.spec, file.contract});
  json["breaks"] = file.claim;
  json["time"] = file.time;
  json["start"] = file.execution.start;
  json["inputs"] = file.execution.inputs;
  json["input_period"] = file.execution.input_period;
  return base::WriteFileAtomically(path,
                                   json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

bool IsExecution(std::string_view text) {
  return contracts::HasFormat(nlohmann::json::parse(text, nullptr, false), kFormat);
}

base::Result<ExecutionFile> ReadExecution(std::string_view text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return base::Error{"this is not JSON"};
  ExecutionFile file;
  const auto numbers = [](const nlohmann::json& list, std::vector<double>& out) {
    if (!list.is_array()) return false;
    for (const auto& x : list) {
      if (!x.is_number()) return false;
      out.push_back(x.get<double>());
    }
    return true;
  };
  const auto number_at = [&](const char* key, double& out) {
    if (!json.contains(key) || !json[key].is_number()) return false;
    out = json[key].get<double>();
    return std::isfinite(out);
  };
  const auto name = contracts::ContractFromJson(json);
  bool good = name && json.contains("breaks") && json["breaks"].is_string() && number_at("time", file.time) &&
              number_at("input_period", file.execution.input_period) && file.execution.input_period > 0 &&
              json.contains("start") && numbers(json["start"], file.execution.start) &&
              json.contains("inputs") && json["inputs"].is_array();
  for (const auto& slot : good ? json["inputs"] : nlohmann::json::array())
    good = good && numbers(slot, file.execution.inputs.emplace_back());
  if (!good) return base::Error{"the run is not complete"};
  file.files = name->files;
  file.spec = name->spec;
  file.contract = name->contract;
  file.claim = json["breaks"].get<std::string>();
  return file;
}

base::Result<std::string> ReplayExecution(const ExecutionFile& file, workspace::Session& session) {
  contracts::LoadedContracts loaded;
  const auto found = contracts::FindContract({file.files, file.spec, file.contract}, session, loaded);
  if (!found.ok()) return found.error();
  const contracts::ContractResult* it = found.value();
  const reach::Problem& problem = it->made.problem;
  const auto claim = std::ranges::find(problem.claims, file.claim, &reach::Claim::name);
  bool fits = claim != problem.claims.end() && file.execution.start.size() == problem.states.size();
  for (const auto& slot : file.execution.inputs) fits = fits && slot.size() == problem.inputs.size();
  if (!fits) return base::Error{fmt::format("the contract `{}` is another one now", file.contract)};
  auto made = reach::Trajectories::Of(problem);
  if (!made.ok()) return made.error();
  reach::Trajectories trajectories = std::move(made).value();
  for (size_t i = 0; i < file.execution.start.size(); ++i) {
    const double slack = 1e-9 * (1 + std::fabs(file.execution.start[i]));
    if (file.execution.start[i] < problem.initial[i].lo - slack ||
        file.execution.start[i] > problem.initial[i].hi + slack)
      return base::Error{fmt::format("it does not begin as the contract demands: `{}`", it->made.names[i])};
  }
  for (const auto& slot : file.execution.inputs) {
    for (size_t w = 0; w < slot.size(); ++w) {
      if (!problem.inputs[w].bounds.Contains(slot[w]))
        return base::Error{"an input is outside of its bounds"};
    }
  }
  const double horizon = problem.horizon.ToDouble();
  const auto c = static_cast<size_t>(claim - problem.claims.begin());
  if (file.time < claim->from.ToDouble() - 1e-9 || file.time > claim->to.ToDouble() + 1e-9)
    return base::Error{fmt::format("`{}` need not hold after {:.6g} s", file.claim, file.time)};
  double miss = -HUGE_VAL;
  trajectories.Run(
      file.execution, horizon / 400,
      [&](double t, std::span<const double> x) {
        if (t < file.time - 1e-12) return true;
        miss = trajectories.Miss(c, x);
        return false;
      },
      1e-10);
  if (!(miss > 0)) return base::Error{fmt::format("`{}` holds after {:.6g} s", file.claim, file.time)};
  return fmt::format("replayed: {} breaks `{}` after {:.6g} s", file.contract, file.claim, file.time) +
         (miss < 1e299 ? fmt::format(", by {:.3g}", miss) : "");
}

}  // namespace rondo::runs
