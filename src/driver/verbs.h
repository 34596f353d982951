#pragma once

namespace CLI {
class App;
}  // namespace CLI

/// The verbs of the command line. Each adds itself to the application and leaves its exit status in `status`.
namespace rondo::driver {

void AddCheckVerb(CLI::App& app, int& status);
void AddFormatVerb(CLI::App& app, int& status);
void AddAstVerb(CLI::App& app, int& status);
void AddInferVerb(CLI::App& app, int& status);
void AddGraphVerb(CLI::App& app, int& status);
void AddProjectVerb(CLI::App& app, int& status);
void AddProveVerb(CLI::App& app, int& status);
void AddExploreVerb(CLI::App& app, int& status);
void AddSimulateVerb(CLI::App& app, int& status);
void AddReplayVerb(CLI::App& app, int& status);
void AddPlotVerb(CLI::App& app, int& status);
void AddReachVerb(CLI::App& app, int& status);
void AddSolveVerb(CLI::App& app, int& status);
void AddCertifyVerb(CLI::App& app, int& status);
void AddExplainVerb(CLI::App& app, int& status);
void AddCompletionVerb(CLI::App& app, int& status);

}  // namespace rondo::driver
