#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "lsp/positions.h"
#include "lsp/verifier.h"
#include "workspace/session.h"

/// Speaks the Language Server Protocol 3.17 about programs and choreographies.
namespace rondo::lsp {

/// Is a language server without its streams: messages in, messages out. One thread uses it.
///
/// While somebody types, files are checked (everything that needs no solver), with the texts that editors have, not those on
/// the disk. When a file is saved it is proved, in a process of its own, which the next change ends. What is published is about
/// the text that the editor has: never about an older one.
class Server {
 public:
  /// @param executable  of `rondo`, for proofs; empty: none are made.
  explicit Server(std::string executable) : verifier_(std::move(executable)) {}

  /// Takes a message in. @param text  JSON.
  void Hear(const std::string& text);
  /// Checks what changed. To be called when no message waits: several edits are one.
  void Settle();
  /// Returns the messages to be sent, and forgets them.
  std::vector<std::string> TakeMessages();
  /// Returns the status to exit with, when the other side wants that.
  const std::optional<int>& exits() const { return exits_; }
  /// Returns what can be read from when proofs are under way; -1: none are. `Proofs` then goes on.
  int descriptor() const { return verifier_.descriptor(); }
  void Proofs();

 private:
  using Json = nlohmann::json;
  struct Document {
    std::string uri, path, text;
    int64_t version = 0;
  };
  /// Is what is known of a file that is checked as a whole, with what belongs to it.
  struct Checked {
    std::set<std::string> files;                           // that a check read: paths
    std::map<std::string, std::vector<Json>> diagnostics;  // by address: as they are published
    std::map<std::string, std::vector<Json>> fixes;        // by address: code actions with their ranges
    std::map<std::string, std::vector<Json>> proofs;       // by address: diagnostics of proofs
    std::vector<Json> items;                               // of the last verification
  };

  void Answer(const Json& id, Json result);
  void Refuse(const Json& id, int code, const std::string& why);
  void Notify(const std::string& method, Json parameters);
  void Request(const Json& id, const std::string& method, const Json& parameters);
  void Notification(const std::string& method, const Json& parameters);

  Json Initialize(const Json& parameters);
  void Open(const Json& parameters);
  void Change(const Json& parameters);
  void Save(const Json& parameters);
  void Close(const Json& parameters);
  Json Format(const Json& parameters);
  Json Symbols(const Json& parameters);
  Json Actions(const Json& parameters);
  Json Hover(const Json& parameters);
  Json Definition(const Json& parameters);
  Json Complete(const Json& parameters);
  Json References(const Json& parameters);
  Json Highlights(const Json& parameters);
  Json NameAt(const Json& parameters);
  base::Result<Json> Rename(const Json& parameters);

  std::string WordAt(const Document& document, const Json& parameters) const;
  /// Returns the paths of everything that the last check of a root read, which is made if there was none.
  const std::set<std::string>& FilesOf(const std::string& root);
  /// Returns the roots that are known to read a file, and its own.
  std::set<std::string> RootsWith(const std::string& path) const;
  /// Returns where a word stands in everything that is read with a file, by path: bytes.
  std::map<std::string, std::vector<std::pair<size_t, size_t>>> PlacesOf(const std::string& of,
                                                                         const std::string& word);
  Json RangeOf(const std::string& text, std::pair<size_t, size_t> bytes) const;

  /// Returns which file is checked when this one changes: the program of a specification.
  std::string RootOf(const std::string& path) const;
  const Document* Find(const Json& parameters) const;
  const Document* At(const std::string& path) const;
  void Prepare(workspace::Session& session) const;
  void Check(const std::string& root);
  void Publish(const std::string& root);
  void Forget(const std::string& root);
  /// Forgets everything that depends on a file.
  void Touch(const std::string& path);
  /// Reports whether what a proof reads from the disk is what the editor has.
  bool Saved(const std::string& root) const;
  Json RangeOf(const workspace::Session& session, diag::Span span) const;
  /// Converts a place of the schema of JSON, in the text that the editor has.
  Json RangeOf(const Json& place) const;
  std::string TextOf(const std::string& path) const;
  Json ToJson(const workspace::Session& session, const diag::Diagnostic& d) const;
  Json OfProof(const Json& diagnostic) const;

  Encoding encoding_ = Encoding::kUtf16;
  bool initialized_ = false, shut_ = false;
  std::optional<int> exits_;
  std::map<std::string, Document> documents_;  // by path
  std::map<std::string, Checked> checked_;     // by root
  std::vector<std::string> dirty_;             // roots
  Verifier verifier_;
  std::vector<std::string> out_;
};

/// Serves on these streams until the other side says goodbye or goes away. Returns the exit status.
int Serve(int in, int out, const std::string& executable);

}  // namespace rondo::lsp
