#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "lsp/names.h"
#include "lsp/protocol.h"
#include "lsp/server.h"
#include "lsp/uris.h"
#include "workspace/checks.h"

// One name in all files that belong together.

namespace rondo::lsp {

using nlohmann::json;

std::string Server::WordAt(const Document& document, const json& parameters) const {
  const size_t at = OffsetOf(document.text, PositionIn(parameters.at("position")), encoding_);
  const auto [begin, end] = WordAround(document.text, at);
  return document.text.substr(begin, end - begin);
}

const std::set<std::string>& Server::FilesOf(const std::string& root) {
  // Of a specification that is open, the program may have been closed, or written, since.
  if (!checked_.contains(root)) Check(root);
  return checked_.at(root).files;
}

std::set<std::string> Server::RootsWith(const std::string& path) const {
  std::set<std::string> roots{RootOf(path)};
  for (const auto& [root, checked] : checked_) {
    if (checked.files.contains(path)) roots.insert(root);
  }
  return roots;
}

std::map<std::string, std::vector<std::pair<size_t, size_t>>> Server::PlacesOf(const std::string& of,
                                                                               const std::string& word) {
  std::map<std::string, std::vector<std::pair<size_t, size_t>>> places;
  std::set<std::string> files;
  for (const std::string& root : RootsWith(of)) files.insert(FilesOf(root).begin(), FilesOf(root).end());
  for (const std::string& path : files) {
    diag::SourceSet sources;
    const diag::FileId file = sources.Add(path, TextOf(path));
    for (const diag::Span& span : Occurrences(sources, file, word))
      places[path].emplace_back(span.begin, span.end);
  }
  return places;
}

json Server::RangeOf(const std::string& text, std::pair<size_t, size_t> bytes) const {
  return {{"start", lsp::ToJson(PositionOf(text, bytes.first, encoding_))},
          {"end", lsp::ToJson(PositionOf(text, bytes.second, encoding_))}};
}

json Server::References(const json& parameters) {
  const Document* document = Find(parameters);
  json found = json::array();
  if (document == nullptr || !IsSource(document->path)) return found;
  const bool declarations = parameters.value("/context/includeDeclaration"_json_pointer, true);
  const json defined = declarations ? json::array() : Definition(parameters);
  for (const auto& [path, places] : PlacesOf(document->path, WordAt(*document, parameters))) {
    const std::string text = TextOf(path), uri = UriOf(path);
    std::vector<json> declared;  // of a declaration, the first place is its own name
    for (const auto& place : places) {
      const json range = RangeOf(text, place);
      const auto declares = std::ranges::find_if(defined, [&](const json& d) {
        return d["uri"] == uri && Meet(d["range"], range) && std::ranges::find(declared, d) == declared.end();
      });
      if (declares != defined.end())
        declared.push_back(*declares);
      else
        found.push_back({{"uri", uri}, {"range", range}});
    }
  }
  return found;
}

json Server::Highlights(const json& parameters) {
  const Document* document = Find(parameters);
  json found = json::array();
  if (document == nullptr || !IsSource(document->path)) return found;
  diag::SourceSet sources;
  const diag::FileId file = sources.Add(document->path, document->text);
  for (const diag::Span& span : Occurrences(sources, file, WordAt(*document, parameters)))
    found.push_back({{"range", RangeOf(document->text, {span.begin, span.end})}});
  return found;
}

json Server::NameAt(const json& parameters) {
  const Document* document = Find(parameters);
  if (document == nullptr || !IsSource(document->path)) return nullptr;
  const size_t at = OffsetOf(document->text, PositionIn(parameters.at("position")), encoding_);
  const auto word = WordAround(document->text, at);
  const std::string_view text = std::string_view(document->text).substr(word.first, word.second - word.first);
  if (!IsName(text)) return nullptr;
  return RangeOf(document->text, word);
}

// Every place of the word, in all files that belong together, gets the other name, which stands nowhere in them: so no two
// names become one. Only what these files declare is renamed: not words of the language, built-in functions, units, nor the
// ports that a program shares with a model.
base::Result<json> Server::Rename(const json& parameters) {
  const Document* document = Find(parameters);
  if (document == nullptr || !IsSource(document->path)) return base::Error{"this file is not open"};
  const std::string word = WordAt(*document, parameters);
  const std::set<std::string> roots = RootsWith(document->path);
  const auto name = parameters.at("newName").get<std::string>();
  if (!IsName(word)) return base::Error{"no name stands here"};
  if (!IsName(name)) return base::Error{fmt::format("`{}` is no name", name)};
  const auto places = PlacesOf(document->path, word);
  if (Definition(parameters).empty() || places.empty())
    return base::Error{fmt::format("`{}` is nothing that is declared by itself in these files", word)};
  if (!PlacesOf(document->path, name).empty())
    return base::Error{fmt::format("`{}` is the name of something else", name)};
  json changes = json::object();
  std::map<std::string, std::string> texts;
  for (const auto& [path, spans] : places) {
    const bool own = RootOf(path) == RootOf(document->path) || At(path) != nullptr;
    if (!own)
      return base::Error{fmt::format(
          "`{}` stands in `{}`, too, which may belong to others: open that file first", word, path)};
    const std::string text = TextOf(path);
    json edits = json::array();
    std::string& renamed = texts[path] = text;
    for (auto span = spans.rbegin(); span != spans.rend(); ++span) {
      edits.push_back({{"range", RangeOf(text, *span)}, {"newText", name}});
      renamed.replace(span->first, span->second - span->first, name);
    }
    changes[UriOf(path)] = edits;
  }
  const auto said = [&](bool after) {
    workspace::Session session;
    Prepare(session);
    const auto before = session.read;
    session.read = [&, before](const std::string& path) -> base::Result<std::string> {
      const auto text = texts.find(Plain(path));
      return after && text != texts.end() ? base::Result<std::string>(text->second) : before(path);
    };
    for (const std::string& root : roots) workspace::CheckFile(root, session);
    return session.diagnostics.all().size();
  };
  // Warnings count, too: that a name means nothing any more may be one.
  if (said(true) > said(false))
    return base::Error{fmt::format("with `{}` in place of `{}`, this is no program any more", name, word)};
  return json{{"changes", changes}};
}

}  // namespace rondo::lsp
