#include "diag/registry_tables.h"

namespace rondo::diag {
namespace {

constexpr KindInfo kTable[] = {
    {Kind::kKoordNotExecutable, "koord-not-executable", Severity::kError,
     "something that a run needs and nothing gives",
     "To run a program, every parameter needs a value, every function a body, every sensor values that it can take. Proofs\n"
     "need none of them. The `explore` section gives them: `a = pos(0, 0, 0)`, `Motion.psn in [pos(0, 0, 0), pos(1, 0, 0)]`,\n"
     "`Room.temperature in grid(60, 80, 2)`, `f(x) = x + 1`. In simulations, the fleet file can give them as well.",
     "param int limit\nlocal:\n    int n = 0\nStep:\n    pre: n < limit\n    eff:\n        n = n + 1\n",
     "explore"},
    {Kind::kKoordNotBuildable, "koord-not-buildable", Severity::kError,
     "something that C++ without growing memory cannot hold",
     "A program that `rondo build` makes takes no memory while it runs, so each list, and each value of an external type, needs to\n"
     "say how many items it has at most: `--capacity 'List<int>=16'`, or `--capacity 64` for all that are not named. What has\n"
     "no room is the fault \"longer than its capacity\" then, and the event is skipped.",
     "local:\n    List<int> seen\nStep:\n    pre: len(seen) < 3\n    eff:\n        seen.append(pid)\n",
     "build --robots 2 --print"},
    {Kind::kKoordNotChecked, "koord-not-checked", Severity::kWarning,
     "a formula that runs are not checked against",
     "The formula speaks of all values of a type, and there are too many of them to try. Proofs can deal with it; a run\n"
     "cannot. Ints are tried if the condition of the quantifier bounds them: `forall m in int: 0 <= m and m < n implies ...`.",
     "local:\n"
     "    float x = 0\n"
     "Step:\n"
     "    eff:\n"
     "        x = 1 - x\n"
     "invariant all: forall y in float: y * y >= 0 or x[0] == y\n"
     "explore:\n"
     "    N_sys = 1\n",
     "explore"},
    {Kind::kKoordNoInitialState, "koord-no-initial-state", Severity::kError,
     "no declared state satisfies the assumptions about the initial state",
     "Every combination of declared initial values and of the values that `explore` gives is refused by an `assume initially`\n"
     "or by an assumption about ports. Variables without a value start as zero, false or empty; `explore` can give others:\n"
     "`Motion.target in [pos(1, 0, 0)]`.",
     "local:\n    int n\nStep:\n    eff:\n        n = 1\nassume initially: n > 0\nexplore:\n    N_sys = 1\n",
     "explore"},
    {Kind::kKoordViolated, "koord-violated", Severity::kError, "a run that violates an invariant",
     "Starting from an initial state, the team reached a state in which the invariant is false. The table shows the run, round\n"
     "by round: what each robot did, and what changed. No run with fewer rounds violates an invariant, if it was explored.",
     "local:\n"
     "    int n = 0\n"
     "Step:\n"
     "    eff:\n"
     "        n = n + 1\n"
     "invariant small: forall i in ID: n[i] <= 2\n"
     "explore:\n"
     "    N_sys = 1\n",
     "explore"},
    {Kind::kKoordFault, "koord-fault", Severity::kError, "an operation without a result, in a run",
     "A robot reached an operation that has no result: an index out of range, a division by zero, an item that is not in the\n"
     "list, a function that ends without a value, a number beyond 64 bits. On a robot the event would fail.",
     "local:\n"
     "    int n = 2\n"
     "    int m = 0\n"
     "Step:\n"
     "    eff:\n"
     "        m = 6 / n\n"
     "        n = n - 1\n"
     "explore:\n"
     "    N_sys = 1\n",
     "explore"},
    {Kind::kKoordSummaryBroken, "koord-summary-broken", Severity::kError,
     "a function that does not keep its summary",
     "A call returned a value that the summary of the function excludes. Either the body that `explore` gives (or the\n"
     "simulator's function) is wrong, or the summary is: then every proof that uses it says nothing about this function.",
     "def fun f(int x) -> int\n"
     "local:\n"
     "    int n = 0\n"
     "Step:\n"
     "    eff:\n"
     "        n = f(n)\n"
     "summary f(x) -> y: y >= 0\n"
     "explore:\n"
     "    N_sys = 1\n"
     "    f(x) = x - 1\n",
     "explore"},
    {Kind::kKoordAssumptionBroken, "koord-assumption-broken", Severity::kError,
     "an assumption that a simulated run violates",
     "The platform did something that the specification assumes it never does. A proof that uses the assumption says nothing\n"
     "about this platform. The message names the robot and the time.",
     "using Motion:\n"
     "    sensors:\n"
     "        pos psn\n"
     "    actuators:\n"
     "        pos target\n"
     "Step:\n"
     "    eff:\n"
     "        Motion.target = pos(5, 0, 0)\n"
     "assume Motion.stays always Motion.psn.x <= 1\n"
     "== koord-assumption-broken.toml\n"
     "[[robot]]\n"
     "model = \"cart\"\n"
     "position = [0, 0, 0]\n",
     "simulate"},
    {Kind::kKoordStuck, "koord-stuck", Severity::kWarning,
     "a state from which the declared environment cannot go on",
     "None of the values that `explore` declares for the sensors is allowed by the controller assumptions. What would come\n"
     "behind this state was not explored. Declare more values, or a finer grid.",
     "using Room:\n"
     "    sensors:\n"
     "        int level\n"
     "Step:\n"
     "    eff:\n"
     "        stop\n"
     "assume Room always Room.level >= 1\n"
     "assume Room.grows when Room.level >= 1 always Room.level > old(Room.level)\n"
     "explore:\n"
     "    N_sys = 1\n"
     "    Room.level in [1, 2]\n",
     "explore"},
    {Kind::kKoordDeadlock, "koord-deadlock", Severity::kError, "a state in which nothing can happen any more",
     "No robot can run an event, the environment changes nothing, and not every robot has stopped. `--deadlock` asks for this:\n"
     "many programs end in such a state on purpose, others should say `stop`.",
     "local:\n"
     "    bool done = false\n"
     "Step:\n"
     "    pre: not done\n"
     "    eff:\n"
     "        done = true\n"
     "explore:\n"
     "    N_sys = 1\n",
     "explore --deadlock"},
    {Kind::kKoordNeverHappened, "koord-never-happened", Severity::kWarning,
     "an event or branch that no explored run reaches",
     "Every reachable state was explored, for this number of robots and these declared values, and the event was never enabled\n"
     "or the branch never taken. Either it is dead, or the declared values are too few to reach it.",
     "local:\n"
     "    int n = 0\n"
     "Step:\n"
     "    pre: n == 0\n"
     "    eff:\n"
     "        n = 1\n"
     "Back:\n"
     "    pre: n == 2\n"
     "    eff:\n"
     "        n = 0\n"
     "explore:\n"
     "    N_sys = 1\n",
     "explore"},
    {Kind::kFleetSyntax, "fleet-syntax", Severity::kError, "a fleet file that is not TOML",
     "The fleet file beside the program, `NAME.toml`, names the robots of a simulation, their models and their world. It is\n"
     "written in TOML (toml.io).",
     "Step:\n    eff:\n        stop\n== fleet-syntax.toml\n[run\n", "simulate"},
    {Kind::kFleetValue, "fleet-value", Severity::kError, "a fleet file that says something impossible",
     "A key that does not exist, a value of the wrong type or out of range, a model that nobody knows, a name used twice, or a\n"
     "body whose state does not stay finite. docs/simulation.md lists everything that a fleet file may say.",
     "Step:\n"
     "    eff:\n"
     "        stop\n"
     "== fleet-value.toml\n"
     "[[robot]]\n"
     "model = \"submarine\"\n"
     "position = [0, 0, 0]\n",
     "simulate"},
};

}  // namespace

std::span<const KindInfo> KoordRunKinds() { return kTable; }

}  // namespace rondo::diag
