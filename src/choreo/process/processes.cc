#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "choreo/process/typing.h"

namespace rondo::choreo {
namespace {

using diag::Kind;
using diag::Span;

/// Finds the choreography that each process belongs to.
class Processes {
 public:
  Processes(const std::vector<Typed>& typed, Declarations& declarations)
      : typed_(typed), declarations_(declarations), diagnostics_(declarations.evaluator().diagnostics()) {}

  std::vector<SideCondition> Run(const Module& module) {
    std::vector<SideCondition> all;
    std::map<std::pair<std::string, std::string>, Span> known;
    for (const Item& item : module.items) {
      const auto* process = std::get_if<ProcessDef>(&item);
      if (process == nullptr) continue;
      const Typed* typed = Find(*process);
      if (typed == nullptr) continue;
      const auto [it, fresh] =
          known.emplace(std::pair(typed->graph->source->name.text, process->robot.text), process->span);
      if (!fresh) {
        diagnostics_
            .Report(Kind::kChoreoDuplicate, process->span,
                    fmt::format("`{}` has two processes", process->robot.text))
            .At(it->second, "the other one");
      }
      const auto flow = BuildFlow(*process, *typed->graph, declarations_);
      if (!flow) continue;
      const LocalType& type = typed->types[flow->robot.index()];
      auto conditions = TypeProcess(*flow, *typed->graph, type, declarations_);
      for (SideCondition& c : conditions) c.graph = typed->graph;
      std::ranges::move(conditions, std::back_inserter(all));
    }
    return all;
  }

 private:
  const Typed* Find(const ProcessDef& process) {
    if (process.choreography.text.empty() && typed_.size() == 1) return &typed_[0];
    std::vector<std::string> names;
    for (const Typed& t : typed_) {
      names.push_back(t.graph->source->name.text);
      if (names.back() == process.choreography.text) return &t;
    }
    if (!process.choreography.text.empty()) {
      declarations_.Undeclared(process.choreography, "choreography", names);
    } else {
      diagnostics_
          .Report(Kind::kChoreoUndeclared, process.robot.span,
                  typed_.empty() ? "there is no choreography for this process"
                                 : "nothing says which choreography this process belongs to")
          .Help("write `process NAME in CHOREOGRAPHY`");
    }
    return nullptr;
  }

  const std::vector<Typed>& typed_;
  Declarations& declarations_;
  diag::Diagnostics& diagnostics_;
};

}  // namespace

std::vector<SideCondition> CheckProcesses(const Module& module, const std::vector<Typed>& typed,
                                          Declarations& declarations) {
  return Processes(typed, declarations).Run(module);
}

}  // namespace rondo::choreo
