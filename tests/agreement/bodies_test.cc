// Bodies that fleets have without a file, against the same ones in the language of models: two programs
// that share neither dynamics nor controllers nor integration code for them go the same ways.
#include <gtest/gtest.h>

#include <random>

#include "base/uniform.h"
#include "runs/fleet_files.h"

namespace rondo::runs {
namespace {

struct Pair {
  const char* built_in;
  const char* model;
};
void PrintTo(const Pair& pair, std::ostream* out) { *out << pair.model; }

class EveryPair : public testing::TestWithParam<Pair> {};

TEST_P(EveryPair, GoesTheSameWay) {
  workspace::Session session;
  const std::string text = std::string("[[robot]]\nmodel = \"") + GetParam().built_in +
                           "\"\nposition = [0, 0, 0]\n[[robot]]\nmodel = \"" + GetParam().model +
                           "\"\nfrom = \"models/bodies.rondo\"\n";
  FleetFiles files("fleet.toml", session);
  const sim::Fleet fleet = files.Read(session.sources.Add("fleet.toml", text));
  ASSERT_FALSE(session.diagnostics.has_errors()) << session.diagnostics.all()[0].message;
  std::mt19937_64 random(7);
  for (int run = 0; run < 20; ++run) {
    const double yaw = 6 * base::Uniform(random) - 3;
    const sim::Point goal{8 * base::Uniform(random) - 4, 8 * base::Uniform(random) - 4, 0};
    const auto a = fleet.robots[0].make();
    const auto b = fleet.robots[1].make();
    for (sim::Body* body : {a.get(), b.get()}) {
      body->Place({1, -1, 0}, yaw);
      body->Follow({goal});
    }
    for (int step = 0; step < 1500; ++step) {
      ASSERT_TRUE(a->Step(0.01, sim::Integrator::kRungeKutta4));
      ASSERT_TRUE(b->Step(0.01, sim::Integrator::kRungeKutta4));
      ASSERT_LT(sim::Distance(a->position(), b->position()), 1e-6) << "run " << run << ", step " << step;
      ASSERT_LT(std::abs(sim::Wrap(a->yaw() - b->yaw())), 1e-6);
    }
    EXPECT_LT(sim::Distance(b->position(), goal), 0.3);
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, EveryPair,
                         testing::Values(Pair{"unicycle", "Unicycle"}, Pair{"car", "Bicycle"},
                                         Pair{"cart", "OmniCart"}, Pair{"point_mass", "PointMass"}),
                         [](const auto& test) { return test.param.model; });

}  // namespace
}  // namespace rondo::runs
