#pragma once

#include <cstdint>

namespace rondo::verdict {

/// What is known of a formula at a point, or on a box of points.
enum class Truth : uint8_t {
  kFalse,  ///< it is false, everywhere on the box
  kOpen,   ///< neither is known
  kTrue,   ///< it is true and defined, everywhere on the box
};

}  // namespace rondo::verdict
