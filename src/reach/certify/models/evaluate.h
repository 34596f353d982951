#pragma once

#include "reach/certify/models/linearise.h"
#include "reach/certify/models/model.h"

/// Programs evaluated with Taylor models.
namespace rondo::reach::certify {

/// Returns models of all nodes of the program, for variables in `box`. Each holds the function at every
/// symbol and time, whatever the variables are within their models.
///
/// @param variables  models of them.
/// @param on  the program on a box that holds whatever the variables are.
/// @param lower  what this was at the limit of t's powers before, if there are no kinks: then polynomials are
/// found fast, but errors are not bounded.
/// @return nothing if a function is not defined on all of it.
std::optional<std::vector<Model>> Evaluate(const Program& program, const Algebra& algebra,
                                           const std::vector<Model>& variables, const OnBox& on,
                                           const std::vector<Model>* lower = nullptr);

/// Encloses the values of each model over all symbols and times.
std::vector<Interval> RangesOf(const Algebra& algebra, const std::vector<Model>& models);

}  // namespace rondo::reach::certify
