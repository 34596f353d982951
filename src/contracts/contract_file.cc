#include "contracts/contract_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "workspace/places.h"

namespace rondo::contracts {

nlohmann::json ContractToJson(const char* format, const ContractName& name) {
  nlohmann::json files = nlohmann::json::array();
  for (const std::string& f : name.files) files.push_back(workspace::Absolute(f));
  return {{"format", format},
          {"files", files},
          {"spec", workspace::Absolute(name.spec)},
          {"contract", name.contract}};
}

std::optional<ContractName> ContractFromJson(const nlohmann::json& json) {
  if (!json.is_object()) return std::nullopt;
  const auto is_text = [&](const char* key) { return json.contains(key) && json[key].is_string(); };
  if (!is_text("spec") || !is_text("contract") || !json.contains("files") || !json["files"].is_array() ||
      json["files"].empty())
    return std::nullopt;
  ContractName name{{}, json["spec"].get<std::string>(), json["contract"].get<std::string>()};
  for (const auto& f : json["files"]) {
    if (!f.is_string()) return std::nullopt;
    name.files.push_back(f.get<std::string>());
  }
  return name;
}

bool HasFormat(const nlohmann::json& json, const char* format) {
  return json.is_object() && json.value("format", nlohmann::json()) == format;
}

base::Result<const ContractResult*> FindContract(const ContractName& name, workspace::Session& session,
                                                 LoadedContracts& loaded) {
  if (!LoadContracts(name.files, name.spec, nullptr, true, session, loaded))
    return base::Error{fmt::format("`{}` cannot be used", name.files[0])};
  const auto it = std::ranges::find(loaded.results, name.contract,
                                    [](const ContractResult& r) { return r.made.problem.name; });
  if (it == loaded.results.end() || !it->impossible.empty())
    return base::Error{fmt::format("there is no contract `{}` any more", name.contract)};
  return &*it;
}

}  // namespace rondo::contracts
