#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace rondo::diag {

enum class Severity : uint8_t { kError, kWarning, kNote };

/// Every kind of diagnostic that Rondo reports. The registry holds its id, explanation and minimal example; a
/// golden case under testdata/ shows each one.
enum class Kind : uint8_t {
  // Files.
  kFileUnreadable,
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
  kCount_,  // not a kind
};

struct KindInfo {
  Kind kind;
  std::string_view id;  ///< what people type after `rondo explain`
  Severity severity;
  std::string_view summary;  ///< one line
  std::string_view explanation;
  std::string_view example;  ///< a program for which exactly this kind is reported
  std::string_view verb;     ///< the verb that reports it: `check`, `prove` or `solve`
};

const KindInfo& Info(Kind kind);

/// nullptr when no kind has this id.
const KindInfo* FindKind(std::string_view id);

std::span<const KindInfo> AllKinds();

std::string_view SeverityName(Severity severity);

}  // namespace rondo::diag
