#pragma once

#include <cstdint>

namespace rondo::choreo {

enum class Verdict : uint8_t { kProved, kRefuted, kUnknown };

}  // namespace rondo::choreo
