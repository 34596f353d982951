#pragma once

#include <vector>

#include "koord/semantics/team.h"

/// Watches bounded responses along runs.
namespace rondo::koord::semantics {

/// Watches what the specification says of how soon something follows: `response NAME: P within k rounds Q`. How long each
/// robot waits is kept in words of its own, beside the state, so that an exploration can tell states by it.
class Responses {
 public:
  /// Watches the responses of the team, which must outlive it.
  explicit Responses(Team& team);

  /// Reports whether there is nothing to watch.
  bool empty() const { return words_ == 0; }
  /// Returns how many words `waits` has. All are zero before a run begins.
  size_t words() const { return words_; }
  /// Takes in the next state between rounds, the first one included. Returns the number of the first response that has
  /// waited too long; -1 if there is none.
  /// @param robot  receives who waits for it.
  int Observe(std::span<const Word> state, std::span<Word> waits, size_t* robot = nullptr);
  /// Returns the first response that `Observe` has found to have waited too long, from the words that it left; -1 if there
  /// is none.
  int Late(std::span<const Word> waits) const;
  /// Returns, by response, whether it met an operation without a value in some state; there, it was not judged.
  const std::vector<bool>& undefined() const { return undefined_; }

 private:
  Team& team_;
  size_t words_ = 0;
  std::vector<bool> undefined_;
};

}  // namespace rondo::koord::semantics
