#pragma once

#include "koord/node/slow_calls.h"
#include "koord/semantics/team.h"

/// Computes external functions where no world is simulated.
namespace rondo::sim::campaign {

/// Gives every external function some value of its type: the same for the same arguments, whatever the heap
/// that they are in. Nothing is known of it but that; what robots write to streams is dropped.
class AnyFunctions final : public koord::semantics::Host {
 public:
  explicit AnyFunctions(koord::semantics::Team& team) : team_(team) {}

  koord::semantics::Answer Call(size_t f, size_t robot, std::span<const koord::semantics::Word> arguments,
                                std::span<koord::semantics::Word> result) override;
  void Log(size_t, size_t, std::span<const koord::semantics::Word>) override {}

 private:
  void Make(lang::TypeId type, uint64_t& random, std::vector<koord::semantics::Word>& words, int level);

  koord::semantics::Team& team_;
};

}  // namespace rondo::sim::campaign
