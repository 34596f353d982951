#pragma once

#include <optional>
#include <vector>

#include "runtime/rounds/program.h"

/// Makes one round out of what each robot wants to do.
namespace rondo::runtime::rounds {

/// Is a frame without its header: what one robot contributes to a round.
struct Contribution {
  View inputs;
  std::vector<Alternative> alternatives;  ///< the one that it would like best comes first
};

constexpr size_t kMostAlternatives = 4096;

/// Writes and reads contributions. What was read points into the bytes; nothing if they are malformed.
void Encode(const Contribution& contribution, Bytes& out);
std::optional<Contribution> Decode(View bytes);

/// Gives every robot its turn: the order begins with another robot in each round, and who comes first gets
/// the lock of an event. So one order of the robots explains all locks, and all writes if they are applied in
/// this order; and who wants a lock in every round waits for as many rounds as there are robots at most.
/// @param robots  who takes part, in increasing order; `contributions` are theirs, and must outlive the turns.
std::vector<Turn> Merge(uint64_t round, std::span<const uint32_t> robots,
                        std::span<const Contribution> contributions);

}  // namespace rondo::runtime::rounds
