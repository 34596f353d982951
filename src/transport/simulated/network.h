#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <vector>

/// A radio in virtual time, with the faults of one.
namespace rondo::transport::simulated {

using Time = int64_t;  ///< nanoseconds of virtual time

/// Says what becomes of datagrams.
struct Conditions {
  double loss = 0;        ///< the share that is lost
  double duplicate = 0;   ///< the share of the others that comes twice
  double corrupt = 0;     ///< the share in which a bit is turned
  Time least = 500'000;   ///< the time on the way is chosen evenly from here
  Time most = 1'500'000;  ///< to here, for each alone: datagrams overtake each other
};

/// Is a datagram that will arrive.
struct Delivery {
  Time at = 0;
  uint32_t from = 0, to = 0;
  std::vector<uint8_t> bytes;
};

/// Decides which datagrams arrive, when, and in which shape. The same seed and the same calls give the same
/// deliveries.
class Network {
 public:
  Network(size_t robots, uint64_t seed);

  Conditions conditions;
  /// Cuts the way from one robot to another, or mends it. Cuts add up: each has to be mended.
  void Cut(uint32_t from, uint32_t to);
  void Mend(uint32_t from, uint32_t to);

  /// Sends a datagram to one robot; appends what will arrive of it.
  void Send(Time now, uint32_t from, uint32_t to, std::span<const uint8_t> bytes, std::vector<Delivery>& out);
  uint64_t sent() const { return sent_; }
  uint64_t bytes() const { return bytes_; }

 private:
  double Share();

  size_t robots_;
  std::mt19937_64 random_;
  std::vector<uint32_t> cuts_;
  uint64_t sent_ = 0, bytes_ = 0;
};

}  // namespace rondo::transport::simulated
