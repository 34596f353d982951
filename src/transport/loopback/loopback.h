#pragma once

#include <memory>
#include <vector>

#include "transport/mailbox.h"
#include "transport/transport.h"

/// Carries datagrams between the threads of one process.
namespace rondo::transport::loopback {

/// Connects robots of one process. Thread-safe; outlives its transports.
class Hub {
 public:
  /// @param robots  how many there are.
  /// @param longest  how many datagrams wait for one robot at most; the oldest give way.
  explicit Hub(size_t robots, size_t longest = 1024);

  /// Returns the way from and to one robot.
  std::unique_ptr<Transport> Connect(uint32_t robot);

 private:
  class Way;
  std::vector<std::unique_ptr<Mailbox>> mailboxes_;
};

}  // namespace rondo::transport::loopback
