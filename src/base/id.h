#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace rondo::base {

/// An index into one arena, typed by `Tag` so that ids of different arenas cannot be mixed up. Default: no
/// object.
template <typename Tag>
struct Id {
  static constexpr uint32_t kNone = 0xffffffffu;
  uint32_t value = kNone;

  constexpr Id() = default;
  constexpr explicit Id(size_t index) : value(static_cast<uint32_t>(index)) {}
  constexpr bool valid() const { return value != kNone; }
  constexpr size_t index() const { return value; }
  friend constexpr bool operator==(Id, Id) = default;
  friend constexpr auto operator<=>(Id, Id) = default;
};

}  // namespace rondo::base

template <typename Tag>
struct std::hash<rondo::base::Id<Tag>> {
  size_t operator()(rondo::base::Id<Tag> id) const noexcept { return id.value; }
};
