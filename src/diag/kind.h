#pragma once

#include <cstdint>
#include <span>
#include <string_view>

/// The kinds of diagnostics, and what `rondo explain` says about each.
namespace rondo::diag {

/// Says how bad a diagnostic is. An error alone makes the input wrong.
enum class Severity : uint8_t { kError, kWarning, kNote };

/// Names every kind of diagnostic that Rondo reports. The registry holds its id, explanation and minimal
/// example; a golden case under testdata/ shows each one.
enum class Kind : uint8_t {
  // Files.
  kFileUnreadable,
  kFileKind,
  kFileMore,
  // Reading any of the languages.
  kSyntaxUnexpected,
  kSyntaxIndentation,
  kSyntaxTab,
  kSyntaxUnknownCharacter,
  kSyntaxUnterminatedString,
  kSyntaxNumber,
  kSyntaxNesting,
  kSyntaxReservedName,
  // SMT-LIB scripts.
  kSmtSyntax,
  kSmtUndeclared,
  kSmtSort,
  kSmtUnsupported,
  // Certificates.
  kCertificateRejected,
  // Robots and worlds.
  kRobotUnit,
  kRobotType,
  kRobotRange,
  kRobotMount,
  // Choreographies.
  kChoreoUndeclared,
  kChoreoDuplicate,
  kChoreoArity,
  kChoreoDuration,
  kChoreoOutOfScope,
  kChoreoSelfMessage,
  kChoreoRobotTwice,
  kChoreoRobotNowhere,
  kChoreoNotMoving,
  kChoreoGuardOwner,
  kChoreoUnreachable,
  kChoreoChoiceLabel,
  kChoreoChoiceSilent,
  kChoreoUnordered,
  kChoreoNotReady,
  kChoreoMotionAfterMotion,
  kChoreoNotInformed,
  kChoreoTwoRigid,
  kChoreoDurationOutside,
  kChoreoThreadStill,
  kChoreoThreadEndless,
  kChoreoUnguarded,
  kChoreoZeno,
  kChoreoUnmergeable,
  kChoreoCoupled,
  kChoreoEquation,
  kChoreoPrecedence,
  kChoreoImport,
  // Choreographies: proving.
  kChoreoMissing,
  kChoreoContract,
  kChoreoPrecondition,
  kChoreoCollision,
  kChoreoFootprint,
  kChoreoRegion,
  kChoreoAssumption,
  kChoreoNoAlternative,
  kChoreoPromise,
  kChoreoNotInductive,
  kChoreoNever,
  kChoreoNoRegion,
  kChoreoUnknown,
  // Processes.
  kProcessStep,
  kProcessPeer,
  kProcessLabel,
  kProcessCase,
  kProcessPayload,
  kProcessMotion,
  kProcessArgument,
  kProcessGuard,
  kProcessOpen,
  kProcessCondition,
  // Koord: names.
  kKoordUndeclared,
  kKoordDuplicate,
  kKoordUnknownType,
  kKoordUnknownMember,
  kKoordAmbiguousPort,
  kKoordUnknownFunction,
  // Koord: types.
  kKoordTypeMismatch,
  kKoordNotBoolean,
  kKoordArity,
  kKoordNotCallable,
  kKoordNotIndexable,
  kKoordArrayLength,
  kKoordUnknownSignature,
  kKoordStreamMisuse,
  // Koord: who may read and write what.
  kKoordSensorWrite,
  kKoordActuatorRead,
  kKoordAllreadOwnership,
  kKoordNotAssignable,
  kKoordLostUpdate,
  // Koord: control.
  kKoordMisplacedStatement,
  kKoordUnreachable,
  kKoordRecursion,
  kKoordNoEvent,
  kKoordSectionOrder,
  kKoordPointlessSpec,
  kKoordSpecScope,
  kKoordFallback,
  // Koord: proving.
  kKoordUnboundedLoop,
  kKoordNoInvariant,
  kKoordNotInductive,
  kKoordRefuted,
  kKoordUndefinedOperation,
  kKoordUnknown,
  kKoordContradiction,
  kKoordUnrealisable,
  kKoordNeverEnabled,
  kKoordUnusedAssumption,
  kKoordDisagreement,
  // Koord: running.
  kKoordNotExecutable,
  kKoordNotBuildable,
  kKoordNotChecked,
  kKoordNoInitialState,
  kKoordViolated,
  kKoordFault,
  kKoordSummaryBroken,
  kKoordAssumptionBroken,
  kKoordStuck,
  kKoordDeadlock,
  kKoordNeverHappened,
  // Reachability.
  kReachRefuted,
  kReachUnknown,
  // Fleets.
  kFleetSyntax,
  kFleetValue,
  kCount_,  ///< the number of kinds, and none itself
};

/// Describes one kind for people.
struct KindInfo {
  Kind kind;
  std::string_view id;  ///< what people type after `rondo explain`
  Severity severity;
  std::string_view summary;      ///< one line, for lists of kinds
  std::string_view explanation;  ///< what `rondo explain` prints: the rule, and why it is one
  std::string_view example;      ///< a program for which exactly this kind is reported
  std::string_view verb;         ///< the verb that reports it: `check`, `prove` or `solve`
};

/// Returns the entry of the registry for this kind; every kind has one.
const KindInfo& Info(Kind kind);

/// Returns the kind with this id; nullptr when no kind has it.
const KindInfo* FindKind(std::string_view id);

/// Returns the whole registry: every kind once.
std::span<const KindInfo> AllKinds();

/// Returns the word that messages begin with: `error`, `warning` or `note`.
std::string_view SeverityName(Severity severity);

}  // namespace rondo::diag
