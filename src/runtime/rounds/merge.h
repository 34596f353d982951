#pragma once

#include <vector>

#include "runtime/rounds/parts.h"
#include "runtime/rounds/program.h"

/// Makes one round out of what each robot wants to do.
namespace rondo::runtime::rounds {

/// Is a frame without its header: what one robot contributes to a round.
struct Contribution {
  View inputs;
  std::vector<Alternative> alternatives;  ///< the one that it would like best comes first
};

constexpr size_t kMostAlternatives = 4096;

/// Writes and reads contributions. What was read points into the bytes; returns false, with part of it in
/// `contribution`, if they are malformed.
void Encode(const Contribution& contribution, Bytes& out);
bool Decode(View bytes, Contribution& contribution);

/// Gives every robot its turn, in the order that `locks` says; who comes first gets the lock of an event. So one order
/// of the robots explains all locks, and all writes if they are applied in this order.
/// @param robots  who takes part, in increasing order; `contributions` are theirs, and must outlive the turns.
/// @param turns  gets one for each robot, in place of what it held.
void Merge(uint64_t round, const Locks& locks, std::span<const uint32_t> robots,
           std::span<const Contribution> contributions, std::vector<Turn>& turns);

}  // namespace rondo::runtime::rounds
