#include "transport/dds/way.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "dds/domain_test.h"
#include "transport/conformance_test.h"
#include "transport/threads_test.h"

namespace rondo::transport::dds {
namespace {

// Robots of one process, each with a participant of its own, that have found each other.
struct TestFleet {
  std::vector<std::unique_ptr<Transport>> Connect(size_t robots) {
    Fleet fleet{fmt::format("test{}", ++fleets), {}, 0};
    for (size_t r = 0; r < robots; ++r) fleet.robots.push_back(fmt::format("robot{}", r));
    std::vector<std::unique_ptr<Transport>> ways;
    for (uint32_t r = 0; r < robots; ++r) {
      fleet.self = r;
      auto participant = rondo::dds::Participant::Open(rondo::dds::TestNetwork());
      EXPECT_TRUE(participant.ok()) << participant.error().message;
      participants.push_back(std::move(participant).value());
      const size_t node = participants.back()->AddNode({"/" + fleet.robots[r], "rondo"});
      auto way = transport::dds::Connect(*participants.back(), node, fleet);
      EXPECT_TRUE(way.ok()) << way.error().message;
      ways.push_back(std::move(way).value());
    }
    for (uint32_t r = 0; r < robots; ++r) {
      for (uint32_t other = 0; other < robots; ++other) {
        if (other != r) Meet(*ways[r], *ways[other], other);
      }
    }
    Bytes datagram;
    for (const auto& way : ways) {
      while (way->Receive(way->Now() + 100'000'000, datagram)) {  // writers are still being made
      }
    }
    return ways;
  }
  // What is sent before two have found each other is lost, like anything else.
  static void Meet(Transport& a, Transport& b, uint32_t to) {
    Bytes datagram;
    for (int i = 0; i < 1000; ++i) {
      a.Send(kAll, Bytes{0xff});
      a.Send(to, Bytes{0xff});
      if (b.Receive(b.Now() + 10'000'000, datagram)) return;
    }
    FAIL() << "they do not find each other";
  }
  std::vector<std::unique_ptr<rondo::dds::Participant>> participants;
  int fleets = 0;
};

TEST(Drive, AFleetOfThreadsAgreesOverDds) {
  TestFleet fleet;
  const auto ways = fleet.Connect(4);
  ExpectThreadsAgree(ways);
}

TEST(Drive, SessionsOfThreadsEndOverDds) {
  TestFleet fleet;
  ExpectSessionsEnd(fleet.Connect(3));
}

}  // namespace
}  // namespace rondo::transport::dds

namespace rondo::transport {
INSTANTIATE_TYPED_TEST_SUITE_P(Dds, TransportConformance, dds::TestFleet);
}  // namespace rondo::transport
