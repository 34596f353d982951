#pragma once

#include <cstddef>
#include <functional>

/// The one way in which independent pieces of work share the cores of the machine.
namespace rondo::base {

/// Runs `work(i)` for each i in [0, count) on at most `jobs` threads (0: as many as the machine has cores)
/// and returns when all have ended. Items start in order; `work` must be safe to run concurrently with itself
/// and not throw.
void ParallelFor(size_t count, unsigned jobs, const std::function<void(size_t)>& work);

}  // namespace rondo::base
