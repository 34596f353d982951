#include "driver/load.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/file.h"
#include "driver/terminal.h"
#include "koord/syntax/parser.h"

namespace rondo::driver {
std::optional<diag::FileId> ReadSource(const std::string& path, Session& session) {
  auto text = base::ReadFile(path);
  if (text.ok()) return session.sources.Add(path, std::move(text).value());
  PrintFailure(fmt::format("cannot read `{}`: {}", path, text.error().message));
  return std::nullopt;
}

namespace {

bool ParseFile(const std::string& path, Session& session, koord::Program& program) {
  const auto file = ReadSource(path, session);
  if (file) koord::Parse(session.sources, *file, program, session.diagnostics);
  return file.has_value();
}

}  // namespace

std::optional<koord::Program> Load(const LoadOptions& options, Session& session) {
  koord::Program program;
  if (!ParseFile(options.file, session, program)) return std::nullopt;
  if (!options.with_spec) return program;
  std::string spec = options.spec;
  if (spec.empty()) {
    const std::filesystem::path beside = std::filesystem::path(options.file).replace_extension(".spec");
    std::error_code ignored;
    if (std::filesystem::exists(beside, ignored) && beside != options.file) spec = beside.string();
  }
  if (!spec.empty() && !ParseFile(spec, session, program)) return std::nullopt;
  return program;
}

}  // namespace rondo::driver
