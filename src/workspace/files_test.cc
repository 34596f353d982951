#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "fixtures/temporary_folder.h"
#include "workspace/koord_files.h"
#include "workspace/module_files.h"
#include "workspace/places.h"

namespace rondo::workspace {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "local:\n    int n = 0\nStep:\n    eff:\n        n = 0\n";
constexpr const char* kSpec = "invariant zero: forall i in ID: n[i] == 0\n";
constexpr const char* kRobot =
    "robot R {\n  state x: length in [0 m, 1 m]\n  motion Idle() interruptible [0, inf) {}\n}\n";

/// A folder of its own for each test.
class Folder : public testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_.Path(name); }
  std::string Write(const std::string& name, const std::string& text) const {
    return folder_.Write(name, text);
  }
  size_t Count(diag::Kind kind) const {
    size_t count = 0;
    for (const diag::Diagnostic& d : session_.diagnostics.all()) count += d.kind == kind ? 1 : 0;
    return count;
  }
  bool SaysOnly(diag::Kind kind) const {
    return session_.diagnostics.all().size() == 1 && session_.diagnostics.all()[0].kind == kind;
  }
  size_t RobotsIn(const LoadedModule& module) const {
    size_t count = 0;
    for (const choreo::Item& item : module.module.items)
      count += std::holds_alternative<robot::RobotDef>(item) ? 1 : 0;
    return count;
  }

  fixtures::TemporaryFolder folder_;
  Session session_;
};

class SourceFiles : public Folder {};

TEST_F(SourceFiles, AFileThatIsReadKeepsItsNameAndText) {
  const std::string path = Write("a.koord", "text\n");
  const auto file = ReadSource(path, Wanted::kText, session_);
  ASSERT_TRUE(file);
  EXPECT_EQ(session_.sources.path(*file), path);
  EXPECT_EQ(session_.sources.text(*file), "text\n");
  EXPECT_TRUE(session_.diagnostics.all().empty());
}

TEST_F(SourceFiles, AMissingFileIsOneReport) {
  EXPECT_FALSE(ReadSource(Path("none"), Wanted::kText, session_));
  EXPECT_TRUE(SaysOnly(diag::Kind::kFileUnreadable));
  EXPECT_EQ(session_.sources.size(), 0U);
}

TEST_F(SourceFiles, AFolderIsNoFile) {
  EXPECT_FALSE(ReadSource(folder_.path().string(), Wanted::kText, session_));
  EXPECT_TRUE(SaysOnly(diag::Kind::kFileUnreadable));
}

class KoordFiles : public Folder {};

TEST_F(KoordFiles, TheSpecificationBesideAProgramIsReadWithIt) {
  Write("p.spec", kSpec);
  const auto program = LoadKoord({Write("p.koord", kProgram), "", true}, session_);
  ASSERT_NE(program, nullptr);
  EXPECT_EQ(program->model.invariants.size(), 1U);
}

TEST_F(KoordFiles, AProgramNeedsNoSpecification) {
  Write("other.spec", kSpec);
  const auto program = LoadKoord({Write("p.koord", kProgram), "", true}, session_);
  ASSERT_NE(program, nullptr);
  EXPECT_TRUE(program->model.invariants.empty());
}

TEST_F(KoordFiles, ASpecificationThatIsNamedIsReadInsteadOfTheOneBeside) {
  Write("p.spec", std::string(kSpec) + "invariant again: true\n");
  const auto program = LoadKoord({Write("p.koord", kProgram), Write("other.spec", kSpec), true}, session_);
  ASSERT_NE(program, nullptr);
  EXPECT_EQ(program->model.invariants.size(), 1U);
}

TEST_F(KoordFiles, ASpecificationIsLeftOutOnDemand) {
  Write("p.spec", "this is no specification");
  const auto program = LoadKoord({Write("p.koord", kProgram), "", false}, session_);
  ASSERT_NE(program, nullptr);
  EXPECT_TRUE(program->model.invariants.empty());
  EXPECT_EQ(session_.sources.size(), 1U);
}

TEST_F(KoordFiles, AMissingProgramIsOneReport) {
  EXPECT_EQ(LoadKoord({Path("none.koord"), "", true}, session_), nullptr);
  EXPECT_TRUE(SaysOnly(diag::Kind::kFileUnreadable));
}

TEST_F(KoordFiles, AMissingSpecificationThatWasNamedIsOneReport) {
  EXPECT_EQ(LoadKoord({Write("p.koord", kProgram), Path("none.spec"), true}, session_), nullptr);
  EXPECT_TRUE(SaysOnly(diag::Kind::kFileUnreadable));
}

TEST_F(KoordFiles, AProgramThatIsASpecificationIsReadOnce) {
  const auto program = ReadKoord({Write("p.spec", kSpec), "", true}, session_);
  ASSERT_TRUE(program);
  EXPECT_EQ(session_.sources.size(), 1U);
}

TEST_F(KoordFiles, SyntaxErrorsAreReportedAndThereIsNoProgram) {
  EXPECT_EQ(LoadKoord({Write("p.koord", "Step:\n    eff:\n        n = = 1\n"), "", true}, session_), nullptr);
  EXPECT_TRUE(session_.diagnostics.has_errors());
  EXPECT_EQ(Count(diag::Kind::kFileUnreadable), 0U);
}

TEST_F(KoordFiles, AnErrorOfTheCheckerMeansThatThereIsNoProgram) {
  EXPECT_EQ(LoadKoord({Write("p.koord", "Step:\n    eff:\n        n = 1\n"), "", true}, session_), nullptr);
  EXPECT_EQ(Count(diag::Kind::kKoordUndeclared), 1U);
}

TEST_F(KoordFiles, TextsAreLoadedLikeFiles) {
  const auto program = LoadKoordTexts("p", kProgram, kSpec, session_);
  ASSERT_NE(program, nullptr);
  EXPECT_EQ(program->model.invariants.size(), 1U);
  const auto alone = LoadKoordTexts("p", kProgram, "", session_);
  ASSERT_NE(alone, nullptr);
  EXPECT_TRUE(alone->model.invariants.empty());
}

class ModuleFiles : public Folder {};

TEST_F(ModuleFiles, AreKnownByTheirExtension) {
  for (const char* name : {"a.rondo", "b/a.chor", "a.b.rosl"}) EXPECT_TRUE(IsModuleFile(name)) << name;
  for (const char* name : {"a.koord", "rondo", "a.rondo.txt", "", ".rondo/a"})
    EXPECT_FALSE(IsModuleFile(name)) << name;
}

TEST_F(ModuleFiles, AnImportIsRelativeToTheFileThatImports) {
  Write("sub/robot.rondo", kRobot);
  Write("sub/world.rondo", "import \"robot.rondo\"\nworld W { a: R }\n");
  const auto module = LoadModule({Write("main.rondo", "import \"sub/world.rondo\"\n")}, {}, session_);
  EXPECT_TRUE(session_.diagnostics.all().empty());
  ASSERT_NE(module->declarations, nullptr);
  EXPECT_EQ(RobotsIn(*module), 1U);
}

TEST_F(ModuleFiles, AFileThatIsImportedTwiceIsReadOnce) {
  Write("robot.rondo", kRobot);
  Write("other.rondo", "import \"robot.rondo\"\n");
  const auto module = LoadModule(
      {Write("main.rondo", "import \"robot.rondo\"\nimport \"other.rondo\"\nimport \"./robot.rondo\"\n")}, {},
      session_);
  EXPECT_TRUE(session_.diagnostics.all().empty());
  EXPECT_EQ(RobotsIn(*module), 1U);
  EXPECT_EQ(session_.sources.size(), 3U);
}

TEST_F(ModuleFiles, FilesThatImportEachOtherAreReadOnce) {
  Write("b.rondo", "import \"a.rondo\"\nworld W { a: R }\n");
  const auto module =
      LoadModule({Write("a.rondo", std::string("import \"b.rondo\"\n") + kRobot)}, {}, session_);
  EXPECT_TRUE(session_.diagnostics.all().empty());
  EXPECT_EQ(session_.sources.size(), 2U);
}

TEST_F(ModuleFiles, AFileThatIsGivenTwiceIsReadOnce) {
  const std::string path = Write("robot.rondo", kRobot);
  const auto module = LoadModule({path, path, (folder_.path() / "." / "robot.rondo").string()}, {}, session_);
  EXPECT_TRUE(session_.diagnostics.all().empty());
  EXPECT_EQ(RobotsIn(*module), 1U);
}

TEST_F(ModuleFiles, AMissingFileIsOneReportAndLeavesNothing) {
  const auto module = LoadModule({Path("none.rondo")}, {}, session_);
  ASSERT_NE(module, nullptr);
  EXPECT_TRUE(SaysOnly(diag::Kind::kFileUnreadable));
  EXPECT_EQ(module->declarations, nullptr);
  EXPECT_FALSE(CheckStructure(*module, session_));
}

TEST_F(ModuleFiles, AMissingImportIsReportedWhereItStands) {
  const auto module = LoadModule({Write("a.rondo", "import \"none.rondo\"\n")}, {}, session_);
  ASSERT_TRUE(SaysOnly(diag::Kind::kChoreoImport));
  EXPECT_EQ(session_.sources.Text(session_.diagnostics.all()[0].span), "import \"none.rondo\"");
  EXPECT_EQ(module->declarations, nullptr);
}

TEST_F(ModuleFiles, SyntaxErrorsLeaveNoDeclarations) {
  const auto module = LoadModule({Write("a.rondo", "robot R {\n")}, {}, session_);
  EXPECT_TRUE(session_.diagnostics.has_errors());
  EXPECT_EQ(module->declarations, nullptr);
  EXPECT_TRUE(module->graphs.empty());
}

TEST_F(ModuleFiles, ErrorsOfEarlierFilesDoNotStopLaterOnes) {
  LoadModule({Path("none.rondo")}, {}, session_);
  const auto module = LoadModule({Write("robot.rondo", kRobot)}, {}, session_);
  EXPECT_NE(module->declarations, nullptr);
  EXPECT_EQ(session_.diagnostics.errors(), 1U);
}

std::string TwoThatGo() {
  return "robot R {\n  state x: length in [0 m, 1 m]\n  motion Go() noninterruptible [2 s, 2 s] {}\n}\n"
         "world W { a: R b: R }\nchoreography C in W { { a: Go(), b: Go() } }\n";
}

TEST_F(ModuleFiles, OptionsHoldForEveryChoreography) {
  const std::string path = Write("a.rondo", TwoThatGo());
  CheckModule({path}, {}, session_);
  EXPECT_EQ(Count(diag::Kind::kChoreoTwoRigid), 1U);
  Session other;
  CheckModule({path}, {"equal_durations"}, other);
  EXPECT_FALSE(other.diagnostics.has_errors());
}

TEST_F(ModuleFiles, OnlyWellFormedChoreographiesPassTheCheckOfStructure) {
  const std::string world = std::string(kRobot) + "world W { a: R b: R }\nchoreography C in W { ";
  Session good;
  const auto one = LoadModule({Write("good.rondo", world + "a -> b: hello() }\n")}, {}, good);
  EXPECT_TRUE(CheckStructure(*one, good));
  const auto two = LoadModule({Write("bad.rondo", world + "rec X { continue X } }\n")}, {}, session_);
  EXPECT_FALSE(CheckStructure(*two, session_));
  EXPECT_EQ(Count(diag::Kind::kChoreoUnguarded), 1U);
}

TEST(Places, AFileNameHasOnlyLettersDigitsDashesAndUnderscores) {
  EXPECT_EQ(FileName("Az09-_"), "Az09-_");
  EXPECT_EQ(FileName("a/b c.d"), "a_b_c_d");
  EXPECT_EQ(FileName("../x"), "___x");
  EXPECT_EQ(FileName("\xC3\xA4"), "__");
  EXPECT_EQ(FileName(""), "");
}

TEST(Places, AnAbsolutePathHasNoDetours) {
  EXPECT_EQ(Absolute(""), "");
  EXPECT_EQ(Absolute("/a/../b/./c"), "/b/c");
  EXPECT_EQ(Absolute("x.koord"), (fs::current_path() / "x.koord").string());
}

TEST(Places, RunsOfDifferentPropertiesHaveDifferentFiles) {
  const std::string one = DefaultRunFile("dir/p.koord", "invariant a");
  EXPECT_NE(one, DefaultRunFile("dir/p.koord", "invariant b"));
  EXPECT_NE(one, DefaultRunFile("dir/q.koord", "invariant a"));
  EXPECT_EQ(fs::path(one).filename(), "p-invariant_a.json");
  EXPECT_EQ(fs::path(one).parent_path().filename(), "runs");
}

}  // namespace
}  // namespace rondo::workspace
