#pragma once

#include <cstdint>

/// Three-valued truth, for evaluation that may not decide.
namespace rondo::verdict {

/// Says what is known of a formula at a point, or on a box of points.
enum class Truth : uint8_t {
  kFalse,  ///< it is false, everywhere on the box
  kOpen,   ///< neither is known: it may be false at some points and true at others
  kTrue,   ///< it is true and defined, everywhere on the box
};

}  // namespace rondo::verdict
