#include "workspace/session.h"

#include <fmt/format.h>

namespace rondo::workspace {

std::optional<diag::FileId> ReadSource(const std::string& path, Session& session) {
  auto text = session.read(path);
  if (text.ok()) return session.sources.Add(path, std::move(text).value());
  session.diagnostics.Report(diag::Kind::kFileUnreadable, {},
                             fmt::format("cannot read `{}`: {}", path, text.error().message));
  return std::nullopt;
}

}  // namespace rondo::workspace
