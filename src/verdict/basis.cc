#include "verdict/basis.h"

#include <nlohmann/json.hpp>

namespace rondo::verdict {

std::string_view Name(Engine engine) {
  switch (engine) {
    case Engine::kReachability:
      return "reachability";
  }
  return "";
}

nlohmann::json ToJson(const Basis& basis) {
  nlohmann::json proved = nlohmann::json::array();
  for (const Discharged& d : basis.proved)
    proved.push_back({{"claim", d.claim}, {"by", Name(d.by)}, {"limits", d.limits}});
  return {{"assumed", basis.assumed}, {"proved", proved}, {"unused", basis.unused}};
}

}  // namespace rondo::verdict
