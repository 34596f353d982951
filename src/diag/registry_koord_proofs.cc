#include "diag/registry_tables.h"

namespace rondo::diag {
namespace {

constexpr KindInfo kTable[] = {
    {Kind::kKoordUnboundedLoop, "koord-unbounded-loop", Severity::kError,
     "a loop whose length no proof can know",
     "Proofs unroll loops. The bounds of `for i = a, b` must be constant (N_sys is, with `--robots`), and a list needs a\n"
     "stated bound: `invariant bounded: len(l) <= 4`. The bound is a hint that is proved along with the rest.",
     "local:\n"
     "    List<int> l\n"
     "    int n\n"
     "Step:\n"
     "    eff:\n"
     "        for x in l:\n"
     "            n = x\n"
     "invariant small: n < 5\n",
     "prove"},
    {Kind::kKoordNoInvariant, "koord-no-invariant", Severity::kError, "nothing to prove",
     "`rondo prove` proves invariants. State what must always hold in the program or in the file beside it with the\n"
     "extension `.spec`: `invariant NAME: ...`.",
     "Step:\n    eff:\n        stop\n", "prove"},
    {Kind::kKoordNotInductive, "koord-not-inductive", Severity::kError,
     "a round that does not preserve an invariant",
     "An invariant is proved by induction: it holds initially, and every round preserves it. Here a state that satisfies\n"
     "all invariants is followed by one that does not satisfy this one. The table shows the round. Either the program is\n"
     "wrong, or the state cannot be reached and a further invariant should exclude it, or an assumption about a\n"
     "controller or function is missing.",
     "local:\n"
     "    int n = 0\n"
     "    int m = 0\n"
     "Step:\n"
     "    eff:\n"
     "        n = m\n"
     "        m = 1 - m\n"
     "invariant small: forall i in ID: n[i] <= 1\n",
     "prove"},
    {Kind::kKoordRefuted, "koord-refuted", Severity::kError, "a run that violates an invariant",
     "The invariant is false in an initial state, or after one round from an initial state. The table shows it: this can\n"
     "really happen.",
     "local:\n    int n = 5\nStep:\n    eff:\n        n = 1\ninvariant small: forall i in ID: n[i] <= 1\n",
     "prove"},
    {Kind::kKoordUndefinedOperation, "koord-undefined-operation", Severity::kError,
     "an operation that may have no result",
     "An index can be out of range, a divisor zero, an item absent from the list that it is removed from, or a function\n"
     "end without a value, in a state that satisfies all invariants. Such an event would fail on the robot.",
     "allread:\n"
     "    int x[N_sys]\n"
     "local:\n"
     "    int n = 0\n"
     "Step:\n"
     "    eff:\n"
     "        n = x[pid + 1] - x[pid + 1]\n"
     "invariant zero: forall i in ID: n[i] == 0\n",
     "prove"},
    {Kind::kKoordUnknown, "koord-unknown", Severity::kError, "an obligation that could not be decided",
     "The solver neither proved the obligation nor found a counterexample that stands up to all assumptions. Nothing is\n"
     "established. More time, a fixed number of robots, or stronger summaries may help.",
     "def fun f(float x) -> float\n"
     "local:\n"
     "    float n = 0\n"
     "Step:\n"
     "    eff:\n"
     "        n = f(n)\n"
     "summary f(x) -> y: forall z in float: y * z * z * z >= x * z * z - 1\n"
     "invariant bounded: forall i in ID: n[i] <= 1\n",
     "prove"},
    {Kind::kKoordContradiction, "koord-contradiction", Severity::kError,
     "assumptions that cannot all be true",
     "From a contradiction everything follows, so no verdict counts. The message names a set of assumptions and\n"
     "summaries that cannot hold together; one of them is wrong.",
     "param float a\n"
     "local:\n"
     "    float x = 0\n"
     "Step:\n"
     "    eff:\n"
     "        x = a\n"
     "assume a > 1\n"
     "assume a < 0\n"
     "invariant low: forall i in ID: x[i] <= 0\n",
     "prove"},
    {Kind::kKoordUnrealisable, "koord-unrealisable", Severity::kWarning,
     "a promise of a controller that may be broken at once",
     "`assume M when P always Q` promises Q at every moment after the program transition. If P can be true while Q is\n"
     "false at that very moment, no controller can keep the promise there, and a proof that uses it says nothing about\n"
     "those states.",
     "using Motion:\n"
     "    sensors:\n"
     "        float psn\n"
     "local:\n"
     "    float x = 0\n"
     "Step:\n"
     "    eff:\n"
     "        x = 0\n"
     "assume Motion when Motion.psn <= 2 always Motion.psn <= 1\n"
     "assume initially Motion.psn <= 1\n"
     "invariant near: forall i in ID: Motion[i].psn <= 2 and x[i] == 0\n",
     "prove"},
    {Kind::kKoordNeverEnabled, "koord-never-enabled", Severity::kWarning, "an event that can never happen",
     "No state that satisfies the invariants makes the precondition true. Either it is wrong, or the event is dead.",
     "local:\n"
     "    int n = 0\n"
     "Step:\n"
     "    pre: n > 5\n"
     "    eff:\n"
     "        n = 1\n"
     "invariant small: forall i in ID: n[i] <= 1\n",
     "prove"},
    {Kind::kKoordUnusedAssumption, "koord-unused-assumption", Severity::kNote,
     "an assumption that no proof needs",
     "The invariants were proved without it. Fewer assumptions make a stronger result: it may be left out.",
     "param float a\n"
     "local:\n"
     "    float x = 0\n"
     "Step:\n"
     "    eff:\n"
     "        x = 0\n"
     "assume a > 1\n"
     "invariant low: forall i in ID: x[i] <= 0\n",
     "prove"},
    {Kind::kKoordDisagreement, "koord-disagreement", Severity::kError, "two solvers that disagree",
     "`--cross-check` had another solver decide the same obligation, and the answers differ. One of the solvers is wrong;\n"
     "nothing counts as proved. `--smt-out` writes the question for a report.",
     "local:\n    int n = 0\nStep:\n    eff:\n        n = 0\ninvariant zero: forall i in ID: n[i] == 0\n",
     "prove"},
};

}  // namespace

std::span<const KindInfo> KoordProofKinds() { return kTable; }

}  // namespace rondo::diag
