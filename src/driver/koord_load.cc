#include "driver/koord_load.h"

namespace rondo::driver {

std::unique_ptr<LoadedKoord> LoadKoord(const LoadOptions& options, Session& session) {
  auto program = Load(options, session);
  if (!program) return nullptr;
  auto loaded = std::make_unique<LoadedKoord>();
  loaded->program = std::move(*program);
  if (session.diagnostics.has_errors()) return nullptr;
  loaded->model = koord::Check(loaded->program, session.diagnostics);
  return session.diagnostics.has_errors() ? nullptr : std::move(loaded);
}

}  // namespace rondo::driver
