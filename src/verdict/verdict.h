#pragma once

#include <cstdint>
#include <string_view>

/// The one vocabulary of outcomes: what provers, checkers, explorers and simulators say, and what the process
/// says of it by its exit status.
namespace rondo::verdict {

/// Says what became of a claim: an invariant, an obligation, a contract, a whole file. From best to worst.
enum class Verdict : uint8_t {
  kProved,        ///< it holds
  kConditional,   ///< it holds if something holds that is not proved
  kUnknown,       ///< neither proved nor refuted
  kNotInductive,  ///< a step from a state that satisfies every invariant breaks it; perhaps no run comes
                  ///< there
  kRefuted,       ///< a run breaks it
};

/// Returns the word that people and JSON see: `proved`, `conditional`, `unknown`, `not inductive`, `refuted`.
std::string_view Name(Verdict verdict);

/// Returns the worse of two verdicts: that of a conjunction of claims, since verdicts are ordered from best
/// to worst.
constexpr Verdict Worse(Verdict a, Verdict b) { return a < b ? b : a; }

/// Reports whether the verdict is against the claim: kNotInductive or kRefuted.
constexpr bool Fails(Verdict v) { return v >= Verdict::kNotInductive; }

/// Says why a search ended without an answer.
enum class Shortfall : uint8_t {
  kMethod,       ///< its method decides no more, however long it takes
  kTime,         ///< the time allowed for it is over
  kInterrupted,  ///< somebody asked it to stop
};

/// Lists the exit statuses of the process, the same for every verb.
enum class ExitStatus : uint8_t {
  kEstablished = 0,  ///< everything that was asked for is established
  kRejected = 1,     ///< the input is wrong, or a property is refuted or not inductive
  kUsage = 2,        ///< the command line is wrong
  kUndecided = 3,    ///< something is unknown
  kBug = 4,          ///< a bug of ours: engines disagree, a certificate is rejected
};

/// Returns the status of a process that was asked for one claim, and has this verdict.
ExitStatus StatusOf(Verdict verdict);

/// Returns the status of a process that did both things. From best to worst: established, unknown, rejected,
/// usage, bug.
ExitStatus Worse(ExitStatus a, ExitStatus b);

}  // namespace rondo::verdict
