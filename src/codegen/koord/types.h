#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "diag/diagnostic.h"
#include "koord/semantics/team.h"

/// The types of programs as types of C++.
namespace rondo::codegen {

using koord::TypeId;
using koord::semantics::Word;

/// Says how many items lists have room for, and values of external types, in numbers, and texts, in bytes.
struct Capacities {
  std::optional<uint32_t> others;                ///< of what is not named
  std::map<std::string, uint32_t> by_type = {};  ///< such as `List<pos>`, `GridMap`, `string`
};

/// Names types. Reports, once for each type and where it was met first, what has no C++ type: a list without a capacity, a record
/// that contains itself.
class Types {
 public:
  Types(const koord::semantics::Team& team, const Capacities& capacities, diag::Diagnostics& diagnostics);

  /// Returns the C++ type. `where`: what to show if there is none.
  std::string Of(TypeId type, diag::Span where);
  /// Returns a value, given by words of the machine.
  std::string Literal(TypeId type, std::span<const Word> words, diag::Span where);
  /// Returns the definitions of all records, tuples and enumerations that were named so far, each behind what it needs.
  const std::string& definitions() const { return definitions_; }

  /// Returns the C++ name of a member.
  std::string Member(TypeId record, size_t index) const;
  bool Is(TypeId type, lang::TypeKind kind) const { return types_.Is(type, kind); }
  /// Returns how many items an array type has; nothing if it is not known.
  std::optional<uint32_t> LengthOf(TypeId array) const;
  /// Returns how many items a list type has room for.
  std::optional<uint32_t> CapacityOf(TypeId list) const;
  /// Returns the bytes that texts have room for.
  uint32_t TextCapacity() const;
  /// Returns the bytes that an event may write to streams.
  uint32_t SaidCapacity() const;
  /// Returns the names of capacities that no type of the program has.
  std::vector<std::string> Unused() const;
  /// Returns the types of the program that have a capacity.
  const std::set<std::string>& capable() const { return asked_; }

 private:
  double BytesOf(TypeId type, int level = 0) const;
  std::string Define(TypeId type, diag::Span where);
  void Refuse(TypeId type, diag::Span where, const std::string& what, const std::string& help);

  const koord::semantics::Team& team_;
  const lang::TypeTable& types_;
  const Capacities& capacities_;
  diag::Diagnostics& diagnostics_;
  std::map<std::string, std::string> names_;  // by the name in the program
  std::set<std::string> defining_;
  std::set<std::string> refused_;
  mutable std::set<std::string> asked_;  // those whose capacity somebody asked for
  std::string definitions_;
};

}  // namespace rondo::codegen
