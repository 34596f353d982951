#include "security/rules.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "base/xml.h"

namespace rondo::security {
namespace {

constexpr long kDay = 24L * 3600;

std::string Topics(const char* what, const std::vector<std::string>& topics) {
  if (topics.empty()) return {};
  std::string text = fmt::format("        <{}>\n          <topics>\n", what);
  for (const std::string& topic : topics)
    text += fmt::format("            <topic>{}</topic>\n", base::XmlEscaped(topic));
  return text + fmt::format("          </topics>\n        </{}>\n", what);
}

std::string Day(long seconds) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}", fmt::gmtime(std::time_t{seconds}));
}

}  // namespace

std::string Governance() {
  return R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_governance.xsd">
  <domain_access_rules>
    <domain_rule>
      <domains>
        <id_range>
          <min>0</min>
          <max>230</max>
        </id_range>
      </domains>
      <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
      <enable_join_access_control>true</enable_join_access_control>
      <discovery_protection_kind>ENCRYPT</discovery_protection_kind>
      <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
      <rtps_protection_kind>SIGN</rtps_protection_kind>
      <topic_access_rules>
        <topic_rule>
          <topic_expression>*</topic_expression>
          <enable_discovery_protection>true</enable_discovery_protection>
          <enable_liveliness_protection>true</enable_liveliness_protection>
          <enable_read_access_control>true</enable_read_access_control>
          <enable_write_access_control>true</enable_write_access_control>
          <metadata_protection_kind>ENCRYPT</metadata_protection_kind>
          <data_protection_kind>ENCRYPT</data_protection_kind>
        </topic_rule>
      </topic_access_rules>
    </domain_rule>
  </domain_access_rules>
</dds>
)";
}

std::string Permissions(const Enclave& enclave, long now) {
  const std::string name = base::XmlEscaped(enclave.name);
  return fmt::format(
      R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_permissions.xsd">
  <permissions>
    <grant name="{0}">
      <subject_name>CN={0}</subject_name>
      <validity>
        <not_before>{1}</not_before>
        <not_after>{2}</not_after>
      </validity>
      <allow_rule>
        <domains>
          <id_range>
            <min>0</min>
            <max>230</max>
          </id_range>
        </domains>
{3}{4}      </allow_rule>
      <default>DENY</default>
    </grant>
  </permissions>
</dds>
)",
      name, Day(now - kDay), Day(now + 3650 * kDay), Topics("publish", enclave.publishes),
      Topics("subscribe", enclave.subscribes));
}

}  // namespace rondo::security
