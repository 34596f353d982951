#include "workspace/checks.h"

#include <algorithm>
#include <filesystem>

#include "base/check.h"
#include "choreo/syntax/format.h"
#include "choreo/syntax/parser.h"
#include "koord/check/check.h"
#include "koord/syntax/format.h"
#include "koord/syntax/parser.h"
#include "workspace/koord_files.h"
#include "workspace/module_files.h"

namespace rondo::workspace {

namespace {

// The canonical text of a file; nothing if it cannot be read or has errors, which are in the session then.
// Never one that does not mean the same.
std::optional<std::string> FormatKoord(const std::string& file, Session& session) {
  const auto program = ReadKoord({file, {}, false}, session);
  if (!program || session.diagnostics.has_errors()) return std::nullopt;
  const std::string text = koord::Format(session.sources, *program);
  Session again;
  koord::Program reread;
  koord::Parse(again.sources, again.sources.Add(file, text), reread, again.diagnostics);
  CHECK(!again.diagnostics.has_errors() && koord::Skeleton(reread) == koord::Skeleton(*program))
      << "formatting would change " << file;
  CHECK(reread.comments.size() == program->comments.size()) << "formatting would lose a comment of " << file;
  return text;
}

std::optional<std::string> FormatMotion(const std::string& file, Session& session) {
  const auto source = ReadSource(file, Wanted::kMotion, session);
  if (!source) return std::nullopt;
  choreo::Module module;
  choreo::Parse(session.sources, *source, module, session.diagnostics);
  if (session.diagnostics.has_errors()) return std::nullopt;
  const lang::TokenStream tokens = choreo::Tokens(session.sources, *source, session.diagnostics);
  const std::string text = choreo::Format(session.sources, *source, tokens);
  Session again;
  const diag::FileId other = again.sources.Add(file, text);
  const lang::TokenStream reread = choreo::Tokens(again.sources, other, again.diagnostics);
  const auto same = [](const auto& a, const auto& b) { return a.text == b.text; };
  CHECK(std::ranges::equal(tokens.tokens, reread.tokens, same) &&
        std::ranges::equal(tokens.comments, reread.comments, same))
      << "formatting would change " << file;
  return text;
}

}  // namespace

void CheckFile(const std::string& file, Session& session) {
  if (IsModuleFile(file)) {
    CheckModule({file}, {}, session);
    return;
  }
  const auto program = ReadKoord({file, {}, true}, session);
  if (program && !session.diagnostics.has_errors()) koord::Check(*program, session.diagnostics);
}

std::optional<std::string> FormattedFile(const std::string& file, Session& session) {
  return std::filesystem::path(file).extension() == ".rondo" ? FormatMotion(file, session)
                                                             : FormatKoord(file, session);
}

}  // namespace rondo::workspace
