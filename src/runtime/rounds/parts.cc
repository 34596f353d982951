#include "runtime/rounds/parts.h"

namespace rondo::runtime::rounds {
namespace {

using codec::Member;
using Members = std::span<const Member>;

class Everybody final : public SharedMemory, public Barrier {
 public:
  std::optional<uint32_t> Collector(uint64_t, Members) const override { return std::nullopt; }
  bool AsksOthers() const override { return true; }
  std::optional<uint32_t> Counter(uint64_t, Members) const override { return std::nullopt; }
};

// The same robot collects and counts.
class OverOne : public SharedMemory, public Barrier {
 public:
  std::optional<uint32_t> Counter(uint64_t epoch, Members members) const final {
    return Collector(epoch, members);
  }
};

class Sequencer final : public OverOne {
 public:
  std::optional<uint32_t> Collector(uint64_t epoch, Members members) const override {
    return members[epoch % members.size()].robot;
  }
  bool AsksOthers() const override { return true; }
};

class Server final : public OverOne {
 public:
  std::optional<uint32_t> Collector(uint64_t, Members members) const override { return members[0].robot; }
  bool AsksOthers() const override { return false; }
};

// Who wants a lock in every round waits for as many rounds as there are robots, at most.
class Rotation final : public Locks {
 public:
  size_t Who(uint64_t round, size_t turn, size_t members) const override { return (round + turn) % members; }
};

}  // namespace

std::string_view Name(Exchange exchange) {
  switch (exchange) {
    case Exchange::kAllToAll:
      return "all-to-all";
    case Exchange::kSequencer:
      return "sequencer";
    case Exchange::kCentral:
      return "central";
  }
  return "";
}

Parts PartsOf(Exchange exchange) {
  static const Everybody everybody;
  static const Sequencer sequencer;
  static const Server server;
  static const Rotation rotation;
  switch (exchange) {
    case Exchange::kSequencer:
      return {&sequencer, &rotation, &sequencer};
    case Exchange::kCentral:
      return {&server, &rotation, &server};
    case Exchange::kAllToAll:
      break;
  }
  return {&everybody, &rotation, &everybody};
}

}  // namespace rondo::runtime::rounds
