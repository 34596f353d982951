// After robots have got to know each other, who runs the rounds takes no memory from the system to send and to receive.
#include <gtest/gtest.h>

#include <thread>

#include "counted_allocations.h"
#include "dds/domain_test.h"
#include "transport/dds/way.h"

namespace rondo::transport::dds {
namespace {

using runtime::codec::Bytes;
using runtime::rounds::kAll;

TEST(DdsAllocations, SendingAndReceivingTakesNoMemory) {
  Fleet fleet{"allocations", {"a", "b"}, 0};
  const auto one = rondo::dds::Participant::Open(rondo::dds::TestNetwork());
  const auto two = rondo::dds::Participant::Open(rondo::dds::TestNetwork());
  ASSERT_TRUE(one.ok() && two.ok());
  auto a = Connect(*one.value(), one.value()->AddNode({"/a", "rondo"}), fleet);
  fleet.self = 1;
  auto b = Connect(*two.value(), two.value()->AddNode({"/b", "rondo"}), fleet);
  ASSERT_TRUE(a.ok() && b.ok());
  Transport& here = *a.value();
  Transport& there = *b.value();
  const Bytes large(1200, 7), small(40, 8);
  Bytes datagram;
  size_t received = 0;
  const auto exchange = [&](int times) {
    for (int i = 0; i < times; ++i) {
      here.Send(kAll, large);
      here.Send(1, small);
      while (there.Receive(there.Now() + 2'000'000, datagram)) ++received;
    }
  };
  // They find each other, writers are made, and each place of a mailbox had a large datagram: memory moves on by a place with
  // each that is taken.
  exchange(1200);
  received = 0;
  counting = true;
  exchange(100);
  counting = false;
  EXPECT_EQ(allocations, 0U);
  EXPECT_GT(received, 100U);
}

}  // namespace
}  // namespace rondo::transport::dds
