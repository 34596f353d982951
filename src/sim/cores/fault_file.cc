#include "sim/cores/fault_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace rondo::sim::cores {
namespace {

std::vector<std::string> Kinds() {
  std::vector<std::string> names;
  for (size_t k = 0; k < kFaultKinds; ++k) names.emplace_back(Name(static_cast<FaultKind>(k)));
  return names;
}

uint32_t Robot(Tables& tables, const toml::table& t, const char* key, size_t robots,
               std::span<const std::string> names) {
  const toml::node* node = t.get(key);
  if (node == nullptr || !node->is_string() || names.empty())
    return static_cast<uint32_t>(tables.Whole(t, key, 0, 0, static_cast<double>(robots) - 1));
  const std::vector<std::string> all(names.begin(), names.end());
  const std::string name = tables.Word(t, key, all[0], all);
  return static_cast<uint32_t>(std::ranges::find(all, name) - all.begin());
}

}  // namespace

Fault ReadFault(Tables& tables, const toml::table& t, size_t robots, std::span<const std::string> names) {
  tables.Known(t, {"kind", "at", "length", "robot", "other", "amount"}, "a fault");
  Fault f;
  const std::vector<std::string> kinds = Kinds();
  if (t.get("kind") == nullptr) tables.Wrong(tables.At(t), "the fault has no `kind`");
  const std::string kind = tables.Word(t, "kind", kinds[0], kinds);
  f.kind = static_cast<FaultKind>(std::ranges::find(kinds, kind) - kinds.begin());
  f.at = Nanoseconds(tables.Number(t, "at", 0, 0, 1e6));
  f.length = Nanoseconds(tables.Number(t, "length", 0.1, 0, 1e6));
  f.robot = Robot(tables, t, "robot", robots, names);
  f.other = Robot(tables, t, "other", robots, names);
  const bool seconds =
      f.kind == FaultKind::kDelay || f.kind == FaultKind::kSlow || f.kind == FaultKind::kPlanner;
  const double most = f.kind == FaultKind::kClock ? 1e9 : seconds ? 1000 : 1;
  f.amount = tables.Number(t, "amount", 0, f.kind == FaultKind::kClock ? -most : 0, most);
  return f;
}

std::string WriteFault(const Fault& f) {
  return fmt::format(
      "kind = \"{}\"\nat = {:.9f}\nlength = {:.9f}\nrobot = {}\nother = {}\namount = {:.17g}\n", Name(f.kind),
      Seconds(f.at), Seconds(f.length), f.robot, f.other, f.amount);
}

}  // namespace rondo::sim::cores
