#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <sys/resource.h>
#include <sys/timex.h>

#include <fstream>
#include <set>

#include "dds/participant.h"
#include "deploy/doctor.h"

namespace rondo::deploy {
namespace {

// Networks that are up, by name.
std::set<std::string> Interfaces() {
  std::set<std::string> names;
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) return names;
  for (const ifaddrs* i = list; i != nullptr; i = i->ifa_next) {
    if ((i->ifa_flags & IFF_UP) != 0 && i->ifa_addr != nullptr && i->ifa_addr->sa_family == AF_INET)
      names.insert(i->ifa_name);
  }
  ::freeifaddrs(list);
  return names;
}

}  // namespace

std::vector<Trouble> ExamineMachine(const dds::Network& network) {
  std::vector<Trouble> troubles;
  const auto names = Interfaces();
  if (!names.contains("lo"))
    troubles.push_back({true, "", "the loopback network is down", "`ip link set lo up`"});
  if (names.size() < 2)
    troubles.push_back({false, "", "there is no network but the one of this machine",
                        "robots on other machines cannot be reached"});
  if (const auto participant = dds::Participant::Open(network); !participant.ok())
    troubles.push_back({true, "", participant.error().message,
                        "ROS_DOMAIN_ID, and `[ros]` in the fleet file, say which network is used"});
  timex clock{};
  if (::adjtimex(&clock) == TIME_ERROR || (clock.status & STA_UNSYNC) != 0)
    troubles.push_back(
        {false, "", "the clock is not synchronised",
         "rounds do not need it; stamps of sensors and logs of several machines do: install chrony"});
  std::ifstream file("/proc/sys/net/core/rmem_max");
  if (long bytes = 0; file >> bytes && bytes < 1'000'000)
    troubles.push_back({false, "",
                        fmt::format("the kernel keeps {} kB of what arrives at most", bytes / 1000),
                        "large scans and maps may get lost: `sysctl -w net.core.rmem_max=4194304`"});
  rlimit limit{};
  if (::getrlimit(RLIMIT_RTPRIO, &limit) == 0 && limit.rlim_cur == 0)
    troubles.push_back(
        {false, "", "processes of this user get no real-time priority",
         "short rounds may be late under load: `@robots - rtprio 50` in /etc/security/limits.conf"});
  return troubles;
}

}  // namespace rondo::deploy
