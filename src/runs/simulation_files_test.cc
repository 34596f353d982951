#include "runs/simulation_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace rondo::runs {
namespace {

namespace fs = std::filesystem;

TEST(SimulationFileNames, AProgramHasItsFleetBesideIt) {
  const SimulationFiles files = FindSimulationFiles("d/a.koord", "", "");
  EXPECT_EQ(files.program, "d/a.koord");
  EXPECT_EQ(files.fleet, "d/a.toml");
  EXPECT_EQ(files.spec, "");
}

TEST(SimulationFileNames, AFleetHasItsProgramBesideIt) {
  const SimulationFiles files = FindSimulationFiles("d/a.toml", "", "");
  EXPECT_EQ(files.program, "d/a.koord");
  EXPECT_EQ(files.fleet, "d/a.toml");
}

TEST(SimulationFileNames, ANameStandsForBoth) {
  const SimulationFiles files = FindSimulationFiles("d/none", "", "");
  EXPECT_EQ(files.program, "d/none.koord");
  EXPECT_EQ(files.fleet, "d/none.toml");
}

TEST(SimulationFileNames, WhatIsNamedIsNotReplaced) {
  const SimulationFiles files = FindSimulationFiles("d/a.koord", "s.spec", "f.toml");
  EXPECT_EQ(files.spec, "s.spec");
  EXPECT_EQ(files.fleet, "f.toml");
}

TEST(SimulationFileNames, AProgramMayHaveAnyName) {
  const fs::path file = fs::path(testing::TempDir()) / ("program-" + std::to_string(::getpid()));
  std::ofstream(file) << "Step:\n";
  const SimulationFiles files = FindSimulationFiles(file.string(), "", "");
  fs::remove(file);
  EXPECT_EQ(files.program, file.string());
  EXPECT_EQ(files.fleet, file.string() + ".toml");
}

TEST(SimulationFileNames, EachTextIsKeptAsWhatItIs) {
  workspace::Session session;
  session.sources.Add("d/a.koord", "program");
  session.sources.Add("d/a.spec", "specification");
  session.sources.Add("d/a.toml", "fleet");
  sim::SimulationOptions options;
  KeepTexts({"d/a.koord", "", "d/a.toml"}, session, {}, options);
  EXPECT_EQ(options.program, "program");
  EXPECT_EQ(options.spec, "specification");
  EXPECT_EQ(options.fleet, "fleet");
  EXPECT_EQ(options.program_name, "a.koord");
}

}  // namespace
}  // namespace rondo::runs
