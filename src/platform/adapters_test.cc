#include "platform/adapters.h"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <stdexcept>

#include "dds/domain_test.h"

namespace rondo::platform {
namespace {

struct Reads : adapter::Sensor {
  explicit Reads(std::function<adapter::Sample()> does) : reads(std::move(does)) {}
  adapter::Sample Read() override { return reads(); }
  std::function<adapter::Sample()> reads;
};

const Clock kClock(false);

AdaptedSensor::Said After(std::function<adapter::Sample()> reads, size_t parts = 1) {
  const AdaptedSensor sensor(std::make_unique<Reads>(std::move(reads)), parts, kClock);
  EXPECT_TRUE(dds::Eventually([&] {
    const auto said = sensor.said();
    return said.at || !said.wrong.empty();
  }));
  return sensor.said();
}

TEST(AdaptedSensor, KeepsWhatWasReadAndWhen) {
  const Time before = kClock.Now();
  const auto said = After([] { return adapter::Sample{{1, 2, 3}, 0.5, ""}; }, 3);
  EXPECT_EQ(said.numbers, (Numbers{1, 2, 3}));
  EXPECT_EQ(said.wrong, "");
  EXPECT_GE(*said.at, before - 500'000'000);
  EXPECT_LE(*said.at, kClock.Now() - 500'000'000);
}

TEST(AdaptedSensor, SaysWhatIsWrong) {
  EXPECT_EQ(After([] { return adapter::Sample{{}, 0, "no cable"}; }).wrong, "no cable");
  EXPECT_EQ(After([] {
              return adapter::Sample{{1, 2}, 0, ""};
            }).wrong,
            "it says 2 numbers, and has to say 1");
  EXPECT_NE(After([] { return adapter::Sample{{NAN}, 0, ""}; }).wrong, "");
  EXPECT_NE(After([] { return adapter::Sample{{1}, -1, ""}; }).wrong, "");
  EXPECT_EQ(After([]() -> adapter::Sample { throw std::runtime_error("it broke"); }).wrong, "it broke");
}

TEST(AdaptedSensor, WhoThrowsAnythingOrHangsStopsNobody) {
  EXPECT_NE(After([]() -> adapter::Sample { throw 7; }).wrong, "");
  const AdaptedSensor sensor(std::make_unique<Reads>([]() -> adapter::Sample {
                               for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
                             }),
                             1, kClock);
  EXPECT_FALSE(sensor.said().at);
}  // it ends

struct Does : adapter::Actuator {
  Does(std::function<void(double)> does, int& was_safe) : writes(std::move(does)), safe(was_safe) {}
  void Write(const std::vector<double>& numbers) override { writes(numbers[0]); }
  void Safe() noexcept override { ++safe; }
  std::function<void(double)> writes;
  int& safe;
};

TEST(AdaptedActuator, IsToldTheLatestAndMadeSafeOnce) {
  int safe = 0;
  std::atomic<double> last = 0;
  {
    AdaptedActuator actuator(std::make_unique<Does>([&](double x) { last = x; }, safe));
    for (int i = 1; i <= 100; ++i) actuator.Write({static_cast<double>(i)});
    EXPECT_TRUE(dds::Eventually([&] { return last == 100; }));
    EXPECT_EQ(actuator.TakeProblem(), "");
  }
  EXPECT_EQ(safe, 1);
  {
    AdaptedActuator actuator(std::make_unique<Does>([](double) { throw 7; }, safe));
    actuator.Write({1});
    std::string problem;
    EXPECT_TRUE(dds::Eventually([&] { return !(problem = actuator.TakeProblem()).empty(); }));
  }
  EXPECT_EQ(safe, 2);
}

TEST(Adapters, LibrariesThatAreNoneAreErrors) {
  const auto missing = MakeSensor("/nowhere/libnothing.so", {"bot0", "charge", ""});
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.error().message.find("cannot load the adapter of `charge`"), std::string::npos);
  const auto other = MakeActuator("libm.so.6", {"bot0", "lamp", ""});
  ASSERT_FALSE(other.ok());
  EXPECT_NE(other.error().message.find("RONDO_ACTUATOR"), std::string::npos);
}

}  // namespace
}  // namespace rondo::platform
