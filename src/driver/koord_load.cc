#include "driver/koord_load.h"

#include "koord/syntax/parser.h"

namespace rondo::driver {
namespace {

std::unique_ptr<LoadedKoord> Checked(koord::Program program, Session& session) {
  if (session.diagnostics.has_errors()) return nullptr;
  auto loaded = std::make_unique<LoadedKoord>();
  loaded->program = std::move(program);
  loaded->model = koord::Check(loaded->program, session.diagnostics);
  return session.diagnostics.has_errors() ? nullptr : std::move(loaded);
}

}  // namespace

std::unique_ptr<LoadedKoord> LoadKoord(const LoadOptions& options, Session& session) {
  auto program = Load(options, session);
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

}  // namespace rondo::driver
