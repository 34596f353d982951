#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/counted.h"
#include "base/file.h"
#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "runs/build.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

struct Options {
  std::string file;
  std::string spec;
  std::string fleet;
  std::optional<uint64_t> robots;
  std::vector<std::string> capacities;
  std::string folder;
  bool print = false;
  bool json = false;
};

ExitStatus Fail(const Options& options, const workspace::Session& session, const std::string& why) {
  return Refuse("build", options.file, options.json, session.sources, session.diagnostics, why);
}

// `64`, or `List<pos>=64`.
void ReadCapacity(const std::string& text, codegen::Capacities& capacities) {
  const size_t equals = text.rfind('=');
  const std::string number = equals == std::string::npos ? text : text.substr(equals + 1);
  uint32_t most = 0;
  const auto [end, problem] = std::from_chars(number.data(), number.data() + number.size(), most);
  if (problem != std::errc() || end != number.data() + number.size() || most == 0 || most > 1'000'000)
    RefuseOption("--capacity",
                 fmt::format("`{}` is neither a number from 1 to 1000000 nor `TYPE=NUMBER`", text));
  if (equals == std::string::npos) {
    capacities.others = most;
  } else {
    capacities.by_type[text.substr(0, equals)] = most;
  }
}

// Nothing if all is written, else why not.
std::string Write(const std::filesystem::path& folder, const runs::BuiltProject& project,
                  std::vector<std::string>& written) {
  const auto made = base::MakeFolders(folder / "koord");
  if (!made.ok()) return fmt::format("cannot make `{}`: {}", folder.string(), made.error().message);
  const auto write = [&](const std::string& name, const std::string& text) -> std::string {
    const auto done = base::WriteFileAtomically(folder / name, text);
    if (!done.ok())
      return fmt::format("cannot write `{}`: {}", (folder / name).string(), done.error().message);
    written.push_back((folder / name).string());
    return {};
  };
  for (const auto& [name, text] : project.files) {
    if (const std::string why = write(name, text); !why.empty()) return why;
  }
  std::error_code none;
  for (const auto& [name, text] : project.to_fill_in) {
    if (std::filesystem::exists(folder / name, none)) continue;
    if (const std::string why = write(name, text); !why.empty()) return why;
  }
  return {};
}

ExitStatus Run(const Options& options) {
  if (options.print == !options.folder.empty()) RefuseOption("-o", "say where to: `-o FOLDER`, or `--print`");
  workspace::Session session;
  runs::BuildRequest request{options.file, options.spec, options.fleet, options.robots, {}};
  for (const std::string& text : options.capacities) ReadCapacity(text, request.capacities);
  const auto project = runs::Build(request, session);
  if (!project) return Fail(options, session, {});
  std::vector<std::string> written;
  if (!options.print) {
    if (const std::string why = Write(options.folder, *project, written); !why.empty())
      return Fail(options, session, why);
  }
  if (options.json) {
    nlohmann::json json{{"command", "build"},
                        {"file", options.file},
                        {"name", project->name},
                        {"robots", project->robots},
                        {"written", written},
                        {"status", ExitStatus::kEstablished},
                        {"diagnostics", diag::RenderJson(session.sources, session.diagnostics)}};
    for (const auto& [name, text] : project->files) {
      if (options.print) json["files"][name] = text;
    }
    PrintJson(json);
    return ExitStatus::kEstablished;
  }
  if (options.print) {
    Print(project->files[0].text + "\n" + project->files[1].text);
  } else {
    std::string text = fmt::format("{} for {}: {}\n", project->name, base::Counted(project->robots, "robot"),
                                   options.folder);
    for (const std::string& file : written) text += fmt::format("  {}\n", file);
    text += fmt::format("next: cmake -S {0} -B {0}/build && cmake --build {0}/build\n", options.folder);
    Print(text);
  }
  PrintDiagnostics(session.sources, session.diagnostics);
  return ExitStatus::kEstablished;
}

}  // namespace

void AddBuildVerb(CLI::App& app, ExitStatus& status) {
  auto options = std::make_shared<Options>();
  Command verb(app, "build", "make C++ of a Koord program");
  verb.Option(
          "FILE", options->file,
          "the Koord program, with or without `.koord`; `NAME.toml` beside it is the fleet that it is made for")
      .Required();
  verb.Option("--robots", options->robots, "for so many robots; with `--fleet`, its parameters count still")
      .Between(uint64_t{1}, uint64_t{1000});
  verb.Option("--fleet", options->fleet, "the fleet, if it is not beside the program");
  verb.Option("--spec", options->spec, "the specification, if it is not beside the program");
  verb.Option(
          "--capacity", options->capacities,
          "how many items lists have room for: `64`, or for one type `'List<pos>=64'`; more of them in `[capacities]` of a fleet")
      .OneEach();
  verb.Option("-o,--output", options->folder, "the folder to write to");
  verb.Flag("--print", options->print, "print the C++, and write nothing");
  verb.Flag("--json", options->json, "the result as JSON on standard output");
  verb.Footer(
      "examples:\n"
      "  rondo build examples/koord/lineform.koord -o lineform\n"
      "  rondo build examples/koord/delivery --capacity 'List<pos>=32' --capacity 'List<Task>=4' -o delivery\n"
      "\n"
      "The project needs the package of Rondo (`find_package(rondo)`) and nothing else. `answers.h` is to be filled in: it answers\n"
      "what the program asks external functions. docs/build.md says more.\n"
      "exit status: 0 made, 1 something is wrong, 2 usage");
  verb.Run([options, &status] { status = Run(*options); });
}

}  // namespace rondo::driver
