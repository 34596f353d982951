#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

/// What verdicts rest on: assumptions that are used, proved elsewhere, or not needed.
namespace rondo::verdict {

/// Names what decided a claim.
enum class Engine : uint8_t {
  kReachability,  ///< contracts of motions and ports, by tubes
};
/// Returns the word that people and JSON see: `reachability`.
std::string_view Name(Engine engine);

/// Is an assumption that another engine has proved.
struct Discharged {
  std::string claim;  ///< as it stands in the specification
  Engine by = Engine::kReachability;
  std::vector<std::string> limits;  ///< of which model, for which starts, under which assumptions of its own
};

/// Is what a verdict rests on. Every line of it is shown beside the verdict.
struct Basis {
  std::vector<std::string> assumed;  ///< used by some proof, and not proved
  std::vector<Discharged> proved;    ///< used, and proved by another engine
  std::vector<std::string> unused;   ///< stated, but no proof needed them
};

/// Returns {assumed: [...], proved: [{claim, by, limits}], unused: [...]}.
nlohmann::json ToJson(const Basis& basis);

}  // namespace rondo::verdict
