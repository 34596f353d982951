#pragma once

#include <string>
#include <vector>

#include "base/id.h"

namespace rondo::lang {

using TypeId = base::Id<struct TypeTag>;

enum class TypeKind : uint8_t {
  kError,     ///< reported already; agrees with everything
  kVariable,  ///< not known yet; see TypeTable::Unify
  kBool,
  kInt,
  kFloat,
  kString,
  kStream,
  kRecord,  ///< parts: field types
  kTuple,   ///< parts; fields are called first, second, ...
  kEnum,
  kArray,   ///< parts: element; `length` says how many
  kList,    ///< parts: element
  kOpaque,  ///< only functions look inside
};

struct Type {
  TypeKind kind;
  std::string name;                 ///< of records, enumerations and opaque types
  std::vector<std::string> fields;  ///< fields of a record, members of an enumeration
  std::vector<TypeId> parts;
  std::string length{};  ///< of an array: the expression, as written; equal lengths are equal texts
};

/// The types of one program.
class TypeTable {
 public:
  TypeTable();

  TypeId error() const { return TypeId(0); }
  TypeId boolean() const { return TypeId(1); }
  TypeId integer() const { return TypeId(2); }
  TypeId real() const { return TypeId(3); }
  TypeId string() const { return TypeId(4); }
  TypeId stream() const { return TypeId(5); }
  TypeId pos() const { return TypeId(6); }  ///< record of real x, y, z: metres
  TypeId Array(TypeId element, std::string length);
  TypeId List(TypeId element);
  TypeId Tuple(std::vector<TypeId> parts);
  TypeId Record(std::string name, std::vector<std::string> fields, std::vector<TypeId> parts);
  /// For records that may mention themselves through lists: first the name, then the fields.
  void SetFields(TypeId record, std::vector<std::string> fields, std::vector<TypeId> parts);
  TypeId Enum(std::string name, std::vector<std::string> members);
  TypeId Opaque(std::string name);
  TypeId FreshVariable();

  /// Follows bound variables at the top.
  TypeId Resolve(TypeId type) const;
  const Type& operator[](TypeId type) const { return types_[Resolve(type).index()]; }
  bool Is(TypeId type, TypeKind kind) const { return (*this)[type].kind == kind; }
  bool IsNumeric(TypeId type) const { return Is(type, TypeKind::kInt) || Is(type, TypeKind::kFloat); }

  /// Makes both types equal by binding variables; false if they cannot be. Errors agree with everything.
  bool Unify(TypeId a, TypeId b);
  /// Can a value of type `from` stand where `to` is needed? Like Unify, and an int may be a float.
  bool Coerce(TypeId from, TypeId to);
  /// Is any part not known yet?
  bool HasVariable(TypeId type) const;

  std::string Name(TypeId type) const;

 private:
  TypeId Add(Type type);
  bool Occurs(TypeId variable, TypeId in) const;

  std::vector<Type> types_;
  std::vector<TypeId> bound_;
};

}  // namespace rondo::lang
