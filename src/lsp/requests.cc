#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>

#include "lsp/names.h"
#include "lsp/outline.h"
#include "lsp/protocol.h"
#include "lsp/server.h"
#include "lsp/uris.h"
#include "workspace/checks.h"

// What editors ask for.

namespace rondo::lsp {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

// The numbers of the protocol (CompletionItemKind).
int CompletionKindOf(SymbolKind kind) {
  switch (kind) {
    case SymbolKind::kModule:
      return 9;
    case SymbolKind::kClass:
      return 7;
    case SymbolKind::kMethod:
      return 2;
    case SymbolKind::kProperty:
      return 10;
    case SymbolKind::kEnum:
      return 13;
    case SymbolKind::kFunction:
      return 3;
    case SymbolKind::kVariable:
      return 6;
    case SymbolKind::kConstant:
      return 21;
    case SymbolKind::kEvent:
      return 23;
  }
  return 1;
}

}  // namespace

json Server::Format(const json& parameters) {
  const Document* document = Find(parameters);
  if (document == nullptr || !IsSource(document->path)) return nullptr;
  const std::string extension = fs::path(document->path).extension().string();
  if (extension == ".chor" || extension == ".rosl") return nullptr;
  workspace::Session session;
  Prepare(session);
  const auto formatted = workspace::FormattedFile(document->path, session);
  if (!formatted) return nullptr;
  if (*formatted == document->text) return json::array();
  return {{{"range",
            {{"start", lsp::ToJson(Position())},
             {"end", lsp::ToJson(PositionOf(document->text, document->text.size(), encoding_))}}},
           {"newText", *formatted}}};
}

json Server::Symbols(const json& parameters) {
  const Document* document = Find(parameters);
  if (document == nullptr || !IsSource(document->path)) return json::array();
  workspace::Session session;
  Prepare(session);
  json symbols = json::array();
  for (const Symbol& s : OutlineOf(document->path, session)) {
    const json range = RangeOf(session, s.span);
    symbols.push_back(
        {{"name", s.name}, {"kind", static_cast<int>(s.kind)}, {"range", range}, {"selectionRange", range}});
  }
  return symbols;
}

json Server::Actions(const json& parameters) {
  json actions = json::array();
  const std::string uri = UriOf(Plain(PathOf(parameters.at("textDocument").at("uri").get<std::string>())));
  for (const auto& [root, checked] : checked_) {
    const auto it = checked.fixes.find(uri);
    if (it == checked.fixes.end()) continue;
    for (const json& action : it->second) {
      if (Meet(action["diagnostics"][0]["range"], parameters.at("range"))) actions.push_back(action);
    }
  }
  return actions;
}

json Server::Hover(const json& parameters) {
  const Document* document = Find(parameters);
  if (document == nullptr) return nullptr;
  const json here{{"start", parameters.at("position")}, {"end", parameters.at("position")}};
  const std::string uri = UriOf(document->path);
  std::string text;
  const auto add = [&](const std::string& more) { text += (text.empty() ? "" : "\n\n---\n\n") + more; };
  for (const auto& [root, checked] : checked_) {
    for (const json& item : checked.items) {
      if (item["uri"] == uri && Meet(item["range"], here))
        add(fmt::format("`{}`: **{}** ({:.2f} s)", item["id"].get<std::string>(),
                        item["state"].get<std::string>(), item["seconds"].get<double>()));
    }
    for (const auto* lists : {&checked.diagnostics, &checked.proofs}) {
      const auto it = lists->find(uri);
      if (it == lists->end()) continue;
      for (const json& d : it->second) {
        if (!Meet(d["range"], here)) continue;
        const auto kind = d["code"].get<std::string>();
        for (const diag::KindInfo& info : diag::AllKinds()) {
          if (info.id == kind) add(fmt::format("**{}**: {}\n\n{}", kind, info.summary, info.explanation));
        }
      }
    }
  }
  if (text.empty()) return nullptr;
  return {{"contents", {{"kind", "markdown"}, {"value", text}}}};
}

// What a name means that a file declares, or one that belongs to it. Names within bodies are not looked for.
json Server::Definition(const json& parameters) {
  const Document* document = Find(parameters);
  if (document == nullptr || !IsSource(document->path)) return json::array();
  const std::string word = WordAt(*document, parameters);
  json found = json::array();
  if (word.empty()) return found;
  // Everything that belongs together is read by a check.
  for (const std::string& path : FilesOf(RootOf(document->path))) {
    workspace::Session session;
    Prepare(session);
    for (const Symbol& s : OutlineOf(path, session)) {
      if (s.name == word) found.push_back({{"uri", UriOf(path)}, {"range", RangeOf(session, s.span)}});
    }
  }
  return found;
}

// What is declared in the files that belong together, and the other words of this one, but the one that is being written.
json Server::Complete(const json& parameters) {
  constexpr size_t kMost = 2000;
  const Document* document = Find(parameters);
  if (document == nullptr || !IsSource(document->path)) return json::array();
  const std::string& text = document->text;
  const size_t here =
      WordAround(text, OffsetOf(text, PositionIn(parameters.at("position")), encoding_)).first;
  std::map<std::string, int> words;  // with their kinds (CompletionItemKind)
  constexpr int kText = 1;
  for (size_t at = 0; at < text.size() && words.size() < kMost;) {
    const auto [begin, end] = WordAround(text, at);
    const bool name = end > begin + 1 && std::isdigit(static_cast<unsigned char>(text[begin])) == 0;
    if (name && begin != here) words.emplace(text.substr(begin, end - begin), kText);
    at = std::max(end, at) + 1;
  }
  for (const std::string& path : FilesOf(RootOf(document->path))) {
    workspace::Session session;
    Prepare(session);
    for (const Symbol& s : OutlineOf(path, session)) words[s.name] = CompletionKindOf(s.kind);
  }
  json items = json::array();
  for (const auto& [word, kind] : words) items.push_back({{"label", word}, {"kind", kind}});
  return items;
}

}  // namespace rondo::lsp
