#pragma once

#include <vector>

#include "koord/check/model.h"
#include "koord/semantics/heap.h"

namespace rondo::koord::semantics {

/// What one word of a value means.
enum class WordKind : uint8_t { kBool, kInt, kFloat, kEnum, kHandle };

/// Where the variables of a team are. A state is a sequence of words: first what all robots may write, then
/// one block for each robot with its local variables, ports, cells and the mark that it has stopped.
class Layout {
 public:
  struct Place {
    uint32_t at = 0;      ///< in shared memory, in the block, or among the parameters
    uint32_t width = 0;   ///< words of one item
    uint32_t length = 0;  ///< of an array; 0 for anything else
    bool own = false;
    bool exists = true;  ///< false for ports that are called and for streams
  };

  /// `lengths`: by variable, items of an array (0 for others).
  Layout(const Model& model, size_t robots, const std::vector<uint32_t>& lengths);

  /// Words of a value of this type; arrays and lists are handles.
  static uint32_t Width(const lang::TypeTable& types, TypeId type);
  static void Kinds(const lang::TypeTable& types, TypeId type, std::vector<WordKind>& kinds);

  size_t robots() const { return robots_; }
  uint32_t words() const { return shared_ + static_cast<uint32_t>(robots_) * block_; }
  uint32_t shared_words() const { return shared_; }
  uint32_t block_words() const { return block_; }
  uint32_t param_words() const { return params_; }
  /// The address of robot `r`'s block.
  uint32_t block(size_t r) const { return shared_ + static_cast<uint32_t>(r) * block_; }
  uint32_t stopped() const { return stopped_; }  ///< in a block
  const Place& operator[](size_t variable) const { return places_[variable]; }
  /// The address of a variable in a state, for robot `r` if each robot has one.
  uint32_t Address(size_t variable, size_t r) const {
    return places_[variable].own ? block(r) + places_[variable].at : places_[variable].at;
  }
  /// By word of shared memory, and of a block.
  const std::vector<WordKind>& shared_kinds() const { return shared_kinds_; }
  const std::vector<WordKind>& block_kinds() const { return block_kinds_; }

 private:
  size_t robots_;
  std::vector<Place> places_;
  uint32_t shared_ = 0;
  uint32_t block_ = 0;
  uint32_t params_ = 0;
  uint32_t stopped_ = 0;
  std::vector<WordKind> shared_kinds_;
  std::vector<WordKind> block_kinds_;
};

}  // namespace rondo::koord::semantics
