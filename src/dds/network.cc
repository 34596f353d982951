#include "dds/network.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <cstring>

#include "base/xml.h"

namespace rondo::dds {
namespace {

std::string Variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

base::Error Wrong(const char* name, const std::string& value, const char* needs) {
  return {fmt::format("the variable {} is `{}`: {}", name, value, needs)};
}

}  // namespace

base::Result<Network> WithEnvironment(Network network) {
  if (const std::string domain = Variable("ROS_DOMAIN_ID"); !domain.empty()) {
    const auto [end, error] = std::from_chars(domain.data(), domain.data() + domain.size(), network.domain);
    if (error != std::errc() || end != domain.data() + domain.size() || network.domain > 232)
      return Wrong("ROS_DOMAIN_ID", domain, "it has to be a number from 0 to 232");
  }
  if (Variable("ROS_LOCALHOST_ONLY") == "1") network.profile = Profile::kLoopback;
  const std::string range = Variable("ROS_AUTOMATIC_DISCOVERY_RANGE");
  if (range == "LOCALHOST") {
    network.profile = Profile::kLoopback;
  } else if (range == "OFF") {
    return Wrong("ROS_AUTOMATIC_DISCOVERY_RANGE", range, "with this, robots do not find each other");
  } else if (range == "SUBNET") {
    if (network.profile == Profile::kLoopback) network.profile = Profile::kLan;
  } else if (!range.empty() && range != "SYSTEM_DEFAULT") {
    return Wrong("ROS_AUTOMATIC_DISCOVERY_RANGE", range, "it has to be SUBNET, LOCALHOST or SYSTEM_DEFAULT");
  }
  const std::string peers = Variable("ROS_STATIC_PEERS");
  for (size_t at = 0; at < peers.size();) {
    const size_t end = std::min(peers.find(';', at), peers.size());
    if (end > at) network.peers.push_back(peers.substr(at, end - at));
    at = end + 1;
  }
  const std::string distribution = Variable("ROS_DISTRO");
  for (const char* old : {"foxy", "galactic", "humble"}) network.old_identities |= distribution == old;
  return network;
}

std::string Configuration(const Network& network) {
  const bool loopback = network.profile == Profile::kLoopback;
  const std::string interface = loopback ? "lo" : network.interface;
  std::string general;
  if (!interface.empty())
    general = fmt::format(R"(<Interfaces><NetworkInterface name="{}"{}/></Interfaces>)",
                          base::XmlEscaped(interface), loopback ? R"( multicast="true")" : "");
  general +=
      fmt::format("<AllowMulticast>{}</AllowMulticast>", network.profile == Profile::kWifi ? "spdp" : "true");
  std::string peers;
  for (const std::string& peer : network.peers)
    peers += fmt::format(R"(<Peer Address="{}"/>)", base::XmlEscaped(peer));
  // Nodes of ROS 2 that stay on this machine look for others there at their ports, one by one.
  if (loopback) peers += R"(<Peer Address="127.0.0.1"/>)";
  // Who hears nothing asks after milliseconds, not after a hundred.
  std::string internal =
      R"(<HeartbeatInterval min="2ms" minsched="4ms" max="200ms">10ms</HeartbeatInterval><NackDelay>0ms</NackDelay>)"
      "<AckDelay>2ms</AckDelay><AutoReschedNackDelay>20ms</AutoReschedNackDelay><PreEmptiveAckDelay>2ms</PreEmptiveAckDelay>"
      // Who is killed acknowledges nothing: nobody waits for that at the end.
      "<WriterLingerDuration>100ms</WriterLingerDuration>";
  if (network.lost_in_thousand > 0)
    internal += fmt::format("<Test><XmitLossiness>{}</XmitLossiness></Test>", network.lost_in_thousand);
  return fmt::format(
      R"(<CycloneDDS><Domain Id="any"><General>{}</General>)"
      "<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>119</MaxAutoParticipantIndex>"
      "<Peers>{}</Peers></Discovery><Internal>{}</Internal></Domain></CycloneDDS>",
      general, peers, internal);
}

}  // namespace rondo::dds
