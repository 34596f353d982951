#include "diag/registry_tables.h"

namespace rondo::diag {
namespace {

constexpr KindInfo kTable[] = {
    {Kind::kKoordMisplacedStatement, "koord-misplaced-statement", Severity::kError,
     "a statement where it has no meaning",
     "`break` and `continue` belong into loops, `return` with a value into functions, `atomic` into events; a function\n"
     "cannot `stop` the robot.",
     "Step:\n    eff:\n        break\n", "check"},
    {Kind::kKoordUnreachable, "koord-unreachable", Severity::kWarning, "a statement that is never reached",
     "Nothing runs behind `stop`, `return`, `break` or `continue` in the same block.",
     "local:\n    int n\nStep:\n    eff:\n        stop\n        n = 1\n", "check"},
    {Kind::kKoordRecursion, "koord-recursion", Severity::kError, "a function that calls itself",
     "An event must end within its round, so loops are bounded and functions do not call themselves, not even by way\n"
     "of others.",
     "def fun f(int n) -> int:\n    return f(n - 1)\nlocal:\n    int n\nStep:\n    eff:\n        n = f(3)\n",
     "check"},
    {Kind::kKoordNoEvent, "koord-no-event", Severity::kError, "a program without an event",
     "A program is a set of events: a name, a precondition `pre:` and an effect `eff:`. Without one it does nothing.",
     "local:\n    int n\n", "check"},
    {Kind::kKoordSectionOrder, "koord-section-order", Severity::kWarning, "sections in an unusual order",
     "By convention a program has definitions, modules, variables, `init`, events, and then its specification. Any order\n"
     "is understood; readers expect this one.",
     "Step:\n    eff:\n        stop\nlocal:\n    int n\n", "check"},
    {Kind::kKoordPointlessSpec, "koord-pointless-spec", Severity::kError,
     "a summary of a function that has a body",
     "Summaries say what external functions guarantee. A function with a body guarantees what its body does; a summary\n"
     "could only contradict it.",
     "def fun twice(int n) -> int:\n"
     "    return n + n\n"
     "local:\n"
     "    int n\n"
     "Step:\n"
     "    eff:\n"
     "        n = twice(1)\n"
     "summary twice(a) -> y: y > a\n",
     "check"},
    {Kind::kKoordSpecScope, "koord-spec-scope", Severity::kError, "a name that this place cannot speak of",
     "A general assumption and a summary hold at any time, so they mention parameters and functions only. A controller\n"
     "assumption mentions the ports of the robot's own module. A program reads its own ports; only specifications read\n"
     "another robot's. `old(e)` stands behind `always`.",
     "local:\n    int n\nStep:\n    eff:\n        n = 1\nassume n > 0\n", "check"},
    {Kind::kKoordFallback, "koord-fallback", Severity::kError, "a fallback that cannot run at any moment",
     "`fallback M:` says what the actuators of module M get when a robot has lost the others. It runs at once and alone, so\n"
     "it reads the robot's own sensors, parameters and `pid`, and sets actuators of M: nothing that the team agrees on.",
     "using Motion:\n"
     "    sensors:\n"
     "        pos psn\n"
     "    actuators:\n"
     "        pos target\n"
     "allwrite:\n"
     "    pos home\n"
     "Step:\n"
     "    eff:\n"
     "        Motion.target = home\n"
     "fallback Motion:\n"
     "    target = home\n",
     "check"},
};

}  // namespace

std::span<const KindInfo> KoordControlKinds() { return kTable; }

}  // namespace rondo::diag
