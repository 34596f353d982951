#include "ros/names.h"

#include <cctype>

namespace rondo::ros {

bool IsName(std::string_view name) {
  if (name.starts_with('/')) name.remove_prefix(1);
  if (name.empty()) return false;
  char last = '/';
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) == 0 && c != '_' && c != '/') return false;
    if (last == '/' && (c == '/' || std::isdigit(u) != 0)) return false;
    if (last == '_' && c == '_') return false;
    last = c;
  }
  return last != '/';
}

std::string FullName(std::string_view node_namespace, std::string_view name) {
  if (name.starts_with('/')) return std::string(name);
  std::string full;
  if (!node_namespace.empty() && node_namespace != "/") {
    if (!node_namespace.starts_with('/')) full += '/';
    full += node_namespace;
  }
  return full + "/" + std::string(name);
}

std::string Plain(std::string_view text) {
  std::string name;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      name += c;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  while (name.ends_with('_')) name.pop_back();
  return name.empty() || std::isdigit(static_cast<unsigned char>(name[0])) != 0 ? "p" + name : name;
}

std::string WireTopic(std::string_view full_name) { return "rt" + std::string(full_name); }

std::string WireType(std::string_view type) {
  const size_t first = type.find('/');
  const size_t second = type.find('/', first + 1);
  return std::string(type.substr(0, first)) + "::" + std::string(type.substr(first + 1, second - first - 1)) +
         "::dds_::" + std::string(type.substr(second + 1)) + "_";
}

std::string TopicOfWire(std::string_view wire) {
  return wire.starts_with("rt/") ? std::string(wire.substr(2)) : std::string();
}

std::string TypeOfWire(std::string_view wire) {
  const size_t middle = wire.find("::dds_::");
  if (middle == std::string_view::npos || !wire.ends_with('_')) return {};
  std::string type(wire.substr(0, middle));
  const size_t colons = type.find("::");
  if (colons == std::string::npos) return {};
  type.replace(colons, 2, "/");
  return type + "/" + std::string(wire.substr(middle + 8, wire.size() - middle - 9));
}

}  // namespace rondo::ros
