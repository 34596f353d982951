#pragma once

#include <span>

#include "diag/kind.h"

/// The tables that make up the registry of kinds, one for each family; `registry.cc` joins them and insists
/// that no kind is missing. Whoever adds a kind adds its entry to one of these.
namespace rondo::diag {

/// Return the kinds of one family each, with their explanations and examples.
std::span<const KindInfo> FileKinds();
std::span<const KindInfo> SyntaxKinds();
std::span<const KindInfo> SmtKinds();
std::span<const KindInfo> RobotKinds();
std::span<const KindInfo> ChoreoKinds();
std::span<const KindInfo> ChoreoProofKinds();
std::span<const KindInfo> ProcessKinds();
std::span<const KindInfo> KoordNameKinds();
std::span<const KindInfo> KoordTypeKinds();
std::span<const KindInfo> KoordControlKinds();
std::span<const KindInfo> KoordProofKinds();
std::span<const KindInfo> KoordRunKinds();
std::span<const KindInfo> ReachKinds();

}  // namespace rondo::diag
