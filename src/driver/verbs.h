#pragma once

#include "verdict/verdict.h"

namespace CLI {
class App;
}  // namespace CLI

/// Declares the verbs of the command line. Each function adds its verb to the application; when the verb
/// runs, it leaves its exit status in `status`.
namespace rondo::driver {

void AddNewVerb(CLI::App& app, verdict::ExitStatus& status);
void AddCheckVerb(CLI::App& app, verdict::ExitStatus& status);
void AddFormatVerb(CLI::App& app, verdict::ExitStatus& status);
void AddAstVerb(CLI::App& app, verdict::ExitStatus& status);
void AddInferVerb(CLI::App& app, verdict::ExitStatus& status);
void AddGraphVerb(CLI::App& app, verdict::ExitStatus& status);
void AddProjectVerb(CLI::App& app, verdict::ExitStatus& status);
void AddProveVerb(CLI::App& app, verdict::ExitStatus& status);
void AddExploreVerb(CLI::App& app, verdict::ExitStatus& status);
void AddBuildVerb(CLI::App& app, verdict::ExitStatus& status);
void AddSimulateVerb(CLI::App& app, verdict::ExitStatus& status);
void AddCampaignVerb(CLI::App& app, verdict::ExitStatus& status);
void AddRunVerb(CLI::App& app, verdict::ExitStatus& status);
void AddLaunchVerb(CLI::App& app, verdict::ExitStatus& status);
void AddDoctorVerb(CLI::App& app, verdict::ExitStatus& status);
void AddKeysVerb(CLI::App& app, verdict::ExitStatus& status);
void AddReplayVerb(CLI::App& app, verdict::ExitStatus& status);
void AddPlotVerb(CLI::App& app, verdict::ExitStatus& status);
void AddViewVerb(CLI::App& app, verdict::ExitStatus& status);
void AddReachVerb(CLI::App& app, verdict::ExitStatus& status);
void AddSolveVerb(CLI::App& app, verdict::ExitStatus& status);
void AddCertifyVerb(CLI::App& app, verdict::ExitStatus& status);
void AddLspVerb(CLI::App& app, verdict::ExitStatus& status);
void AddWatchVerb(CLI::App& app, verdict::ExitStatus& status);
void AddExplainVerb(CLI::App& app, verdict::ExitStatus& status);
void AddCompletionVerb(CLI::App& app, verdict::ExitStatus& status);
void AddHelpVerb(CLI::App& app, verdict::ExitStatus& status);
void AddVersionVerb(CLI::App& app, verdict::ExitStatus& status);

}  // namespace rondo::driver
