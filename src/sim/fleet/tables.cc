#include "sim/fleet/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lang/suggest.h"

namespace rondo::sim {

using diag::Kind;
using diag::Span;
using nlohmann::json;

namespace {

constexpr const char* kLost = "this number is too large or too small to be read";

}  // namespace

toml::table Tables::Root() {
  try {
    return toml::parse(sources_.text(file_), sources_.path(file_));
  } catch (const toml::parse_error& error) {
    diagnostics_.Report(Kind::kFleetSyntax, At(error.source()),
                        fmt::format("this is not TOML: {}", error.description()));
    return {};
  }
}

Span Tables::At(const toml::source_region& region) const {
  // Lines and columns count from 1; a column is a code point.
  uint32_t line = std::max<uint32_t>(1, region.begin.line);
  const std::string_view text = sources_.text(file_);
  uint32_t begin = 0;
  for (; line > 1 && begin < text.size(); ++begin) line -= text[begin] == '\n' ? 1 : 0;
  for (uint32_t column = 1; column < region.begin.column && begin < text.size(); ++column) {
    ++begin;
    while (begin < text.size() && (static_cast<unsigned char>(text[begin]) & 0xC0U) == 0x80U) ++begin;
  }
  uint32_t end = begin;
  while (end < text.size() && text[end] != '\n' && text[end] != '#' && text[end] != ',' && end < begin + 60)
    ++end;
  while (end > begin + 1 && std::isspace(static_cast<unsigned char>(text[end - 1]))) --end;
  return {file_, begin, std::max(end, begin + 1)};
}
// A number that is not zero and has become zero, or infinite.
bool Tables::Lost(const toml::node& node) {
  if (!node.is_floating_point()) return false;
  const double value = node.value<double>().value_or(0);
  if (std::isnormal(value)) return false;
  const Span span = At(node);
  const std::string_view text =
      std::string_view(sources_.text(file_)).substr(span.begin, span.end - span.begin);
  return text.substr(0, text.find_first_of("eE")).find_first_of("123456789") != std::string_view::npos;
}

void Tables::Wrong(Span span, std::string message) {
  diagnostics_.Report(Kind::kFleetValue, span, std::move(message));
}

void Tables::Known(const toml::table& table, const std::vector<std::string>& keys, std::string_view what) {
  for (const auto& [key, node] : table) {
    if (std::any_of(keys.begin(), keys.end(), [&](const std::string& k) { return key.str() == k; })) continue;
    auto& report = diagnostics_.Report(Kind::kFleetValue, At(key.source()),
                                       fmt::format("{} has no `{}`", what, key.str()));
    const std::string near = lang::Suggest(key.str(), keys);
    report.Help(near.empty() ? fmt::format("it may have {}", fmt::join(keys, ", "))
                             : fmt::format("did you mean `{}`?", near));
  }
}

const toml::table* Tables::Table(const toml::table& parent, const char* name) {
  const toml::node* node = parent.get(name);
  if (node == nullptr) return nullptr;
  if (node->as_table() == nullptr) Wrong(At(*node), fmt::format("`{}` must be a table: `[{}]`", name, name));
  return node->as_table();
}

void Tables::ForEach(const toml::table& t, const char* name,
                     const std::function<void(const toml::table&)>& visit) {
  const toml::node* node = t.get(name);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  if (array == nullptr) return Wrong(At(*node), fmt::format("write `[[{}]]` for each", name));
  for (const toml::node& item : *array) {
    if (item.as_table() == nullptr)
      Wrong(At(item), fmt::format("write `[[{}]]` for each", name));
    else
      visit(*item.as_table());
  }
}

double Tables::Number(const toml::table& table, const char* name, double usual, double low, double high) {
  const toml::node* node = table.get(name);
  if (node == nullptr) return usual;
  const auto value = node->value<double>();
  if (Lost(*node)) {
    Wrong(At(*node), kLost);
  } else if (!value || node->is_boolean() || !std::isfinite(*value)) {
    Wrong(At(*node), fmt::format("`{}` must be a number", name));
  } else if (*value < low || *value > high) {
    Wrong(At(*node), fmt::format("`{}` must lie between {} and {}", name, low, high));
  } else {
    return *value;
  }
  return usual;
}

size_t Tables::Whole(const toml::table& table, const char* name, size_t usual, double low, double high) {
  const double value = Number(table, name, static_cast<double>(usual), low, high);
  if (value != std::floor(value))
    Wrong(At(*table.get(name)), fmt::format("`{}` must be a whole number", name));
  return static_cast<size_t>(value);
}

std::string Tables::Word(const toml::table& table, const char* name, const std::string& usual,
                         const std::vector<std::string>& choices) {
  const toml::node* node = table.get(name);
  if (node == nullptr) return usual;
  const auto value = node->value<std::string>();
  if (value && std::ranges::find(choices, *value) != choices.end()) return *value;
  const std::string near = value ? lang::Suggest(*value, choices) : std::string();
  diagnostics_.Report(Kind::kFleetValue, At(*node), fmt::format("`{}` cannot be this", name))
      .Help(near.empty() ? fmt::format("it can be {}", fmt::join(choices, ", "))
                         : fmt::format("did you mean `{}`?", near));
  return usual;
}

bool Tables::Flag(const toml::table& table, const char* name, bool usual) {
  const toml::node* node = table.get(name);
  if (node == nullptr) return usual;
  if (!node->is_boolean()) Wrong(At(*node), fmt::format("`{}` must be `true` or `false`", name));
  return node->value<bool>().value_or(usual);
}

Point Tables::ReadPoint(const toml::table& table, const char* name, const Point& usual, bool needed,
                        Span where) {
  const toml::node* node = table.get(name);
  if (node == nullptr) {
    if (needed) Wrong(where, fmt::format("`{}` is missing", name));
    return usual;
  }
  const toml::array* array = node->as_array();
  Point point{};
  if (array == nullptr || array->size() != 3) {
    Wrong(At(*node), fmt::format("`{}` must be three numbers: `[x, y, z]`", name));
    return usual;
  }
  for (size_t i = 0; i < 3; ++i) {
    const auto value = (*array)[i].value<double>();
    if (Lost((*array)[i])) {
      Wrong(At((*array)[i]), kLost);
      return usual;
    }
    if (!value || !std::isfinite(*value) || std::fabs(*value) > 1e6) {
      Wrong(At((*array)[i]), fmt::format("`{}` needs numbers below a million", name));
      return usual;
    }
    point[i] = *value;
  }
  return point;
}

json Tables::ToJson(const toml::node& node) {
  if (const auto* table = node.as_table()) {
    json object = json::object();
    for (const auto& [key, value] : *table) object[std::string(key.str())] = ToJson(value);
    return object;
  }
  if (const auto* array = node.as_array()) {
    json list = json::array();
    for (const toml::node& value : *array) list.push_back(ToJson(value));
    return list;
  }
  if (node.is_boolean()) return node.value<bool>().value();
  if (node.is_integer()) return node.value<int64_t>().value();
  if (Lost(node)) Wrong(At(node), kLost);
  if (node.is_floating_point()) return node.value<double>().value();
  if (node.is_string()) return node.value<std::string>().value();
  return nullptr;
}

}  // namespace rondo::sim
