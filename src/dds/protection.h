#pragma once

struct dds_qos;

namespace rondo::dds {

struct Keys;

/// Says in the policies of a participant with which keys it takes part (DDS Security 1.1, by the plugins of Cyclone DDS).
/// Nothing if there are none.
void Protect(dds_qos* qos, const Keys& keys);

}  // namespace rondo::dds
