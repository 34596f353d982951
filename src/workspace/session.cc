#include "workspace/session.h"

#include <fmt/format.h>

#include "workspace/file_kind.h"

namespace rondo::workspace {

std::optional<diag::FileId> ReadSource(const std::string& path, Wanted wanted, Session& session) {
  auto read = session.read(path);
  if (!read.ok()) {
    session.diagnostics.Report(diag::Kind::kFileUnreadable, {},
                               fmt::format("cannot read `{}`: {}", path, read.error().message));
    return std::nullopt;
  }
  std::string text = std::move(read).value();
  if (const OtherKind other = WhatElse(path, text, wanted); !other.is.empty()) {
    auto& report =
        session.diagnostics.Report(diag::Kind::kFileKind, {}, fmt::format("`{}` is {}", path, other.is));
    if (!other.help.empty()) report.Help(other.help);
    return std::nullopt;
  }
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return session.sources.Add(path, std::move(text));
}

}  // namespace rondo::workspace
