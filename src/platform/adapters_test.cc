#include "platform/adapters.h"

#include <gtest/gtest.h>

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
