#include "diag/registry_tables.h"

// Two robots and what they agreed on, for the examples.
#define PAIR                                                                                       \
  "robot R {\n  state x : length in [-1 m, 1 m]\n  motion Idle() interruptible [0 s, inf) {}\n"    \
  "  motion Go(d : length) noninterruptible [2 s, 2 s] { modifies x }\n}\nworld W { a: R b: R }\n" \
  "choreography C in W {\n  { a: Go(1 m), b: Idle() }\n  a -> b: done(weight: number)\n}\n"

namespace rondo::diag {
namespace {

constexpr KindInfo kTable[] = {
    {Kind::kProcessStep, "process-step", Severity::kError, "a step that the choreography does not allow",
     "A process does what its robot's projection says, in that order: `rondo project FILE ROBOT` shows it. Assignments are to\n"
     "names of the process, not to the state of the robot.",
     PAIR "process a in C { send b.done(1) }\n", "check"},
    {Kind::kProcessPeer, "process-peer", Severity::kError, "a message to or from the wrong robot",
     "The label is right, but the choreography has another sender or receiver.",
     PAIR "process b in C { receive from b while Idle() { done(w) => exit } }\n", "check"},
    {Kind::kProcessLabel, "process-label", Severity::kError, "a message with the wrong label",
     "The receiver waits for another label, and would never get on.",
     PAIR "process a in C { Go(1 m) send b.finished(1) }\n", "check"},
    {Kind::kProcessCase, "process-case", Severity::kError, "a message that a process does not listen for",
     "Whatever may come next in the choreography needs a case. More cases than that do no harm: they never happen.",
     PAIR "process b in C { receive from a while Idle() { more(w) => exit } }\n", "check"},
    {Kind::kProcessPayload, "process-payload", Severity::kError, "a message with the wrong contents",
     "What is sent has the number, the kinds and the dimensions that the choreography says, and is what it promises; what\n"
     "arrives is named accordingly.",
     PAIR "process a in C { Go(1 m) send b.done(1 m) }\n", "check"},
    {Kind::kProcessMotion, "process-motion", Severity::kError,
     "another motion than the choreography asks for",
     "A process does the motion of the choreography, or one that refines it: that can be interrupted if that one can, takes a\n"
     "time that fits, needs no more, promises no less, and takes no more space.",
     PAIR "process a in C { Idle() send b.done(1) }\n", "check"},
    {Kind::kProcessArgument, "process-argument", Severity::kError, "a motion with another argument",
     "The obligations of the choreography are proved for the arguments that it states, so that a process has to use them.",
     PAIR "process a in C { Go(2 m) send b.done(1) }\n", "check"},
    {Kind::kProcessGuard, "process-guard", Severity::kError, "an alternative that is not offered",
     "Where a robot chooses, its process goes on like one of the alternatives of the choreography, and only where its guard\n"
     "allows it.",
     "robot R {\n"
     "  state x : length in [-1 m, 1 m]\n"
     "}\n"
     "world W { a: R b: R }\n"
     "choreography C in W {\n"
     "  choose at a {\n"
     "    when a.x > 0 { a -> b: left() }\n"
     "    when a.x <= 0 { a -> b: right() }\n"
     "  }\n"
     "}\n"
     "process a in C { send b.middle() }\n",
     "check"},
    {Kind::kProcessOpen, "process-open", Severity::kNote, "a condition on a process that needs a solver",
     "The steps of the process are those of the choreography, if this condition holds wherever the robot may be then. Nothing\n"
     "is wrong so far, and nothing is proved.",
     "robot R {\n"
     "  state x : length in [-1 m, 1 m]\n"
     "}\n"
     "world W { a: R b: R }\n"
     "choreography C in W {\n"
     "  choose at a {\n"
     "    when a.x > 0 { a -> b: left() }\n"
     "    when a.x <= 0 { a -> b: right() }\n"
     "  }\n"
     "}\n"
     "process a in C { send b.left() }\n",
     "check"},
    {Kind::kProcessCondition, "process-condition", Severity::kError, "a process that may deviate",
     "The steps of the process are those of the choreography, but a guard, an argument or a value that it sends may be\n"
     "another one than the choreography has there. `rondo prove` found a state in which it is.",
     "robot R {\n"
     "  state x : length in [-1 m, 1 m]\n"
     "  body sphere(self * translate(x, 0, 0), 1 cm)\n"
     "}\n"
     "world W { a: R b: R at (3 m, 0, 0) }\n"
     "choreography C in W {\n"
     "  choose at a {\n"
     "    when a.x > 0 { a -> b: left() }\n"
     "    when a.x <= 0 { a -> b: right() }\n"
     "  }\n"
     "}\n"
     "process a in C { send b.left() }\n",
     "prove"},
};

}  // namespace

std::span<const KindInfo> ProcessKinds() { return kTable; }

}  // namespace rondo::diag

#undef PAIR
