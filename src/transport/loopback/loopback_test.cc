#include "transport/loopback/loopback.h"

#include <gtest/gtest.h>

#include "transport/conformance_test.h"
#include "transport/threads_test.h"

namespace rondo::transport::loopback {
namespace {

struct Loopback {
  std::vector<std::unique_ptr<Transport>> Connect(size_t robots) {
    hub = std::make_unique<Hub>(robots);
    std::vector<std::unique_ptr<Transport>> ways;
    for (uint32_t r = 0; r < robots; ++r) ways.push_back(hub->Connect(r));
    return ways;
  }
  std::unique_ptr<Hub> hub;
};

TEST(Loopback, TheOldestGiveWay) {
  Hub hub(2, 3);
  const auto a = hub.Connect(0), b = hub.Connect(1);
  for (uint8_t i = 0; i < 5; ++i) a->Send(1, Bytes{i});
  Bytes datagram;
  for (uint8_t i = 2; i < 5; ++i) {
    EXPECT_TRUE(b->Receive(b->Now(), datagram));
    EXPECT_EQ(datagram, Bytes{i});
  }
  EXPECT_FALSE(b->Receive(b->Now(), datagram));
}

TEST(Drive, SessionsOfThreadsEnd) {
  Loopback fleet;
  ExpectSessionsEnd(fleet.Connect(4));
}

TEST(Drive, AFleetOfThreadsAgrees) {
  Loopback fleet;
  ExpectThreadsAgree(fleet.Connect(4));
}

}  // namespace
}  // namespace rondo::transport::loopback

namespace rondo::transport {
INSTANTIATE_TYPED_TEST_SUITE_P(Loopback, TransportConformance, loopback::Loopback);
}  // namespace rondo::transport
