#pragma once

#include <string>

#include "koord/check/model.h"

/// Names the parts of a specification as reports call them, and decides what all engines must agree on about
/// them.
namespace rondo::koord {

/// Returns the name of invariant `i`, or what stands for it if it has none.
std::string InvariantName(const Model& model, size_t i);
/// Returns the name of an assumption. Unnamed assumptions about one module are told apart by their order.
std::string AssumptionName(const Model& model, const AssumeDef& def);
/// Returns what reports call a summary.
std::string SummaryName(const SummaryDef& def);

/// Reports whether there is arithmetic on floats or points. Proofs compute with real numbers, robots with
/// doubles.
bool UsesFloatArithmetic(const Model& model);

/// Reports whether some robot can execute `stop`.
bool RobotsStop(const Model& model);

/// Reports whether the expression contains `old(...)`.
bool UsesOld(const Model& model, ExprId e);
/// Reports whether a controller assumption must hold at every moment by itself, not only as the consequence
/// of a condition (`when`) or in comparison with the past (`old`).
bool HoldsAlways(const Model& model, const AssumeDef& def);

}  // namespace rondo::koord
