#include "workspace/koord_files.h"

#include <filesystem>

#include "koord/syntax/parser.h"

namespace rondo::workspace {
namespace {

bool ParseFile(const std::string& path, Session& session, koord::Program& program) {
  const auto file = ReadSource(path, Wanted::kKoord, session);
  if (file) koord::Parse(session.sources, *file, program, session.diagnostics);
  return file.has_value();
}

std::unique_ptr<LoadedKoord> Checked(koord::Program program, Session& session) {
  if (session.diagnostics.has_errors()) return nullptr;
  auto loaded = std::make_unique<LoadedKoord>();
  loaded->program = std::move(program);
  loaded->model = koord::Check(loaded->program, session.diagnostics);
  return session.diagnostics.has_errors() ? nullptr : std::move(loaded);
}

}  // namespace

std::optional<koord::Program> ReadKoord(const LoadOptions& options, Session& session) {
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

std::unique_ptr<LoadedKoord> LoadKoord(const LoadOptions& options, Session& session) {
  auto program = ReadKoord(options, session);
  return program ? Checked(std::move(*program), session) : nullptr;
}

std::unique_ptr<LoadedKoord> LoadKoordTexts(const std::string& name, const std::string& program,
                                            const std::string& spec, Session& session) {
  koord::Program parsed;
  koord::Parse(session.sources, session.sources.Add(name, program), parsed, session.diagnostics);
  if (!spec.empty())
    koord::Parse(session.sources, session.sources.Add("specification", spec), parsed, session.diagnostics);
  return Checked(std::move(parsed), session);
}

}  // namespace rondo::workspace
