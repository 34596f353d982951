#include "driver/run_file.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/file.h"
#include "solve/cache/proof_cache.h"

namespace rondo::driver {

std::string DefaultRunFile(const std::string& program, const std::string& property) {
  const std::filesystem::path folder = solve::cache::ProofCache::DefaultFolder().parent_path() / "runs";
  std::string name = std::filesystem::path(program).stem().string() + "-" + property;
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
  }
  return (folder / (name + ".json")).string();
}

base::Result<bool> SaveRun(const std::string& path, const RunFile& run, const koord::Model&) {
  std::error_code ignored;
  const auto absolute = [&](const std::string& file) {
    return file.empty() ? std::string() : std::filesystem::absolute(file, ignored).lexically_normal().string();
  };
  const nlohmann::json file{{"format", "rondo-run/1"},
                            {"engine", run.engine},
                            {"program", absolute(run.program)},
                            {"spec", absolute(run.spec)},
                            {"robots", run.robots},
                            {"breaks", run.property},
                            {"steps", run.steps}};
  return base::WriteFileAtomically(path, file.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

base::Result<RunFile> LoadRun(const std::string& path) {
  const auto text = base::ReadFile(path);
  if (!text.ok()) return text.error();
  const auto json = nlohmann::json::parse(text.value(), nullptr, false);
  if (json.is_discarded()) return base::Error{"this is not JSON"};
  const auto text_at = [&](const char* key) {
    return json.contains(key) && json[key].is_string() ? json[key].get<std::string>() : std::string();
  };
  if (!json.is_object() || text_at("format") != "rondo-run/1") return base::Error{"this is not a run of Rondo's"};
  if (!json.contains("robots") || !json["robots"].is_number_unsigned() || json["robots"] < 1 ||
      json["robots"] > 64 || !json.contains("steps") || !json["steps"].is_array()) {
    return base::Error{"the run is not complete"};
  }
  return RunFile{text_at("program"), text_at("spec"),   json["robots"].get<size_t>(),
                 text_at("breaks"),  text_at("engine"), json["steps"]};
}

}  // namespace rondo::driver
