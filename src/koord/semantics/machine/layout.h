#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "koord/check/model.h"
#include "koord/semantics/machine/heap.h"

/// Fixes where each variable of a team lies in the words of a state.
namespace rondo::koord::semantics {

/// Names what one word of a value means.
enum class WordKind : uint8_t { kBool, kInt, kFloat, kEnum, kHandle };

/// Gives the length of arrays, by the text that types have for it (such as `N_sys`).
using Lengths = std::map<std::string, uint32_t>;

/// Says where the variables of a team are. A state is a sequence of words: first what all robots may write,
/// then one block for each robot with its local variables, ports, cells and the mark that it has stopped.
/// Parameters are kept apart from states.
class Layout {
 public:
  /// Says where one variable lies, and in which form.
  struct Place {
    uint32_t at = 0;                   ///< where in shared memory, the block, or the parameters
    uint32_t width = 0;                ///< the words of one innermost item, or of the variable
    uint32_t length = 0;               ///< how many innermost items an array has; 0 for anything else
    std::vector<uint32_t> dimensions;  ///< of an array: the length of each level, the outer one first
    TypeId item;                       ///< the type of an item, or of the variable
    bool own = false;
    bool exists = true;  ///< false for ports that are called and for streams, which have no words

    uint32_t words() const { return exists ? width * std::max<uint32_t>(1, length) : 0; }
  };

  /// Lays out the variables of `model` for `robots` robots. Arrays of variables lie flat, item by item,
  /// arrays of arrays too; arrays inside records and lists are handles.
  /// @param lengths  by the text of a type's length; arrays of other lengths are handles.
  Layout(const Model& model, size_t robots, const Lengths& lengths);

  /// Returns how many words a value of this type has; arrays, lists and texts are one handle each.
  static uint32_t Width(const lang::TypeTable& types, TypeId type);
  /// Appends the type of each word of a value of this type: records and tuples are taken apart.
  static void Parts(const lang::TypeTable& types, TypeId type, std::vector<TypeId>& parts);
  /// Returns what a word of such a type means, and appends that for each word of a value of any type.
  static WordKind Kind(const lang::TypeTable& types, TypeId part);
  static void Kinds(const lang::TypeTable& types, TypeId type, std::vector<WordKind>& kinds);

  size_t robots() const { return robots_; }
  uint32_t words() const { return shared_ + static_cast<uint32_t>(robots_) * block_; }
  uint32_t shared_words() const { return shared_; }
  uint32_t block_words() const { return block_; }
  uint32_t param_words() const { return params_; }
  /// Returns the address of the block of robot `r` in a state.
  uint32_t block(size_t r) const { return shared_ + static_cast<uint32_t>(r) * block_; }
  uint32_t stopped() const { return stopped_; }  ///< where in a block the mark is that the robot has stopped
  const Place& operator[](size_t variable) const { return places_[variable]; }
  /// Returns the address of a variable in a state: that of robot `r`, if each robot has one.
  uint32_t Address(size_t variable, size_t r) const {
    return places_[variable].own ? block(r) + places_[variable].at : places_[variable].at;
  }
  /// Says what one word of a state is.
  struct Slot {
    WordKind kind;
    TypeId type;  ///< of a handle: the list, text, array or value that it stands for
  };
  /// Returns what each word of shared memory is, and of a block.
  const std::vector<Slot>& shared_slots() const { return shared_slots_; }
  const std::vector<Slot>& block_slots() const { return block_slots_; }

 private:
  size_t robots_;
  std::vector<Place> places_;
  uint32_t shared_ = 0;
  uint32_t block_ = 0;
  uint32_t params_ = 0;
  uint32_t stopped_ = 0;
  std::vector<Slot> shared_slots_;
  std::vector<Slot> block_slots_;
};

}  // namespace rondo::koord::semantics
