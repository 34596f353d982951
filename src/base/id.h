#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

/// Indices into arenas, with a type for each arena.
namespace rondo::base {

/// Names an object of one arena by its index. `Tag` makes ids of different arenas different types, so that
/// they cannot be mixed up. A default-constructed id names no object.
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
