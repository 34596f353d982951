#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "choreo/syntax/ast.h"
#include "diag/diagnostic.h"
#include "robot/model/world.h"

/// Finds what a module declares.
namespace rondo::choreo {

/// Holds what a module declares, by name. Refers to the module, which must outlive it.
class Declarations {
 public:
  template <typename T>
  using Table = std::map<std::string, const T*, std::less<>>;

  /// Reads the declarations. Reports names that are declared twice, and robot types that make no sense.
  /// @param loose  a parameter of robots that has a range instead of a value; outlives this.
  Declarations(const Module& module, expr::Arena& arena, diag::Diagnostics& diagnostics,
               const robot::Loose* loose = nullptr);

  /// Returns the contract of this name; nullptr after a report.
  const ContractDef* FindContract(const Name& name);
  /// Returns the world of this name, which is built at the first call; nothing after a report.
  std::shared_ptr<const robot::World> FindWorld(const Name& name);
  /// Reports that a name is not declared, with the nearest of `names` as a suggestion.
  /// @param what  says what the name should be.
  /// @param owner  what should have it; empty if the whole module.
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
