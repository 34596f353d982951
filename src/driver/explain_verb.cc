#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "lang/suggest.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

ExitStatus Explain(const std::string& id, bool json) {
  const diag::KindInfo* info = diag::FindKind(id);
  if (info == nullptr) {
    std::vector<std::string> ids;
    for (const diag::KindInfo& known : diag::AllKinds()) ids.emplace_back(known.id);
    const std::string near = lang::Suggest(id, ids);
    PrintFailure(fmt::format(
        "there is no diagnostic `{}`{}", id,
        near.empty() ? "; `rondo explain` lists them" : fmt::format("; did you mean `{}`?", near)));
    return ExitStatus::kUsage;
  }
  if (json) {
    PrintJson({{"command", "explain"},
               {"status", ExitStatus::kEstablished},
               {"kind", info->id},
               {"severity", diag::SeverityName(info->severity)},
               {"summary", info->summary},
               {"explanation", info->explanation},
               {"example", info->example},
               {"verb", info->verb}});
    return ExitStatus::kEstablished;
  }
  std::string example;
  std::string_view rest = info->example;
  while (!rest.empty()) {
    const size_t end = std::min(rest.find('\n'), rest.size());
    example += end == 0 ? "\n" : fmt::format("    {}\n", rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  Print(fmt::format("{} [{}]: {}\n\n{}\n\nFor example, `rondo {}` reports it for\n\n{}",
                    diag::SeverityName(info->severity), info->id, info->summary, info->explanation,
                    info->verb, example));
  return ExitStatus::kEstablished;
}

}  // namespace

void AddExplainVerb(CLI::App& app, ExitStatus& status) {
  struct Options {
    std::string kind;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  Command verb(app, "explain", "what a diagnostic means, with an example");
  verb.Option("KIND", options->kind,
              "the name in brackets, such as koord-not-inductive; without it: all of them");
  verb.Flag("--json", options->json, "as JSON");
  verb.Footer("example: rondo explain koord-lost-update");
  verb.Run([options, &status] {
    if (!options->kind.empty()) {
      status = Explain(options->kind, options->json);
      return;
    }
    nlohmann::json list = nlohmann::json::array();
    for (const diag::KindInfo& info : diag::AllKinds()) {
      if (options->json)
        list.push_back(
            {{"kind", info.id}, {"severity", diag::SeverityName(info.severity)}, {"summary", info.summary}});
      else
        Print(fmt::format("{:28} {:8} {}\n", info.id, diag::SeverityName(info.severity), info.summary));
    }
    if (options->json)
      PrintJson({{"command", "explain"}, {"status", ExitStatus::kEstablished}, {"kinds", list}});
  });
}

}  // namespace rondo::driver
