#include "driver/main.h"

#include <fmt/format.h>
#include <signal.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <sstream>

#include "base/version.h"
#include "driver/terminal.h"
#include "driver/usage.h"
#include "driver/verbs.h"
#include "solve/z3/z3_solver.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

/// In the order of the help.
constexpr void (*kVerbs[])(CLI::App&, ExitStatus&) = {
    AddNewVerb,      AddCheckVerb,      AddFormatVerb,  AddProveVerb,   AddExploreVerb, AddSimulateVerb,
    AddRunVerb,      AddLaunchVerb,     AddBuildVerb,   AddDoctorVerb,  AddKeysVerb,    AddReplayVerb,
    AddCampaignVerb, AddPlotVerb,       AddViewVerb,    AddReachVerb,   AddInferVerb,   AddGraphVerb,
    AddProjectVerb,  AddSolveVerb,      AddCertifyVerb, AddWatchVerb,   AddLspVerb,     AddExplainVerb,
    AddAstVerb,      AddCompletionVerb, AddHelpVerb,    AddVersionVerb,
};

// A reader that went away is no error; a full disk is.
ExitStatus Written(ExitStatus status) {
  if ((std::fflush(stdout) == 0 && std::ferror(stdout) == 0) || errno == EPIPE) return status;
  PrintFailure("cannot write the output");
  return status == ExitStatus::kEstablished ? ExitStatus::kRejected : status;
}

}  // namespace

std::string VersionText() {
  const std::string commit(base::Commit());
  return fmt::format("rondo {}{}", base::Version(),
                     commit.empty() ? "" : fmt::format(" (commit {})", commit));
}

int Main(int argc, char** argv) {
  // A reader that goes away (`rondo ... | head`) ends the output, not the program with a signal.
  ::signal(SIGPIPE, SIG_IGN);
  ExitStatus status = ExitStatus::kEstablished;
  CLI::App app{"Rondo: write, prove and run programs for teams of robots", "rondo"};
  app.require_subcommand(1);
  app.set_version_flag("--version", VersionText());
  app.footer(
      "example: rondo prove examples/koord/lineform.koord\n"
      "\n"
      "exit status: 0 established, 1 wrong input, refuted or not inductive, 2 usage, 3 unknown, 4 a bug of ours");
  for (const auto add : kVerbs) add(app, status);
  const std::string first = argc > 1 ? argv[1] : "-";
  if (!first.starts_with('-') && FindVerb(app, first) == nullptr) {
    PrintFailure(NoSuchVerb(app, first));
    return static_cast<int>(Written(ExitStatus::kUsage));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const std::string why =
        error.get_exit_code() == 0 ? "" : NoSuchOption(app, std::vector<std::string>(argv + 1, argv + argc));
    if (!why.empty()) {
      PrintFailure(why);
      return static_cast<int>(Written(ExitStatus::kUsage));
    }
    std::ostringstream out, wrong;
    const int code = app.exit(error, out, wrong);
    Print(out.str());
    PrintError(wrong.str());
    return static_cast<int>(Written(code == 0 ? ExitStatus::kEstablished : ExitStatus::kUsage));
  } catch (const std::bad_alloc&) {
    PrintFailure("out of memory");
    return static_cast<int>(ExitStatus::kUndecided);
  } catch (const std::exception& error) {
    PrintFailure(fmt::format("bug: {}", error.what()));
    return static_cast<int>(ExitStatus::kBug);
  }
  status = Written(status);
  if (solve::z3::LeftBehind()) {
    std::fflush(nullptr);
    std::_Exit(static_cast<int>(status));
  }
  return static_cast<int>(status);
}

}  // namespace rondo::driver
