#include "diag/registry_tables.h"

// Two balls that can roll along a line, for the examples.
#define BALLS                                                                            \
  "robot Ball {\n"                                                                       \
  "  state x : length in [-5 m, 5 m]\n"                                                  \
  "  body sphere(self * translate(x, 0, 0), 20 cm)\n"                                    \
  "  motion Idle() interruptible [0 s, inf) {}\n"                                        \
  "  motion Roll(from: length, to: length) noninterruptible [2 s, 2 s] {\n"              \
  "    modifies x\n    pre near(x, from, 1 cm)\n    during between(x, from, to, 1 cm)\n" \
  "    post x == to\n  }\n}\n"                                                           \
  "world W { a: Ball at (0, 0, 0) b: Ball at (2 m, 0, 0) }\n"

namespace rondo::diag {
namespace {

constexpr KindInfo kTable[] = {
    {Kind::kChoreoMissing, "choreo-missing", Severity::kError, "something that a proof cannot do without",
     "That bodies keep apart can only be proved of bodies: every robot needs `body`. Threads need regions of space, which\n"
     "`rondo infer regions` can find, and what a thread guarantees has to be about its own robots.",
     "robot R {\n"
     "  state x : length in [-1 m, 1 m]\n"
     "  motion Idle() interruptible [0 s, inf) {}\n"
     "}\n"
     "world W { a: R }\n"
     "choreography C in W { a: Idle() }\n",
     "prove"},
    {Kind::kChoreoContract, "choreo-contract", Severity::kError, "a contract that cannot be kept",
     "There is no state in which the motion may begin, none in which it goes on, or none in which it ends as it promises.\n"
     "From such a contract everything would follow. And what a motion that may be interrupted promises has to hold\n"
     "whenever that can happen.",
     "robot Ball {\n"
     "  state x : length in [-5 m, 5 m]\n"
     "  body sphere(self * translate(x, 0, 0), 20 cm)\n"
     "  motion Roll() noninterruptible [2 s, 2 s] {\n"
     "    modifies x\n"
     "    during x < 1 m\n"
     "    post x == 2 m\n"
     "  }\n"
     "}\n"
     "world W { a: Ball }\n"
     "choreography C in W { a: Roll() }\n",
     "prove"},
    {Kind::kChoreoPrecondition, "choreo-precondition", Severity::kError,
     "a motion that may begin where it must not",
     "What is known when the motion begins does not imply its `pre`. What is known: `initially`, `post` of the motions\n"
     "before, guards of choices, and what messages promise.",
     BALLS "choreography C in W {\n"
           "  initially a.x == 0 and b.x == 0\n"
           "  { a: Roll(-1 m, -2 m), b: Idle() }\n"
           "}\n",
     "prove"},
    {Kind::kChoreoCollision, "choreo-collision", Severity::kError, "bodies that may touch",
     "While robots move, what they occupy (`footprint`, or else `body`) has no point in common with each other or with\n"
     "obstacles; and their bodies have none when it begins. The notes say when, where and in which state that\n"
     "fails; `--svg` draws it.",
     BALLS "choreography C in W {\n"
           "  initially a.x == 0 and b.x == 0\n"
           "  { a: Roll(0, 1.8 m), b: Idle() }\n"
           "}\n",
     "prove"},
    {Kind::kChoreoFootprint, "choreo-footprint", Severity::kError,
     "a footprint that does not contain the body",
     "Other robots keep clear of the footprint of a motion, so that the body has to stay within; and a hull contains the\n"
     "body in every state.",
     "robot Ball {\n"
     "  state x : length in [-5 m, 5 m]\n"
     "  body sphere(self * translate(x, 0, 0), 20 cm)\n"
     "  motion Idle() interruptible [0 s, inf) { footprint sphere(self, 30 cm) }\n"
     "}\n"
     "world W { a: Ball }\n"
     "choreography C in W { initially a.x == 2 m  a: Idle() }\n",
     "prove"},
    {Kind::kChoreoRegion, "choreo-region", Severity::kError, "regions of threads that are not kept apart",
     "Threads of `parallel` have regions of space for themselves: no two have a point in common, all are within the\n"
     "region around them, and every motion of a thread keeps within its own.",
     BALLS "choreography C in W {\n"
           "  initially a.x == 0 and b.x == 0\n"
           "  parallel {\n"
           "    thread region x < 0.5 m { a: Roll(0, 1 m) }\n"
           "    thread region x > 0.5 m { b: Roll(0, 1 m) }\n"
           "  }\n"
           "}\n",
     "prove"},
    {Kind::kChoreoAssumption, "choreo-assumption", Severity::kError, "an assumption that nobody keeps",
     "What a motion or a thread assumes of others has to follow from what those promise, all the time; and what a thread\n"
     "guarantees from what its own motions promise.",
     BALLS "choreography C in W {\n"
           "  initially a.x == 0 and b.x == 0\n"
           "  parallel {\n"
           "    thread region x < 1 m guarantee a.x == 0 { a: Roll(0, 0.1 m) }\n"
           "    thread region x > 1 m { b: Roll(0, 1 m) }\n"
           "  }\n"
           "}\n",
     "prove"},
    {Kind::kChoreoNoAlternative, "choreo-no-alternative", Severity::kError,
     "a choice in which no alternative may be open",
     "The guards of a choice are total: whatever the state is when it is reached, one of them holds. Otherwise the robot\n"
     "stops there, and all that wait for it.",
     BALLS "choreography C in W {\n"
           "  initially a.x >= 0 and a.x <= 1.2 m and b.x == 0\n"
           "  choose at a {\n"
           "    when a.x > 1 m { a -> b: left() }\n"
           "    when a.x < 1 m { a -> b: right() }\n"
           "  }\n"
           "}\n",
     "prove"},
    {Kind::kChoreoPromise, "choreo-promise", Severity::kError, "a message that may break its promise",
     "The guard of a message holds whenever it is sent, and something can be sent that is as promised.",
     BALLS "choreography C in W {\n"
           "  initially a.x == 0 and b.x == 0\n"
           "  a -> b: go() when a.x > 1 m\n"
           "  { a: Idle(), b: Idle() }\n"
           "}\n",
     "prove"},
    {Kind::kChoreoNotInductive, "choreo-not-inductive", Severity::kError,
     "what may not hold, as far as is known where ways meet",
     "What is known where a step begins comes from the motions, guards and messages on the way there. Where more than a\n"
     "few ways meet, only what they have in common is kept. What is known here allows a state in which something fails,\n"
     "but no run was found that comes to such a state: perhaps there is none. Let `post` of the motions before, or a\n"
     "guard, say what holds. If a run breaks it, the finding has the kind of what fails, and shows the way there.",
     "robot Hand {\n"
     "  state h, g : length in [-5 m, 5 m]\n"
     "  body sphere(self, 10 cm)\n"
     "  motion Wait() interruptible [0 s, inf) {}\n"
     "  motion Lift(to: length) noninterruptible [1 s, 1 s] {\n"
     "    modifies h\n"
     "    pre h >= 0\n"
     "    during h >= 0\n"
     "    post h == to\n"
     "  }\n"
     "  motion Open(to: length) noninterruptible [1 s, 1 s] {\n"
     "    modifies g\n"
     "    pre g >= 0\n"
     "    during g >= 0\n"
     "    post g == to\n"
     "  }\n"
     "}\n"
     "world V { a: Hand at (0, 0, 0) b: Hand at (2 m, 0, 0) }\n"
     "choreography C in V {\n"
     "  initially a.h == 0 and a.g == 0\n"
     "  loop {\n"
     "    choose at a {\n"
     "      when a.h >= -5 m { a -> b: p() { a: Lift(1 m), b: Wait() } }\n"
     "      when a.h >= -5 m { a -> b: q() { a: Lift(2 m), b: Wait() } }\n"
     "      when a.h >= -5 m { a -> b: r() { a: Lift(3 m), b: Wait() } }\n"
     "      when a.h >= -5 m { a -> b: t() { a: Lift(4 m), b: Wait() } }\n"
     "    }\n"
     "    choose at a {\n"
     "      when a.h >= -5 m { a -> b: p() { a: Open(1 m), b: Wait() } }\n"
     "      when a.h >= -5 m { a -> b: q() { a: Open(2 m), b: Wait() } }\n"
     "      when a.h >= -5 m { a -> b: r() { a: Open(3 m), b: Wait() } }\n"
     "    }\n"
     "  }\n"
     "}\n",
     "prove"},
    {Kind::kChoreoNever, "choreo-never", Severity::kWarning, "a step that never happens",
     "What is known where this motion begins contradicts itself, so that everything about it is true. Perhaps a guard\n"
     "cannot hold, or `initially` has no state.",
     BALLS "choreography C in W {\n"
           "  initially a.x == 0 and b.x == 0\n"
           "  choose at a {\n"
           "    when a.x > 0 { a -> b: left() { a: Idle(), b: Idle() } }\n"
           "    when a.x <= 0 { a -> b: right() { a: Idle(), b: Idle() } }\n"
           "  }\n"
           "}\n",
     "prove"},
    {Kind::kChoreoNoRegion, "choreo-no-region", Severity::kError, "threads that no planes keep apart",
     "Threads without a `region` get one, if planes can be found between what their motions take up: along x, y, z and\n"
     "between x and y, one after the other, for pieces of time if need be.",
     BALLS "choreography C in W {\n"
           "  initially a.x == 0 and b.x == 0\n"
           "  parallel {\n"
           "    thread { a: Roll(0, 1.8 m) }\n"
           "    thread { b: Idle() }\n"
           "  }\n"
           "}\n",
     "prove"},
    {Kind::kChoreoUnknown, "choreo-unknown", Severity::kError, "what could neither be proved nor refuted",
     "The search ran out of time, or came to states so near the edge that numbers cannot tell. It is not proved.",
     "robot Ball {\n"
     "  state x : length in [-5 m, 5 m]\n"
     "  state w : angle in [-1 rad, 1 rad]\n"
     "  body sphere(self * translate(x, 0, 0), 20 cm)\n"
     "  motion Roll() noninterruptible [2 s, 2 s] {\n"
     "    pre sin(3 * w) <= 3 * sin(w) - 4 * sin(w) * sin(w) * sin(w)\n"
     "  }\n"
     "}\n"
     "world W { a: Ball }\n"
     "choreography C in W { a: Roll() }\n",
     "prove"},
};

}  // namespace

std::span<const KindInfo> ChoreoProofKinds() { return kTable; }

}  // namespace rondo::diag

#undef BALLS
