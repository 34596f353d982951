#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>

#include "lsp/frames.h"
#include "lsp/server.h"

namespace rondo::lsp {

namespace {

// False if the other side went away.
bool Send(int out, const std::string& bytes) {
  for (size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::write(out, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    done += static_cast<size_t>(count);
  }
  return true;
}

}  // namespace

int Serve(int in, int out, const std::string& executable) {
  Server server(executable);
  FrameReader reader;
  const auto flush = [&] {
    for (const std::string& message : server.TakeMessages()) {
      if (!Send(out, Framed(message))) return false;
    }
    return true;
  };
  bool settled = true;
  while (true) {
    std::array<pollfd, 2> wanted{{{in, POLLIN, 0}, {server.descriptor(), POLLIN, 0}}};
    const int ready = ::poll(wanted.data(), wanted.size(), settled ? -1 : 0);
    if (ready < 0 && errno != EINTR) return 1;
    if (ready == 0) {
      // Nobody says anything for now.
      server.Settle();
      settled = true;
      if (!flush()) return 1;
      continue;
    }
    if (wanted[1].revents != 0) server.Proofs();
    if (wanted[0].revents != 0) {
      std::array<char, 65536> bytes{};
      const ssize_t count = ::read(in, bytes.data(), bytes.size());
      if (count == 0) return 1;
      if (count > 0) reader.Add({bytes.data(), static_cast<size_t>(count)});
      while (const auto message = reader.Next()) {
        server.Hear(*message);
        settled = false;
        if (server.exits()) return flush() ? *server.exits() : 1;
      }
      if (reader.broken()) return 1;
    }
    if (!flush()) return 1;
  }
}

}  // namespace rondo::lsp
