#pragma once

#include "platform/clock.h"
#include "transport/mailbox.h"
#include "transport/transport.h"

namespace rondo::deploy {

/// Is a way to the others on which time is what a clock says: a clock that stands still holds rounds, leases and repetitions
/// (docs/adr/0026).
class ClockedWay final : public transport::Transport {
 public:
  /// @param way, clock  outlive this.
  ClockedWay(transport::Transport& way, const platform::Clock& clock) : way_(way), clock_(clock) {}

  runtime::rounds::Time Now() override { return clock_.Now(); }
  void Send(uint32_t to, runtime::codec::View bytes) override { way_.Send(to, bytes); }
  // Nobody knows when a simulated clock will say what: it is looked at every few milliseconds.
  bool Receive(runtime::rounds::Time until, runtime::codec::Bytes& datagram) override {
    constexpr runtime::rounds::Time kLook = 2'000'000;
    return way_.Receive(clock_.simulated() ? transport::BootTime() + kLook : until, datagram);
  }

 private:
  transport::Transport& way_;
  const platform::Clock& clock_;
};

}  // namespace rondo::deploy
