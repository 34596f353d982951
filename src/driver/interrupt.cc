#include "driver/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>

namespace rondo::driver {
namespace {

// A signal handler can reach nothing but globals.
std::atomic<const base::StopToken*> current{nullptr};

extern "C" void OnInterrupt(int) {
  const base::StopToken* stop = current.load();
  if (stop == nullptr || stop->cancelled()) ::_exit(130);
  stop->RequestStop();
}

}  // namespace

InterruptScope::InterruptScope(const base::StopToken& stop) {
  current = &stop;
  struct sigaction action {};
  action.sa_handler = OnInterrupt;
  ::sigaction(SIGINT, &action, nullptr);
}

InterruptScope::~InterruptScope() {
  ::signal(SIGINT, SIG_DFL);
  current = nullptr;
}

}  // namespace rondo::driver
