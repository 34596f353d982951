#include "runs/fleet_files.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fixtures/temporary_folder.h"

namespace rondo::runs {
namespace {

using sim::BodyPort;

const char* const kTank =
    "robot Tank {\n  param leak = 0.5\n  state level: number in [0, 10]\n  memory filling: number in [0, 1]\n"
    "  input pump: number in [0, 2]\n  input rain: number in [0, 0.25]\n"
    "  dynamics { level' = (pump + filling + rain - leak) / 1 s }\n"
    "  control every 100 ms { when level <= 2 { filling = 1 } when level >= 4 { filling = 0 } }\n"
    "  port level = level\n  port pump = pump\n  port full = level >= 4\n  port net = pump - leak\n}\n";

// A fleet of one robot of the type Tank.
class Tanks : public testing::Test {
 protected:
  explicit Tanks() { folder_.Write("tank.rondo", kTank); }

  sim::Fleet Read(const std::string& robot, const std::string& model = "Tank") {
    const std::string text = "[[robot]]\nmodel = \"" + model + "\"\nfrom = \"tank.rondo\"\n" + robot;
    files_ = std::make_unique<FleetFiles>(folder_.Path("f.toml"), session_);
    return files_->Read(session_.sources.Add("f.toml", text));
  }
  std::string Message() const {
    return session_.diagnostics.all().empty() ? "" : session_.diagnostics.all()[0].message;
  }
  static double Number(const sim::Body& body, const char* port) {
    double value = -1;
    body.ReadPort(*body.FindPort(port), std::span(&value, 1));
    return value;
  }

  fixtures::TemporaryFolder folder_;
  workspace::Session session_;
  std::unique_ptr<FleetFiles> files_;
};

TEST_F(Tanks, HaveTheirModelsPorts) {
  const sim::Fleet fleet = Read("initial = { level = 3 }\n");
  ASSERT_FALSE(session_.diagnostics.has_errors()) << Message();
  const auto body = fleet.robots[0].make();
  body->Place({}, 0);
  EXPECT_EQ(Number(*body, "level"), 3);
  EXPECT_EQ(Number(*body, "full"), 0);
  EXPECT_EQ(Number(*body, "net"), -0.5);
  EXPECT_TRUE(body->FindPort("pump")->settable);
  EXPECT_FALSE(body->FindPort("level")->settable);
  EXPECT_FALSE(body->FindPort("net")->settable);
  EXPECT_EQ(body->FindPort("full")->kind, BodyPort::Kind::kBool);
  EXPECT_FALSE(body->FindPort("nothing"));
}

TEST_F(Tanks, FollowTheirDynamicsEventsAndDisturbances) {
  const sim::Fleet fleet = Read("initial = { level = 3 }\nparameters = { leak = 1 }\n");
  ASSERT_FALSE(session_.diagnostics.has_errors()) << Message();
  std::vector<double> levels[2];
  for (int run = 0; run < 2; ++run) {
    const auto body = fleet.robots[0].make();
    body->Seed(5);
    body->Place({}, 0);
    double least = 10;
    double most = 0;
    for (int step = 0; step < 6000; ++step) {
      ASSERT_TRUE(body->Step(0.01, sim::Integrator::kRungeKutta4));
      levels[run].push_back(Number(*body, "level"));
      least = std::min(least, levels[run].back());
      most = std::max(most, levels[run].back());
    }
    // It falls at 1 less the rain until 2, then holds or rises with the rain.
    EXPECT_LE(least, 2.0);
    EXPECT_GE(least, 1.98);
    EXPECT_LE(most, 4.02);
    EXPECT_TRUE(body->TakeBroken().empty());
  }
  EXPECT_EQ(levels[0], levels[1]);
}

TEST_F(Tanks, SayWhatTheirModelExcludes) {
  const sim::Fleet fleet = Read("initial = { level = 9 }\n");
  const auto body = fleet.robots[0].make();
  body->Place({}, 0);
  const double much = 2;
  body->WritePort(*body->FindPort("pump"), std::span(&much, 1));
  for (int step = 0; step < 200; ++step) ASSERT_TRUE(body->Step(0.01, sim::Integrator::kRungeKutta4));
  EXPECT_EQ(body->TakeBroken(), std::vector<std::string>{"`level` in [0, 10]"});
  const double more = 3;
  body->WritePort(*body->FindPort("pump"), std::span(&more, 1));
  EXPECT_EQ(body->TakeBroken(), std::vector<std::string>{"`pump` in [0, 2]"});
  EXPECT_TRUE(body->TakeBroken().empty());
}

TEST_F(Tanks, WithMistakesAreRefused) {
  const auto message = [&](const std::string& robot, const std::string& model = "Tank") {
    session_.diagnostics = {};
    Read(robot, model);
    return Message();
  };
  EXPECT_EQ(message("", "Tonk"), "there is no robot type `Tonk` in `tank.rondo`");
  EXPECT_EQ(message("parameters = { lake = 1 }\n"), "`Tank` has no parameter `lake`");
  EXPECT_EQ(message("initial = { leval = 1 }\n"), "`Tank` has no state `leval`");
  EXPECT_EQ(message("initial = { level = 11 }\n"), "`level` starts with 11, and it is in [0, 10]");
  folder_.Write("tank.rondo",
                "robot Tank { state x: number in [0, 1] input v: number dynamics { x' = v / 1 s } }\n");
  EXPECT_TRUE(message("").starts_with("`Tank` cannot be a body: nobody sets the input `v`")) << message("");
  folder_.Write("tank.rondo", "robot Tank { state x: number in [0, 1] }\n");
  EXPECT_TRUE(message("").starts_with("`Tank` cannot be a body: nothing is known about how `x` changes"))
      << message("");
  folder_.Write("tank.rondo",
                "robot Tank { param a: length state x: length in [0, 1 m] dynamics { x' = a / 1 s } }\n");
  EXPECT_EQ(message(""), "`Tank` has parameters without a value");
  EXPECT_EQ(message("parameters = { a = 0.5 }\n"), "");
}

TEST_F(Tanks, AreKeptForTraces) {
  folder_.Write("all.rondo", "import \"tank.rondo\"\n");
  workspace::Session first;
  const std::string text = "[[robot]]\nmodel = \"Tank\"\nfrom = \"all.rondo\"\ninitial = { level = 1 }\n";
  FleetFiles files(folder_.Path("f.toml"), first);
  files.Read(first.sources.Add("f.toml", text));
  ASSERT_FALSE(first.diagnostics.has_errors()) << first.diagnostics.all()[0].message;
  EXPECT_EQ(files.contents().size(), 2U);
  const auto kept = FilesFromJson(ToJson(files.contents()));
  ASSERT_TRUE(kept);
  EXPECT_EQ(*kept, files.contents());
  // Elsewhere, without the files.
  workspace::Session second;
  FleetFiles again(*kept, second);
  const sim::Fleet fleet = again.Read(second.sources.Add("fleet", text));
  EXPECT_FALSE(second.diagnostics.has_errors());
  EXPECT_EQ(fleet.robots.size(), 1U);
  workspace::Session third;
  FleetFiles nothing(FileContents{}, third);
  nothing.Read(third.sources.Add("fleet", text));
  EXPECT_TRUE(third.diagnostics.has_errors());
}

TEST(FileContentsAsJson, KeepsEveryByte) {
  FileContents files;
  for (size_t length = 0; length < 6; ++length) {
    std::string bytes;
    for (size_t i = 0; i < length; ++i) bytes += static_cast<char>(255 - 37 * i);
    files["map" + std::to_string(length) + ".pgm"] = bytes;
  }
  files["map.yaml"] = "# caf\xe9\n";  // no UTF-8
  EXPECT_EQ(FilesFromJson(nlohmann::json::parse(ToJson(files).dump())), files);
  EXPECT_FALSE(FilesFromJson({{"a.pgm", {{"base64", "a*bc"}}}}));
  EXPECT_FALSE(FilesFromJson({{"a.pgm", 3}}));
  EXPECT_FALSE(FilesFromJson(nlohmann::json::array()));
}

}  // namespace
}  // namespace rondo::runs
