#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <vector>

#include "base/stop.h"
#include "interval/batch.h"
#include "solve/icp/tape/tape.h"

/// Branch and prune over boxes: the search of the interval solver.
namespace rondo::solve::icp {

/// Holds bounds (lower, upper) of each variable of a tape in turn.
using FlatBox = std::vector<double>;

/// Is a node of the tree of a search: a leaf was emptied by contraction, an inner node split `variable` at
/// `value` into its first child (at most `value`) and the next one (at least `value`).
struct TreeNode {
  uint32_t first_child = 0;  ///< 0: a leaf
  uint32_t variable = 0;     ///< its index in the tape
  double value = 0;
};

/// Says how to search, and for how long.
struct SearchOptions {
  unsigned jobs = 1;
  uint64_t max_boxes = UINT64_MAX;  ///< how many boxes may be looked at
  /// Boxes narrower than this in every variable are not split further.
  double precision = 1e-9;
  bool record_tree = false;  ///< whether the tree is kept, for a certificate
  base::StopToken stop;
  const interval::Kernels* kernels = nullptr;  ///< must be given
  /// Is asked, by one thread at a time, about points (one number for each variable) at which the formula
  /// looks true, and about the middles of boxes that are not split further. Returns true if it certainly is
  /// there or nearby.
  std::function<bool(const std::vector<double>&)> verify;
};

/// Tells what a search found.
struct SearchResult {
  /// Says how the search ended: no box holds a solution; `verify` accepted a point; a box is too narrow to be
  /// split further; or it gave up, for `max_boxes` or `stop`.
  enum class Kind : uint8_t { kEmpty, kPoint, kUndecided, kGaveUp };
  Kind kind = Kind::kGaveUp;
  std::vector<double> point;  ///< kPoint
  FlatBox box;                ///< kUndecided: a box in which nothing could be excluded
  uint64_t boxes = 0;
  std::vector<TreeNode> tree;  ///< of kEmpty, if it was recorded; the root first
};

/// Searches for a solution by branch and prune: contracts boxes, eight at a time, and splits what is left at
/// the variable with the most influence. Whether the answer is kEmpty does not depend on `jobs`. Cost:
/// exponential in the number of variables at worst; polls `stop` between batches.
SearchResult Search(const Tape& tape, const SearchOptions& options);

/// Returns the box of the tape after contraction, without splitting; nothing if that empties it.
std::optional<FlatBox> ContractRoot(const Tape& tape, const interval::Kernels& kernels);

}  // namespace rondo::solve::icp
