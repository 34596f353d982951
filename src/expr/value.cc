#include "expr/value.h"

namespace rondo::expr {

std::string ToString(const Value& value) {
  if (value.IsBool()) return value.AsBool() ? "true" : "false";
  if (value.IsNumber()) return value.AsNumber().ToString();
  if (const auto* name = std::get_if<std::string>(&value.data)) return *name;
  std::string text = "(";
  for (const Value& field : std::get<Value::Fields>(value.data)) {
    if (text.size() > 1) text += ", ";
    text += ToString(field);
  }
  return text + ")";
}

}  // namespace rondo::expr
