#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <vector>

#include "base/stop.h"
#include "interval/batch.h"
#include "solve/icp/tape/tape.h"

namespace rondo::solve::icp {

/// Bounds (lower, upper) of each variable of a tape in turn.
using FlatBox = std::vector<double>;

/// A node of the tree of a search: a leaf was emptied by contraction, an inner node split `variable` at
/// `value` into its first child (at most `value`) and the next one.
struct TreeNode {
  uint32_t first_child = 0;  ///< 0: a leaf
  uint32_t variable = 0;
  double value = 0;
};

struct SearchOptions {
  unsigned jobs = 1;
  uint64_t max_boxes = UINT64_MAX;
  /// Boxes narrower than this in every variable are not split further.
  double precision = 1e-9;
  bool record_tree = false;
  base::StopToken stop;
  const interval::Kernels* kernels = nullptr;
  /// Asked, by one thread at a time, about points (one number for each variable) at which the formula looks
  /// true, and about the middles of boxes that are not split further. True: it certainly is there or nearby.
  std::function<bool(const std::vector<double>&)> verify;
};

struct SearchResult {
  enum class Kind : uint8_t { kEmpty, kPoint, kUndecided, kGaveUp };
  Kind kind = Kind::kGaveUp;
  std::vector<double> point;  ///< kPoint
  FlatBox box;                ///< kUndecided: a box in which nothing could be excluded
  uint64_t boxes = 0;
  std::vector<TreeNode> tree;  ///< of kEmpty, if it was recorded; the root first
};

/// Branch and prune: contracts boxes, eight at a time, and splits what is left at the variable with the most
/// influence. Whether the answer is kEmpty does not depend on `jobs`. Cost: exponential in the number of
/// variables at worst; polls `stop` between batches.
SearchResult Search(const Tape& tape, const SearchOptions& options);

/// The box of the tape after contraction, without splitting; nothing if that empties it.
std::optional<FlatBox> ContractRoot(const Tape& tape, const interval::Kernels& kernels);

}  // namespace rondo::solve::icp
