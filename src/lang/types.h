#pragma once

#include <string>
#include <vector>

#include "base/id.h"

/// The types of programs, and their inference by unification.
namespace rondo::lang {

/// Names a type of one TypeTable.
using TypeId = base::Id<struct TypeTag>;

/// Says what the values of a type are; see `Type` for its parts.
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

/// Describes a type. Two types may be equal and yet have different ids: compare them with Unify.
struct Type {
  TypeKind kind;
  std::string name;                 ///< of records, enumerations and opaque types
  std::vector<std::string> fields;  ///< fields of a record, members of an enumeration
  std::vector<TypeId> parts;
  std::string length{};  ///< of an array: the expression as written; lengths are equal if their texts are
};

/// Owns the types of one program.
class TypeTable {
 public:
  TypeTable();

  TypeId error() const { return TypeId(0); }
  TypeId boolean() const { return TypeId(1); }
  TypeId integer() const { return TypeId(2); }
  TypeId real() const { return TypeId(3); }
  TypeId string() const { return TypeId(4); }
  TypeId stream() const { return TypeId(5); }
  TypeId pos() const { return TypeId(6); }  ///< the record of real x, y, z, in metres
  TypeId Array(TypeId element, std::string length);
  TypeId List(TypeId element);
  TypeId Tuple(std::vector<TypeId> parts);
  TypeId Record(std::string name, std::vector<std::string> fields, std::vector<TypeId> parts);
  /// Gives a record its fields: for records that may mention themselves through lists, first the name, then
  /// this.
  void SetFields(TypeId record, std::vector<std::string> fields, std::vector<TypeId> parts);
  TypeId Enum(std::string name, std::vector<std::string> members);
  TypeId Opaque(std::string name);
  /// Returns a type that is not known yet, and that Unify may bind.
  TypeId FreshVariable();

  /// Returns the type that a variable is bound to, at the top only; other types as they are.
  TypeId Resolve(TypeId type) const;
  const Type& operator[](TypeId type) const { return types_[Resolve(type).index()]; }
  bool Is(TypeId type, TypeKind kind) const { return (*this)[type].kind == kind; }
  bool IsNumeric(TypeId type) const { return Is(type, TypeKind::kInt) || Is(type, TypeKind::kFloat); }

  /// Makes both types equal by binding variables, and returns true; false if they cannot be. Errors agree
  /// with everything.
  bool Unify(TypeId a, TypeId b);
  /// Reports whether a value of type `from` can stand where `to` is needed: like Unify, and an int may be a
  /// float.
  bool Coerce(TypeId from, TypeId to);
  /// Reports whether some part of the type is not known yet.
  bool HasVariable(TypeId type) const;

  /// Returns the type as it is written in programs, for messages.
  std::string Name(TypeId type) const;
  /// Returns it for a sentence: "an `int`", "a `pos`".
  std::string WithArticle(TypeId type) const;

 private:
  TypeId Add(Type type);
  bool Occurs(TypeId variable, TypeId in) const;

  std::vector<Type> types_;
  std::vector<TypeId> bound_;
};

}  // namespace rondo::lang
