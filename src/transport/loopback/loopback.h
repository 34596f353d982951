#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <vector>

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
  struct Mailbox {
    std::mutex mutex;
    std::condition_variable arrived;
    std::vector<runtime::codec::Bytes> ring;  // keeps its memory
    size_t first = 0, waiting = 0;
  };

  std::vector<std::unique_ptr<Mailbox>> mailboxes_;
};

}  // namespace rondo::transport::loopback
