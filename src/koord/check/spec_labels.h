#pragma once

#include <string>

#include "koord/check/model.h"

/// What reports call the parts of a specification, and what all engines must agree on about them.
namespace rondo::koord {

std::string InvariantName(const Model& model, size_t i);
/// Unnamed assumptions about one module are told apart by their order.
std::string AssumptionName(const Model& model, const AssumeDef& def);
std::string SummaryName(const SummaryDef& def);

/// Is there arithmetic on floats or points? Proofs compute with real numbers, robots with doubles.
bool UsesFloatArithmetic(const Model& model);

/// Can some robot `stop`?
bool RobotsStop(const Model& model);

/// Does it contain `old(...)`?
bool UsesOld(const Model& model, ExprId e);
/// A controller assumption that must hold at every moment, not only as the consequence of a condition.
bool HoldsAlways(const Model& model, const AssumeDef& def);

}  // namespace rondo::koord
