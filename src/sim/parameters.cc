#include "sim/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "koord/semantics/machine/values.h"

namespace rondo::sim {

void ReadParameters(const koord::Model& model, const Fleet& fleet, koord::semantics::TeamOptions& options,
                    koord::semantics::Heap& heap, diag::Diagnostics& diagnostics) {
  for (const auto& [name, given] : fleet.params) {
    const auto found = std::ranges::find(model.variables, name, &koord::Variable::name);
    if (found == model.variables.end() || found->kind != koord::VariableKind::kParam) {
      diagnostics.Report(diag::Kind::kFleetValue, given.span,
                         fmt::format("the program has no parameter `{}`", name));
      continue;
    }
    if (found->initial.valid()) {
      diagnostics.Report(diag::Kind::kFleetValue, given.span, fmt::format("`{}` has a value already", name))
          .At(found->span, "declared here")
          .Help("proofs are about this value: leave it out here, or declare the parameter without one");
      continue;
    }
    const auto words = koord::semantics::FromJson(model.types, heap, found->type, given.value);
    if (words) {
      options.params[static_cast<size_t>(found - model.variables.begin())] = *words;
    } else {
      diagnostics.Report(diag::Kind::kFleetValue, given.span,
                         fmt::format("`{}` must be {}", name, model.types.WithArticle(found->type)));
    }
  }
}

}  // namespace rondo::sim
