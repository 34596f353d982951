#include "lsp/protocol.h"

#include <filesystem>

#include "workspace/module_files.h"

namespace rondo::lsp {

namespace fs = std::filesystem;
using nlohmann::json;

std::string Plain(const std::string& path) { return fs::path(path).lexically_normal().string(); }

bool IsSource(const std::string& path) {
  const std::string extension = fs::path(path).extension().string();
  return extension == ".koord" || extension == ".spec" || workspace::IsModuleFile(path);
}

json ToJson(Position position) { return {{"line", position.line}, {"character", position.character}}; }

Position PositionIn(const json& j) { return {j.at("line").get<size_t>(), j.at("character").get<size_t>()}; }

std::pair<Position, Position> RangeIn(const json& j) {
  return {PositionIn(j.at("start")), PositionIn(j.at("end"))};
}

namespace {

bool Before(Position a, Position b) {
  return std::pair(a.line, a.character) < std::pair(b.line, b.character);
}

}  // namespace

bool Meet(const json& a, const json& b) {
  const auto [a0, a1] = RangeIn(a);
  const auto [b0, b1] = RangeIn(b);
  return !Before(a1, b0) && !Before(b1, a0);
}

}  // namespace rondo::lsp
