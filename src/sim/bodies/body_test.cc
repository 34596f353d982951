#include "sim/bodies/body.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rondo::sim {
namespace {

TEST(Integrator, RungeKuttaAndAdaptiveStepsAgreeOnAnOscillator) {
  const Derivative f = [](std::span<const double> x, std::span<double> dx) {
    dx[0] = x[1];
    dx[1] = -x[0];
  };
  std::vector<double> fixed{1, 0};
  std::vector<double> adaptive{1, 0};
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(Integrate(Integrator::kRungeKutta4, f, fixed, 0.01));
    ASSERT_TRUE(Integrate(Integrator::kAdaptive, f, adaptive, 0.01));
  }
  EXPECT_NEAR(fixed[0], std::cos(10.0), 1e-8);
  EXPECT_NEAR(adaptive[0], std::cos(10.0), 1e-6);
}

TEST(Integrator, ReportsAStateThatIsNotFinite) {
  const Derivative f = [](std::span<const double> x, std::span<double> dx) { dx[0] = x[0] * x[0] * 1e300; };
  std::vector<double> state{1e10};
  EXPECT_FALSE(Integrate(Integrator::kRungeKutta4, f, state, 1));
}

class EveryModel : public testing::TestWithParam<std::string> {};

TEST_P(EveryModel, GoesThroughItsWaypointsAndStays) {
  for (const Integrator integrator : {Integrator::kRungeKutta4, Integrator::kAdaptive}) {
    const auto body = MakeBody(GetParam());
    body->Place({0, 0, body->flies() ? 1.0 : 0.0}, 0.3);
    EXPECT_FALSE(body->reached());
    const Point goal{3, -2, body->flies() ? 2.0 : 0.0};
    body->Follow({{2, 1, goal[2]}, goal});
    EXPECT_FALSE(body->reached());
    double nearest = 100;
    for (int i = 0; i < 3000; ++i) {
      ASSERT_TRUE(body->Step(0.01, integrator));
      nearest = std::min(nearest, Distance(body->position(), {2, 1, goal[2]}));
    }
    EXPECT_TRUE(body->reached()) << GetParam();
    EXPECT_LE(Distance(body->position(), goal), body->Value("tolerance") + 0.05);
    EXPECT_LE(nearest, body->Value("waypoint_tolerance") + 0.15);
    const auto q = body->rotation();
    EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1, 1e-9);
  }
}

TEST_P(EveryModel, HoldsWhereItIsPlaced) {
  const auto body = MakeBody(GetParam());
  body->Place({1, 2, 3}, 1);
  for (int i = 0; i < 500; ++i) ASSERT_TRUE(body->Step(0.01, Integrator::kRungeKutta4));
  EXPECT_LT(Distance(body->position(), {1, 2, 3}), 1e-6);
  EXPECT_TRUE(body->reached());
}

INSTANTIATE_TEST_SUITE_P(Bodies, EveryModel, testing::ValuesIn(BodyModels()),
                         [](const auto& test) { return test.param; });

TEST(Quadrotor, OvershootsMoreWithIntegralGains) {
  double overshoot[2] = {0, 0};
  for (int gains = 0; gains < 2; ++gains) {
    const auto body = MakeBody("quadrotor");
    body->Set("gains", gains);
    body->Place({0, 0, 2}, 0);
    body->Follow({{4, 0, 2}});
    for (int i = 0; i < 2000; ++i) {
      ASSERT_TRUE(body->Step(0.01, Integrator::kRungeKutta4));
      overshoot[gains] = std::max(overshoot[gains], body->position()[0] - 4);
    }
  }
  EXPECT_GT(overshoot[1], overshoot[0]);
}

TEST(Car, FollowsTheCircleOfItsSteering) {
  // yaw' = v tan(steer) / L: a car that turns as hard as it can stays on a circle.
  const auto body = MakeBody("car");
  body->Place({0, 0, 0}, 0);
  body->Follow({{0, 30, 0}});
  const double radius = 0.33 / std::tan(0.6);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(body->Step(0.01, Integrator::kRungeKutta4));
  EXPECT_NEAR(Distance(body->position(), {0, radius, 0}), radius, 1e-6);
}

// The controller of a body on a robot: where it is measured to be is all that it knows.
TEST(DrivenBody, GoesWhereTheControllerOfAnotherOneTellsIt) {
  for (const char* model : {"unicycle", "car", "cart"}) {
    const auto alone = MakeBody(model), wheels = MakeBody(model), controller = MakeBody(model);
    for (const auto* body : {&alone, &wheels, &controller}) (*body)->Place({0, 0, 0}, 0.3);
    for (const auto* body : {&alone, &controller}) (*body)->Follow({{2, 1, 0}, {3, -2, 0}});
    for (int i = 0; i < 4000; ++i) {
      ASSERT_TRUE(alone->Step(0.01, Integrator::kRungeKutta4));
      controller->Put(wheels->position(), wheels->yaw());
      controller->Decide(0.01);
      ASSERT_TRUE(controller->Told());
      ASSERT_TRUE(wheels->Drive(*controller->Told(), 0.01, Integrator::kRungeKutta4));
    }
    EXPECT_LT(Distance(wheels->position(), alone->position()), 1e-6) << model;
    EXPECT_LT(Distance(wheels->position(), {3, -2, 0}), 0.3) << model;
  }
  EXPECT_FALSE(MakeBody("quadrotor")->Told());
}

}  // namespace
}  // namespace rondo::sim
