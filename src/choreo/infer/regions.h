#pragma once

#include "choreo/obligations/obligations.h"
#include "choreo/prove/decide.h"

/// Finds the regions of threads that people would otherwise have to write by hand.
namespace rondo::choreo {

/// Holds a region that was found for one thread of a fork.
struct FoundRegion {
  diag::Span span;     ///< of the thread
  std::string robots;  ///< "`cart` and `arm`"
  std::string text;    ///< as source: `z < 0.1 m and x < 0.5 m or z > 0.2 m`
};

/// Says for which thread no region was found, and why.
struct NoRegion {
  diag::Span span;
  std::string why;
};

/// Holds what came of looking for regions.
struct Inference {
  std::vector<FoundRegion> found;
  std::vector<NoRegion> failed;
};

/// Limits the search for regions.
struct InferOptions {
  solve::icp::Options engine;
  Limits limits;
  base::StopToken stop;
  std::function<void(const std::string&)> progress;
};

/// Gives a region to each thread that has none, from the outermost fork to the innermost. Samples of what the
/// motions of each thread take up are separated by planes, one after the other, until every cell belongs to
/// one thread; motions that no plane separates are cut into pieces of time. Then every motion is proved to
/// keep to the region of its thread, and states that do not are further samples. The regions of a fork are
/// apart by construction; nothing else is taken for granted: all obligations are still to be proved.
Inference InferRegions(Graph& graph, expr::Arena& arena, const InferOptions& options);

}  // namespace rondo::choreo
