#include "diag/registry_tables.h"

// Two robots of one type, for the examples.
#define TEAM                                       \
  "robot R {\n"                                    \
  "  state x : length in [-1 m, 1 m]\n"            \
  "  motion Idle() interruptible [0 s, inf) {}\n"  \
  "  motion Go() noninterruptible [2 s, 2 s] {}\n" \
  "}\n"                                            \
  "world W { a: R b: R }\n"

namespace rondo::diag {
namespace {

constexpr KindInfo kTable[] = {
    {Kind::kChoreoUndeclared, "choreo-undeclared", Severity::kError, "a name that nothing declares",
     "Robot types, worlds, motions, recursions and options are declared before they can be used; robots are those of the\n"
     "world.",
     TEAM "choreography C in W { a -> c: hello() }\n", "check"},
    {Kind::kChoreoDuplicate, "choreo-duplicate", Severity::kError, "a name that is declared twice",
     "Robot types, worlds and choreographies have one name each, and so have the robots of a world.",
     TEAM "world W { a: R }\nchoreography C in W { { a: Idle(), b: Idle() } }\n", "check"},
    {Kind::kChoreoArity, "choreo-arity", Severity::kError, "a motion with too many or too few arguments",
     "Arguments are given in order or by name; parameters without a default need one.",
     TEAM "choreography C in W { { a: Go(5 m), b: Idle() } }\n", "check"},
    {Kind::kChoreoDuration, "choreo-duration", Severity::kError, "a duration that is not a known time",
     "How long a motion takes is `[least, most]`, in units of time: literal numbers, parameters and arguments. The rules for\n"
     "synchronisation need to know it.",
     "robot R {\n"
     "  state x : length in [-1 m, 1 m]\n"
     "  motion Go(d) noninterruptible [d, d] {}\n"
     "}\n"
     "world W { a: R }\n"
     "choreography C in W { a: Go(5 m) }\n",
     "check"},
    {Kind::kChoreoOutOfScope, "choreo-out-of-scope", Severity::kError,
     "a step across the threads of a `parallel`",
     "The threads of a `parallel` do not meet: no message, no joint motion and no recursion leads from one to another.\n"
     "They meet again behind it.",
     TEAM "choreography C in W {\n"
          "  parallel {\n"
          "    thread { a: Idle() b -> a: hello() }\n"
          "    thread { b: Idle() }\n"
          "  }\n"
          "}\n",
     "check"},
    {Kind::kChoreoSelfMessage, "choreo-self-message", Severity::kError, "a robot that sends to itself",
     "A message has two ends, which wait for each other: a robot that waits for itself waits for ever.",
     TEAM "choreography C in W { a -> a: hello() }\n", "check"},
    {Kind::kChoreoRobotTwice, "choreo-robot-twice", Severity::kError, "a robot that does two things at once",
     "In a joint motion each robot moves once, and it belongs to one thread of a `parallel`.",
     TEAM "choreography C in W { { a: Idle(), a: Go(), b: Idle() } }\n", "check"},
    {Kind::kChoreoRobotNowhere, "choreo-robot-nowhere", Severity::kError,
     "a robot in no thread of a `parallel`",
     "Time passes for every robot. One that has nothing to do idles in a thread of its own, or in another one.",
     TEAM "world V { a: R b: R c: R }\n"
          "choreography D in V {\n"
          "  parallel { thread { a: Idle() } thread { b: Idle() } }\n"
          "}\n",
     "check"},
    {Kind::kChoreoNotMoving, "choreo-not-moving", Severity::kError, "a joint motion that leaves a robot out",
     "A step in which time passes says for every robot of its thread what it does meanwhile.",
     TEAM "choreography C in W { a: Go() }\n", "check"},
    {Kind::kChoreoGuardOwner, "choreo-guard-owner", Severity::kError,
     "a guard that the robot which decides cannot see",
     "The robot that chooses knows its own state and what it was told, nothing else.",
     TEAM "choreography C in W {\n"
          "  choose at a {\n"
          "    when b.x > 0 m { a -> b: yes() }\n"
          "    when not a.x > 0 m { a -> b: no() }\n"
          "  }\n"
          "}\n",
     "check"},
    {Kind::kChoreoUnreachable, "choreo-unreachable", Severity::kWarning, "a step that is never reached",
     "A `loop` has no end, and `continue` goes elsewhere: what follows in the same block never happens.",
     TEAM "choreography C in W {\n  loop { { a: Go(), b: Idle() } a -> b: again() }\n  a -> b: done()\n}\n",
     "check"},
    {Kind::kChoreoChoiceLabel, "choreo-choice-label", Severity::kError,
     "two alternatives that begin with one label",
     "The receiver tells alternatives apart by the label of the first message.",
     TEAM "choreography C in W {\n"
          "  choose at a {\n"
          "    when a.x > 1 m { a -> b: go() }\n"
          "    when a.x <= 1 m { a -> b: go() b -> a: why() }\n"
          "  }\n"
          "}\n",
     "check"},
    {Kind::kChoreoChoiceSilent, "choreo-choice-silent", Severity::kError,
     "a choice of which the others hear nothing",
     "Each alternative begins with a message of the robot that chose, unless that robot is alone in its thread.",
     TEAM "choreography C in W {\n"
          "  choose at a {\n"
          "    when a.x > 1 m { b -> a: go() }\n"
          "    when a.x <= 1 m { a -> b: stay() }\n"
          "  }\n"
          "}\n",
     "check"},
    {Kind::kChoreoUnordered, "choreo-unordered", Severity::kError, "two messages that nothing orders",
     "Behind a motion there must be one first message. A later one comes from a robot that has taken part in a message since:\n"
     "else its receiver cannot know which of the two to expect (unique minimal communication).",
     "robot R {\n"
     "  state x : length in [-1 m, 1 m]\n"
     "  motion Idle() interruptible [0 s, inf) {}\n"
     "}\n"
     "world W { a: R b: R c: R }\n"
     "choreography C in W {\n"
     "  { a: Idle(), b: Idle(), c: Idle() }\n"
     "  a -> b: one()\n"
     "  c -> b: two()\n"
     "}\n",
     "check"},
    {Kind::kChoreoNotReady, "choreo-not-ready", Severity::kError, "a message while another robot cannot stop",
     "The first message behind a motion is sent by the robot whose motion cannot be interrupted: only it knows that the motion\n"
     "has ended (sender readiness).",
     TEAM "choreography C in W {\n  { a: Go(), b: Idle() }\n  b -> a: stop()\n}\n", "check"},
    {Kind::kChoreoMotionAfterMotion, "choreo-motion-after-motion", Severity::kError,
     "two joint motions without a message between them",
     "The robots of a thread have no common clock: without a message they do not know when to change. A robot that is alone\n"
     "in its thread needs none.",
     TEAM "choreography C in W {\n  { a: Go(), b: Idle() }\n  { a: Idle(), b: Go() }\n}\n", "check"},
    {Kind::kChoreoNotInformed, "choreo-not-informed", Severity::kError,
     "a robot that is not told of a change of motion",
     "Between two motions each robot of the first takes part in a message (total synchronisation).",
     "robot R {\n"
     "  state x : length in [-1 m, 1 m]\n"
     "  motion Idle() interruptible [0 s, inf) {}\n"
     "}\n"
     "world W { a: R b: R c: R }\n"
     "choreography C in W {\n"
     "  { a: Idle(), b: Idle(), c: Idle() }\n"
     "  a -> b: go()\n"
     "  { a: Idle(), b: Idle(), c: Idle() }\n"
     "}\n",
     "check"},
    {Kind::kChoreoTwoRigid, "choreo-two-noninterruptible", Severity::kError,
     "two motions of one step that cannot be interrupted",
     "They may end at different times, and whoever ends first cannot wait in mid-motion. `option equal_durations` admits several\n"
     "of one fixed duration, as the published case studies have them.",
     TEAM "choreography C in W { { a: Go(), b: Go() } }\n", "check"},
    {Kind::kChoreoDurationOutside, "choreo-duration-outside", Severity::kError,
     "motions of one step whose durations do not fit",
     "The motion that cannot be interrupted ends while all others may: its duration lies within theirs.",
     "robot R {\n"
     "  state x : length in [-1 m, 1 m]\n"
     "  motion Wait() interruptible [0 s, 1 s] {}\n"
     "  motion Go() noninterruptible [2 s, 2 s] {}\n"
     "}\n"
     "world W { a: R b: R }\n"
     "choreography C in W { { a: Go(), b: Wait() } }\n",
     "check"},
    {Kind::kChoreoThreadStill, "choreo-thread-still", Severity::kError, "a thread in which no time passes",
     "Threads begin and end together. Where robots of one thread move, time passes for those of the others, too: they move or\n"
     "idle meanwhile.",
     TEAM "world T { a: R b: R c: R }\n"
          "choreography C in T {\n"
          "  parallel {\n"
          "    thread { a -> b: hello() }\n"
          "    thread { c: Go() }\n"
          "  }\n"
          "}\n",
     "check"},
    {Kind::kChoreoThreadEndless, "choreo-thread-endless", Severity::kError,
     "a thread that others wait for in vain",
     "The threads of a `parallel` end together. One that goes on for ever, or may do so, stands beside others that go on for\n"
     "ever, too.",
     TEAM
     "choreography C in W {\n  parallel {\n    thread { loop { a: Go() } }\n    thread { b: Go() }\n  }\n}\n",
     "check"},
    {Kind::kChoreoUnguarded, "choreo-unguarded", Severity::kError, "a loop that may go round without a step",
     "A recursion has a message or a motion on every way back to its beginning.",
     TEAM "choreography C in W {\n  rec X { continue X }\n}\n", "check"},
    {Kind::kChoreoZeno, "choreo-zeno", Severity::kError, "a loop in which no time has to pass",
     "Messages take no time, and a motion may end as soon as its least duration is over: a loop whose\n"
     "motions may all end at once may run for ever at one instant, and nothing behind that instant\n"
     "would be looked at.",
     TEAM "choreography C in W {\n  loop { a -> b: ping() b -> a: pong() }\n}\n", "check"},
    {Kind::kChoreoUnmergeable, "choreo-unmergeable", Severity::kError, "a robot that cannot know what to do",
     "Alternatives that look alike to a robot must ask the same of it. Either it learns of the choice, by a message with a label\n"
     "of its own, or it does not notice it (projection, Definition 4.7).",
     "robot R {\n"
     "  state x : length in [-1 m, 1 m]\n"
     "  motion Idle() interruptible [0 s, inf) {}\n"
     "}\n"
     "world W { a: R b: R c: R }\n"
     "choreography C in W {\n"
     "  choose at a {\n"
     "    when a.x > 1 m { a -> b: left() b -> c: go() }\n"
     "    when a.x <= 1 m { a -> b: right() c -> b: go() }\n"
     "  }\n"
     "}\n",
     "check"},
    {Kind::kChoreoCoupled, "choreo-coupled", Severity::kError,
     "a robot that is carried by one of another thread",
     "A robot on a mount goes where its carrier goes. In a thread without the carrier, something must be assumed of it, and\n"
     "its own thread must guarantee that: `thread guarantee cart.x == 0 m { ... } thread assume cart.x == 0 m { ... }`.",
     "robot Cart {\n"
     "  state x : length in [-1 m, 1 m]\n"
     "  mount top = self * translate(x, 0 m, 1 m)\n"
     "  motion Idle() interruptible [0 s, inf) {}\n"
     "}\n"
     "world W { a: Cart b: Cart on a.top }\n"
     "choreography C in W { parallel { thread { a: Idle() } thread { b: Idle() } } }\n",
     "check"},
    {Kind::kChoreoEquation, "choreo-equation", Severity::kError, "states that do not fit together",
     "In a `.chor` file each state stands once to the left, as what goes on, and once to the right, as where something\n"
     "leads; the first one only to the left. Loops go back to a merge. Threads join where they were forked.",
     TEAM
     "== example.chor\nC = def\n  s = (a: Idle(), b: Idle()); t\n  t = a -> b: go(); u\nin [a_x == 0] s\n",
     "check"},
    {Kind::kChoreoPrecedence, "choreo-precedence", Severity::kWarning,
     "operators that bind in an unusual way",
     "Files of the original tool are read as that tool reads them: `&&` and `||` bind equally, a sign binds tighter than a\n"
     "power, powers associate to the left, and in programs comparisons bind like `&&`. Brackets make it plain.",
     TEAM "== example.chor\n"
          "C = def\n"
          "  s = (a: Idle(), b: Idle()); t\n"
          "  t = end\n"
          "in [a_x == 0 || a_x > 0 && b_x == 0] s\n",
     "check"},
    {Kind::kChoreoImport, "choreo-import", Severity::kError, "a file that cannot be imported",
     "`import \"FILE\"` reads another `.rondo` or `.chor` file; its path is relative to the file that imports it.",
     "import \"nowhere.rondo\"\n", "check"},
};

}  // namespace

std::span<const KindInfo> ChoreoKinds() { return kTable; }

}  // namespace rondo::diag

#undef TEAM
