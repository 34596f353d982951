#include "dds/sockets.h"

#include <sys/socket.h>
#include <sys/time.h>

#include <cstdlib>
#include <filesystem>

namespace rondo::dds {

std::set<int> DatagramSockets() {
  std::set<int> sockets;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", ignored)) {
    const int fd = std::atoi(entry.path().filename().c_str());
    int type = 0;
    socklen_t size = sizeof(type);
    if (::getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &size) == 0 && type == SOCK_DGRAM) sockets.insert(fd);
  }
  return sockets;
}

void LimitSending(const std::set<int>& but) {
  const timeval limit{0, 1000};
  for (const int fd : DatagramSockets()) {
    if (!but.contains(fd)) ::setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof(limit));
  }
}

}  // namespace rondo::dds
