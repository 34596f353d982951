#include "runs/run_file.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/file.h"
#include "koord/semantics/machine/values.h"
#include "workspace/places.h"

namespace rondo::runs {

namespace {

// Lists and texts come from a heap of their own: counterexamples have none.
nlohmann::json ValuesToJson(const koord::Model& model, size_t v,
                            const std::vector<koord::semantics::Word>& words) {
  koord::semantics::Heap heap;
  const lang::TypeId type = model.variables[v].type;
  const uint32_t width = koord::semantics::Layout::Width(model.types, type);
  nlohmann::json list = nlohmann::json::array();
  for (size_t i = 0; i + width <= words.size(); i += width)
    list.push_back(koord::semantics::ToJson(model.types, heap, type, std::span(words).subspan(i, width)));
  return list;
}

}  // namespace

void KeepParameters(RunFile& run, const koord::Model& model, const koord::semantics::TeamOptions& options) {
  for (const auto& [v, words] : options.params)
    run.params[model.variables[v].name] = ValuesToJson(model, v, words);
  for (const auto& [v, words] : options.choices)
    run.choices[model.variables[v].name] = ValuesToJson(model, v, words);
}

void AdoptParameters(const RunFile& run, const koord::Model& model, koord::semantics::TeamOptions& options,
                     koord::semantics::Heap& heap) {
  const auto adopt = [&](const nlohmann::json& given,
                         std::map<size_t, std::vector<koord::semantics::Word>>& to) {
    for (size_t v = 0; v < model.variables.size(); ++v) {
      const auto it = given.find(model.variables[v].name);
      if (it == given.end() || !it->is_array()) continue;
      for (const nlohmann::json& item : *it) {
        const auto words = koord::semantics::FromJson(model.types, heap, model.variables[v].type, item);
        if (words) to[v].insert(to[v].end(), words->begin(), words->end());
      }
    }
  };
  adopt(run.params, options.params);
  adopt(run.choices, options.choices);
}

base::Result<bool> SaveRun(const std::string& path, const RunFile& run) {
  const nlohmann::json file{{"format", "rondo-run/1"},
                            {"engine", run.engine},
                            {"program", workspace::Absolute(run.program)},
                            {"spec", workspace::Absolute(run.spec)},
                            {"robots", run.robots},
                            {"breaks", run.property},
                            {"params", run.params},
                            {"choices", run.choices},
                            {"steps", run.steps}};
  return base::WriteFileAtomically(path,
                                   file.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

base::Result<RunFile> ReadRun(const std::string& text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded()) return base::Error{"this is not JSON"};
  const auto text_at = [&](const char* key) {
    return json.contains(key) && json[key].is_string() ? json[key].get<std::string>() : std::string();
  };
  if (!json.is_object() || text_at("format") != "rondo-run/1")
    return base::Error{"this is not a run of Rondo's"};
  if (!json.contains("robots") || !json["robots"].is_number_unsigned() || json["robots"] < 1 ||
      json["robots"] > 64 || !json.contains("steps") || !json["steps"].is_array()) {
    return base::Error{"the run is not complete"};
  }
  const auto object_at = [&](const char* key) {
    return json.contains(key) && json[key].is_object() ? json[key] : nlohmann::json::object();
  };
  return RunFile{text_at("program"), text_at("spec"), json["robots"].get<size_t>(), text_at("breaks"),
                 text_at("engine"),  json["steps"],   object_at("params"),          object_at("choices")};
}

}  // namespace rondo::runs
