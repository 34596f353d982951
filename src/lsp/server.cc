#include "lsp/server.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/version.h"
#include "diag/render.h"
#include "lsp/protocol.h"
#include "lsp/uris.h"
#include "workspace/checks.h"

namespace rondo::lsp {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr int kParseError = -32700, kInvalidRequest = -32600, kMethodNotFound = -32601,
              kInvalidParameters = -32602, kNotInitialized = -32002, kRequestFailed = -32803;

int SeverityOf(std::string_view severity) { return severity == "error" ? 1 : severity == "warning" ? 2 : 3; }

// What stands below a message, on lines of its own.
std::string WithMore(std::string message, const std::vector<std::string>& notes,
                     const std::vector<std::string>& helps) {
  for (const std::string& note : notes) message += "\nnote: " + note;
  for (const std::string& help : helps) message += "\nhelp: " + help;
  return message;
}

}  // namespace

// -- messages

std::vector<std::string> Server::TakeMessages() { return std::exchange(out_, {}); }

void Server::Answer(const json& id, json result) {
  out_.push_back(json{{"jsonrpc", "2.0"}, {"id", id}, {"result", std::move(result)}}.dump(
      -1, ' ', false, json::error_handler_t::replace));
}

void Server::Refuse(const json& id, int code, const std::string& why) {
  out_.push_back(json{{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", why}}}}.dump(
      -1, ' ', false, json::error_handler_t::replace));
}

void Server::Notify(const std::string& method, json parameters) {
  out_.push_back(json{{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(parameters)}}.dump(
      -1, ' ', false, json::error_handler_t::replace));
}

void Server::Hear(const std::string& text) {
  const json message = json::parse(text, nullptr, false);
  if (message.is_discarded()) {
    Refuse(nullptr, kParseError, "this is no JSON");
    return;
  }
  const json id = message.is_object() && message.contains("id") ? message["id"] : json(nullptr);
  if (!message.is_object() || !message.contains("method") || !message["method"].is_string()) {
    // An answer: nothing was asked.
    if (!message.is_object() || (!message.contains("result") && !message.contains("error")))
      Refuse(id, kInvalidRequest, "this is no request");
    return;
  }
  const auto method = message["method"].get<std::string>();
  const json parameters = message.contains("params") ? message["params"] : json::object();
  try {
    if (message.contains("id"))
      Request(id, method, parameters);
    else
      Notification(method, parameters);
  } catch (const json::exception& e) {
    if (message.contains("id")) Refuse(id, kInvalidParameters, e.what());
  }
}

void Server::Request(const json& id, const std::string& method, const json& parameters) {
  if (method == "initialize") return Answer(id, Initialize(parameters));
  if (!initialized_) return Refuse(id, kNotInitialized, "`initialize` comes first");
  if (shut_) return Refuse(id, kInvalidRequest, "the server was shut down");
  // What was changed before has to be known.
  Settle();
  if (method == "shutdown") {
    shut_ = true;
    verifier_.Cancel();
    return Answer(id, nullptr);
  }
  if (method == "textDocument/formatting") return Answer(id, Format(parameters));
  if (method == "textDocument/documentSymbol") return Answer(id, Symbols(parameters));
  if (method == "textDocument/codeAction") return Answer(id, Actions(parameters));
  if (method == "textDocument/hover") return Answer(id, Hover(parameters));
  if (method == "textDocument/definition") return Answer(id, Definition(parameters));
  if (method == "textDocument/completion") return Answer(id, Complete(parameters));
  if (method == "textDocument/references") return Answer(id, References(parameters));
  if (method == "textDocument/documentHighlight") return Answer(id, Highlights(parameters));
  if (method == "textDocument/prepareRename") return Answer(id, NameAt(parameters));
  if (method == "textDocument/rename") {
    auto renamed = Rename(parameters);
    return renamed.ok() ? Answer(id, renamed.value()) : Refuse(id, kRequestFailed, renamed.error().message);
  }
  Refuse(id, kMethodNotFound, fmt::format("`{}` is not known", method));
}

void Server::Notification(const std::string& method, const json& parameters) {
  if (method == "exit") {
    verifier_.Cancel();
    exits_ = shut_ ? 0 : 1;
    return;
  }
  if (!initialized_) return;
  if (method == "textDocument/didOpen") Open(parameters);
  if (method == "textDocument/didChange") Change(parameters);
  if (method == "textDocument/didSave") Save(parameters);
  if (method == "textDocument/didClose") Close(parameters);
}

json Server::Initialize(const json& parameters) {
  initialized_ = true;
  const json offered =
      parameters.value("/capabilities/general/positionEncodings"_json_pointer, json::array());
  if (offered.is_array() && std::ranges::find(offered, json("utf-8")) != offered.end())
    encoding_ = Encoding::kUtf8;
  return {{"capabilities",
           {{"positionEncoding", encoding_ == Encoding::kUtf8 ? "utf-8" : "utf-16"},
            {"textDocumentSync", {{"openClose", true}, {"change", 2}, {"save", true}}},
            {"documentFormattingProvider", true},
            {"documentSymbolProvider", true},
            {"codeActionProvider", {{"codeActionKinds", {"quickfix"}}}},
            {"definitionProvider", true},
            {"referencesProvider", true},
            {"documentHighlightProvider", true},
            {"renameProvider", {{"prepareProvider", true}}},
            {"completionProvider", json::object()},
            {"hoverProvider", true}}},
          {"serverInfo", {{"name", "rondo"}, {"version", std::string(base::Version())}}}};
}

// -- documents

const Server::Document* Server::At(const std::string& path) const {
  const auto it = documents_.find(Plain(path));
  return it == documents_.end() ? nullptr : &it->second;
}

const Server::Document* Server::Find(const json& parameters) const {
  return At(PathOf(parameters.at("textDocument").at("uri").get<std::string>()));
}

std::string Server::RootOf(const std::string& path) const {
  if (fs::path(path).extension() != ".spec") return path;
  const std::string program = fs::path(path).replace_extension(".koord").string();
  std::error_code ignored;
  return At(program) != nullptr || fs::exists(program, ignored) ? program : path;
}

void Server::Open(const json& parameters) {
  const json& opened = parameters.at("textDocument");
  Document document{opened.at("uri").get<std::string>(), "", opened.at("text").get<std::string>(),
                    opened.value("version", int64_t{0})};
  document.path = Plain(PathOf(document.uri));
  const std::string path = document.path;
  documents_.insert_or_assign(path, std::move(document));
  Touch(path);
}

void Server::Change(const json& parameters) {
  const Document* found = Find(parameters);
  if (found == nullptr) return;
  Document& document = documents_.at(found->path);
  for (const json& change : parameters.at("contentChanges")) {
    const auto text = change.at("text").get<std::string>();
    if (!change.contains("range")) {
      document.text = text;
      continue;
    }
    const auto [from, to] = RangeIn(change["range"]);
    const size_t begin = OffsetOf(document.text, from, encoding_);
    const size_t end = std::max(begin, OffsetOf(document.text, to, encoding_));
    document.text.replace(begin, end - begin, text);
  }
  document.version = parameters.at("textDocument").value("version", document.version + 1);
  Touch(document.path);
}

void Server::Touch(const std::string& path) {
  Forget(RootOf(path));
  for (const auto& [root, checked] : checked_) {
    if (root != RootOf(path) && checked.files.contains(path)) Forget(root);
  }
}

bool Server::Saved(const std::string& root) const {
  return std::ranges::all_of(checked_.at(root).files, [&](const std::string& path) {
    const Document* document = At(path);
    if (document == nullptr) return true;
    const auto disk = workspace::Session().read(path);
    return disk.ok() && disk.value() == document->text;
  });
}

// What was said of the text before is not said of this one.
void Server::Forget(const std::string& root) {
  if (!IsSource(root)) return;
  Checked& checked = checked_[root];
  if (verifier_.descriptor() >= 0 && verifier_.file() == root) verifier_.Cancel();
  if (!checked.items.empty()) {
    const Document* document = At(root);
    Notify("rondo/verification", {{"uri", UriOf(root)},
                                  {"version", document == nullptr ? 0 : document->version},
                                  {"items", json::array()}});
  }
  checked.items.clear();
  checked.proofs.clear();
  if (std::ranges::find(dirty_, root) == dirty_.end()) dirty_.push_back(root);
}

void Server::Save(const json& parameters) {
  const Document* document = Find(parameters);
  if (document == nullptr || !IsSource(document->path)) return;
  Settle();
  const std::string root = RootOf(document->path);
  const auto errors = [](const auto& of) {
    return std::ranges::any_of(of.second, [](const json& d) { return d["severity"] == 1; });
  };
  if (std::ranges::any_of(checked_[root].diagnostics, errors) || !Saved(root)) return;
  const Document* whole = At(root);
  verifier_.Start(root, whole == nullptr ? 0 : whole->version);
}

void Server::Close(const json& parameters) {
  const Document* document = Find(parameters);
  if (document == nullptr) return;
  const std::string path = document->path, root = RootOf(path);
  documents_.erase(path);
  // The file on the disk counts again, if another one needs it.
  if (At(root) != nullptr) {
    Forget(root);
    return;
  }
  if (verifier_.file() == root) verifier_.Cancel();
  std::erase(dirty_, root);
  for (auto& [uri, list] : checked_[root].diagnostics) list.clear();
  checked_[root].proofs.clear();
  Publish(root);
  checked_.erase(root);
}

// -- checks

void Server::Prepare(workspace::Session& session) const {
  const auto disk = session.read;
  session.read = [this, disk](const std::string& path) -> base::Result<std::string> {
    const Document* document = At(path);
    return document == nullptr ? disk(path) : document->text;
  };
}

void Server::Settle() {
  for (const std::string& root : std::exchange(dirty_, {})) {
    Check(root);
    Publish(root);
  }
}

void Server::Check(const std::string& root) {
  Checked& checked = checked_[root];
  for (auto& [uri, list] : checked.diagnostics) list.clear();
  checked.fixes.clear();
  workspace::Session session;
  Prepare(session);
  workspace::CheckFile(root, session);
  checked.files.clear();
  for (size_t f = 0; f < session.sources.size(); ++f)
    checked.files.insert(Plain(std::string(session.sources.path(diag::FileId(f)))));
  for (const diag::Diagnostic& d : session.diagnostics.Sorted()) {
    const std::string uri =
        d.span.file.valid() ? UriOf(Plain(std::string(session.sources.path(d.span.file)))) : UriOf(root);
    checked.diagnostics[uri].push_back(ToJson(session, d));
    for (const diag::FixIt& fix : d.fixes) {
      const std::string where = UriOf(Plain(std::string(session.sources.path(fix.span.file))));
      const std::string title =
          fix.replacement.empty() ? "remove it" : fmt::format("write `{}`", fix.replacement);
      checked.fixes[uri].push_back(
          {{"title", title},
           {"kind", "quickfix"},
           {"diagnostics", {checked.diagnostics[uri].back()}},
           {"edit",
            {{"changes",
              {{where, {{{"range", RangeOf(session, fix.span)}, {"newText", fix.replacement}}}}}}}}});
    }
  }
}

void Server::Publish(const std::string& root) {
  Checked& checked = checked_[root];
  for (const auto& [uri, list] : checked.proofs) checked.diagnostics.try_emplace(uri);
  for (auto it = checked.diagnostics.begin(); it != checked.diagnostics.end();) {
    const auto& [uri, list] = *it;
    json all = list;
    const auto proofs = checked.proofs.find(uri);
    if (proofs != checked.proofs.end()) {
      for (const json& d : proofs->second) all.push_back(d);
    }
    json parameters{{"uri", uri}, {"diagnostics", all}};
    if (const Document* document = At(PathOf(uri))) parameters["version"] = document->version;
    const bool empty = all.empty() && uri != UriOf(root);
    Notify("textDocument/publishDiagnostics", std::move(parameters));
    it = empty ? checked.diagnostics.erase(it) : std::next(it);
  }
  if (checked.diagnostics.empty()) {
    json parameters{{"uri", UriOf(root)}, {"diagnostics", json::array()}};
    if (const Document* document = At(root)) parameters["version"] = document->version;
    Notify("textDocument/publishDiagnostics", std::move(parameters));
  }
}

json Server::RangeOf(const workspace::Session& session, diag::Span span) const {
  if (!span.file.valid()) return {{"start", lsp::ToJson(Position())}, {"end", lsp::ToJson(Position())}};
  const std::string_view text = session.sources.text(span.file);
  return {{"start", lsp::ToJson(PositionOf(text, span.begin, encoding_))},
          {"end", lsp::ToJson(PositionOf(text, span.end, encoding_))}};
}

json Server::ToJson(const workspace::Session& session, const diag::Diagnostic& d) const {
  json related = json::array();
  for (const diag::Label& label : d.labels) {
    if (!label.span.file.valid()) continue;
    related.push_back({{"location",
                        {{"uri", UriOf(Plain(std::string(session.sources.path(label.span.file))))},
                         {"range", RangeOf(session, label.span)}}},
                       {"message", label.message}});
  }
  const std::string message = d.label.empty() ? d.message : fmt::format("{}: {}", d.message, d.label);
  return {{"range", RangeOf(session, d.span)},
          {"severity", SeverityOf(diag::SeverityName(d.severity))},
          {"code", diag::Info(d.kind).id},
          {"source", "rondo"},
          {"message", WithMore(message, d.notes, d.helps)},
          {"relatedInformation", related}};
}

// -- proofs

std::string Server::TextOf(const std::string& path) const {
  workspace::Session session;
  Prepare(session);
  auto text = session.read(path);
  return text.ok() ? std::move(text).value() : "";
}

json Server::RangeOf(const json& place) const {
  const std::string text = TextOf(place.at("file").get<std::string>());
  const auto at = [&](const char* line, const char* column) {
    // Columns of the schema count code points, from 1.
    size_t offset = OffsetOf(text, {place.at(line).get<size_t>() - 1, 0}, Encoding::kUtf8);
    for (size_t c = place.at(column).get<size_t>() - 1; c > 0 && offset < text.size() && text[offset] != '\n';
         --c) {
      ++offset;
      while (offset < text.size() && (static_cast<unsigned char>(text[offset]) & 0xc0U) == 0x80U) ++offset;
    }
    return lsp::ToJson(PositionOf(text, offset, encoding_));
  };
  return {{"start", at("line", "column")}, {"end", at("end_line", "end_column")}};
}

json Server::OfProof(const json& diagnostic) const {
  json related = json::array();
  for (const json& label : diagnostic.at("labels"))
    related.push_back(
        {{"location",
          {{"uri", UriOf(Plain(label.at("file").get<std::string>()))}, {"range", RangeOf(label)}}},
         {"message", label.at("message")}});
  auto message = diagnostic.at("message").get<std::string>();
  if (diagnostic.contains("label")) message += ": " + diagnostic["label"].get<std::string>();
  return {{"range", diagnostic.contains("file")
                        ? RangeOf(diagnostic)
                        : json{{"start", lsp::ToJson(Position())}, {"end", lsp::ToJson(Position())}}},
          {"severity", SeverityOf(diagnostic.at("severity").get<std::string>())},
          {"code", diagnostic.at("kind")},
          {"source", "rondo prove"},
          {"message", WithMore(message, diagnostic.at("notes").get<std::vector<std::string>>(),
                               diagnostic.at("help").get<std::vector<std::string>>())},
          {"relatedInformation", related}};
}

void Server::Proofs() {
  const auto result = verifier_.Read();
  if (!result || !result->contains("command")) return;
  const std::string root = verifier_.file();
  Checked& checked = checked_[root];
  try {
    for (const json& d : result->at("diagnostics")) {
      // Warnings of the checker are there already.
      const std::string uri = d.contains("file") ? UriOf(Plain(d["file"].get<std::string>())) : UriOf(root);
      json made = OfProof(d);
      const auto known = checked.diagnostics.find(uri);
      const bool twice =
          known != checked.diagnostics.end() && std::ranges::any_of(known->second, [&](const json& k) {
            return k["code"] == made["code"] && k["range"] == made["range"];
          });
      if (!twice) checked.proofs[uri].push_back(std::move(made));
    }
    for (const json& invariant : result->value("invariants", json::array())) {
      if (!invariant.contains("place")) continue;
      double seconds = 0;
      for (const json& o : invariant.value("obligations", json::array()))
        seconds += o.at("seconds").get<double>();
      checked.items.push_back({{"id", invariant.at("name")},
                               {"uri", UriOf(Plain(invariant.at("place").at("file").get<std::string>()))},
                               {"range", RangeOf(invariant.at("place"))},
                               {"state", invariant.at("verdict")},
                               {"seconds", seconds}});
    }
    for (const json& choreography : result->value("choreographies", json::array())) {
      for (const json& o : choreography.at("obligations")) {
        if (!o.contains("place")) continue;
        checked.items.push_back({{"id", o.at("id")},
                                 {"uri", UriOf(Plain(o.at("place").at("file").get<std::string>()))},
                                 {"range", RangeOf(o.at("place"))},
                                 {"state", o.at("verdict")},
                                 {"seconds", o.at("seconds")}});
      }
    }
  } catch (const json::exception&) {
    checked.proofs.clear();
    checked.items.clear();
    return;
  }
  Publish(root);
  Notify("rondo/verification",
         {{"uri", UriOf(root)}, {"version", verifier_.version()}, {"items", checked.items}});
}

}  // namespace rondo::lsp
