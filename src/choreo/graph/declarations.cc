#include "choreo/graph/declarations.h"

#include <fmt/format.h>

#include "lang/suggest.h"

namespace rondo::choreo {

using diag::Kind;

Declarations::Declarations(const Module& module, expr::Arena& arena, diag::Diagnostics& diagnostics,
                           const robot::Loose* loose)
    : diagnostics_(diagnostics), evaluator_(arena, module.exprs, diagnostics, loose) {
  for (const Item& item : module.items) {
    if (const auto* robot = std::get_if<RobotDef>(&item)) Add(robots_, robot->name, robot);
    if (const auto* world = std::get_if<WorldDef>(&item)) Add(worlds_, world->name, world);
    if (const auto* contract = std::get_if<ContractDef>(&item)) Add(contracts_, contract->name, contract);
    if (const auto* choreography = std::get_if<ChoreographyDef>(&item))
      Add(choreographies_, choreography->name, choreography);
  }
  for (const auto& [name, type] : robots_) robot::CheckRobot(*type, evaluator_);
  for (const Item& item : module.items) {
    if (const auto* world = std::get_if<WorldDef>(&item)) FindWorld(world->name);
  }
}

template <typename T>
void Declarations::Add(Table<T>& table, const Name& name, const T* value) {
  const auto [it, fresh] = table.emplace(name.text, value);
  if (fresh) return;
  diagnostics_.Report(Kind::kChoreoDuplicate, name.span, fmt::format("`{}` is declared twice", name.text))
      .At(it->second->name.span, "first here");
}

template <typename T>
const T* Declarations::Find(const Table<T>& table, const Name& name, std::string_view what) {
  if (const auto it = table.find(name.text); it != table.end()) return it->second;
  std::vector<std::string> names;
  for (const auto& [known, value] : table) names.push_back(known);
  Undeclared(name, what, names);
  return nullptr;
}

const ContractDef* Declarations::FindContract(const Name& name) { return Find(contracts_, name, "contract"); }

std::shared_ptr<const robot::World> Declarations::FindWorld(const Name& name) {
  const WorldDef* source = Find(worlds_, name, "world");
  if (source == nullptr) return nullptr;
  auto& world = built_[source];
  if (world == nullptr) world = robot::BuildWorld(*source, robots_, evaluator_);
  return world;
}

void Declarations::Undeclared(const Name& name, std::string_view what, const std::vector<std::string>& names,
                              std::string_view owner) {
  auto& report =
      diagnostics_.Report(Kind::kChoreoUndeclared, name.span,
                          owner.empty() ? fmt::format("there is no {} `{}`", what, name.text)
                                        : fmt::format("`{}` has no {} `{}`", owner, what, name.text));
  if (name.span.begin == name.span.end) return;  // not from a text: a file is called so
  if (const std::string near = lang::Suggest(name.text, names); !near.empty())
    report.Help(fmt::format("did you mean `{}`?", near)).Fix(name.span, near);
}

}  // namespace rondo::choreo
