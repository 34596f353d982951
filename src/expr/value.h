#pragma once

#include <string>
#include <variant>
#include <vector>

#include "expr/rational.h"

/// Values of terms, as models and counterexamples give them.
namespace rondo::expr {

/// Is a value of a model: a truth value, a number, the name of a member of an enumeration or of an element of
/// an opaque sort, or a record's fields.
struct Value {
  using Fields = std::vector<Value>;
  std::variant<bool, Rational, std::string, Fields> data;

  bool IsBool() const { return std::holds_alternative<bool>(data); }
  bool IsNumber() const { return std::holds_alternative<Rational>(data); }
  bool AsBool() const { return std::get<bool>(data); }
  const Rational& AsNumber() const { return std::get<Rational>(data); }
  friend bool operator==(const Value&, const Value&) = default;
};

/// Returns `true`, `0.5`, `red`, `(1, 2, 3)`; numbers without a short decimal as fractions.
std::string ToString(const Value& value);

}  // namespace rondo::expr
