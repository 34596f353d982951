#pragma once

#include <cstdint>

/// Qualities of service, with the names that ROS 2 gives them.
namespace rondo::ros {

/// Says how the messages of a topic travel. Nobody hears a reliable reader's writer that is not, nor a transient reader's
/// that is volatile.
struct Qos {
  bool reliable = true;          ///< what is lost is sent again
  bool transient_local = false;  ///< who comes late gets the last ones
  uint32_t depth = 10;           ///< how many are kept; 0: all
  uint32_t lifespan = 0;         ///< seconds after which a message is dropped; 0: never
};

inline constexpr Qos kDefault{};
inline constexpr Qos kSensorData{.reliable = false, .depth = 5};
inline constexpr Qos kLatched{.transient_local = true,
                              .depth = 1};  ///< maps, descriptions, static transforms
inline constexpr Qos kTransforms{.depth = 100};
inline constexpr Qos kLog{.transient_local = true, .depth = 1000, .lifespan = 10};

}  // namespace rondo::ros
