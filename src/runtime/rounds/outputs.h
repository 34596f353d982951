#pragma once

#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "runtime/codec/messages.h"
#include "runtime/rounds/settings.h"

/// What a core wants of the world, and tells it.
namespace rondo::runtime::rounds {

using codec::Bytes;
using codec::Decision;
using codec::Place;

constexpr uint32_t kAll = UINT32_MAX;

/// Asks to send a datagram to a robot, or to `kAll` others.
struct Send {
  uint32_t to;
  Bytes bytes;
};
/// Says that actuators and streams get what the program's store says when the step is over; no write may take
/// effect after `until`.
struct Act {
  Place at;
  Time until;
};
/// Says that the robot no longer acts: its fallback takes over.
struct FallBack {};
/// Tells what happened, for records and reports.
struct Contributed {
  Place at;
  Bytes payload;
};
struct Stored {
  Place at;
  uint64_t digest;
};
struct Committed {
  Place at;
};
struct Adopted {
  Decision decision;
};
/// Names what must not happen, and did; the core goes no further.
struct Broken {
  const char* what;
};
using Output = std::variant<Send, Act, FallBack, Contributed, Stored, Committed, Adopted, Broken>;

/// Collects what steps want, in order. Keeps the memory of what it held: after a while, rounds allocate nothing.
class Outputs {
 public:
  void Add(Output output) { list_.push_back(std::move(output)); }
  void Clear() {
    for (Output& output : list_) {
      if (auto* send = std::get_if<Send>(&output)) spare_.push_back(std::move(send->bytes));
      if (auto* said = std::get_if<Contributed>(&output)) payload_ = std::move(said->payload);
    }
    list_.clear();
  }
  /// Returns empty bytes, for a datagram.
  Bytes Empty() {
    if (spare_.empty()) return {};
    Bytes bytes = std::move(spare_.back());
    spare_.pop_back();
    bytes.clear();
    return bytes;
  }

  /// Returns empty bytes, for what a robot contributes: once in a step, and as large as frames get.
  Bytes EmptyPayload() {
    Bytes bytes = std::move(payload_);
    bytes.clear();
    return bytes;
  }

  auto begin() const { return list_.begin(); }
  auto end() const { return list_.end(); }
  size_t size() const { return list_.size(); }
  bool empty() const { return list_.empty(); }
  const Output& operator[](size_t i) const { return list_[i]; }

 private:
  std::vector<Output> list_;
  std::vector<Bytes> spare_;
  Bytes payload_;
};

}  // namespace rondo::runtime::rounds
