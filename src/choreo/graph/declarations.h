#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "choreo/syntax/ast.h"
#include "diag/diagnostic.h"
#include "robot/model/world.h"

namespace rondo::choreo {

/// What a module declares, by name. Refers to the module.
class Declarations {
 public:
  template <typename T>
  using Table = std::map<std::string, const T*, std::less<>>;

  /// Reports names that are declared twice, and robot types that make no sense.
  /// `loose`: a parameter of robots that has a range instead of a value; outlives it.
  Declarations(const Module& module, expr::Arena& arena, diag::Diagnostics& diagnostics,
               const robot::Loose* loose = nullptr);

  const ContractDef* FindContract(const Name& name);
  /// The world, built at the first call; nothing after a report.
  std::shared_ptr<const robot::World> FindWorld(const Name& name);
  /// `owner`: what should have it; empty if the whole module.
  void Undeclared(const Name& name, std::string_view what, const std::vector<std::string>& names,
                  std::string_view owner = {});

  robot::Evaluator& evaluator() { return evaluator_; }

 private:
  template <typename T>
  void Add(Table<T>& table, const Name& name, const T* value);
  template <typename T>
  const T* Find(const Table<T>& table, const Name& name, std::string_view what);

  diag::Diagnostics& diagnostics_;
  robot::Evaluator evaluator_;
  Table<RobotDef> robots_;
  Table<WorldDef> worlds_;
  Table<ContractDef> contracts_;
  Table<ChoreographyDef> choreographies_;
  std::map<const WorldDef*, std::shared_ptr<const robot::World>> built_;
};

}  // namespace rondo::choreo
