#include "diag/registry_tables.h"

namespace rondo::diag {
namespace {

constexpr KindInfo kTable[] = {
    {Kind::kKoordTypeMismatch, "koord-type-mismatch", Severity::kError, "a value of the wrong type",
     "Values have one type. An `int` may stand where a `float` is needed; no other type turns into another by itself.",
     "local:\n    int n\nStep:\n    eff:\n        n = 1.5\n", "check"},
    {Kind::kKoordNotBoolean, "koord-not-boolean", Severity::kError,
     "a condition that is neither true nor false",
     "Preconditions, conditions of `if` and operands of `and`, `or`, `not` and `implies` must be of type bool. Numbers\n"
     "are not conditions: compare them.",
     "local:\n    int n\nStep:\n    pre: n\n    eff:\n        stop\n", "check"},
    {Kind::kKoordArity, "koord-arity", Severity::kError, "the wrong number of arguments",
     "A function takes as many arguments as its declaration, or its first use, says. A loop over pairs takes two\n"
     "variables.",
     "local:\n    float d\nStep:\n    eff:\n        d = abs(1, 2)\n", "check"},
    {Kind::kKoordNotCallable, "koord-not-callable", Severity::kError, "a call of what is no function",
     "Only functions, sensors of type `PathPlanner`, and the methods `append` and `remove` of lists can be called.",
     "local:\n    int n\n    int m\nStep:\n    eff:\n        m = n(1)\n", "check"},
    {Kind::kKoordNotIndexable, "koord-not-indexable", Severity::kError,
     "an index on what is no list or array",
     "Only lists, arrays and `allread` variables can be indexed. A record has members: `p.x`.",
     "local:\n    int n\n    int m\nStep:\n    eff:\n        m = n[0]\n", "check"},
    {Kind::kKoordArrayLength, "koord-array-length", Severity::kError, "a length that no array can have",
     "An array has a fixed number of items, at least one: a number, `N_sys`, a parameter, or a sum, difference or product\n"
     "of these.",
     "local:\n    int a[0]\nStep:\n    eff:\n        stop\n", "check"},
    {Kind::kKoordUnknownSignature, "koord-unknown-signature", Severity::kError,
     "a function whose types cannot be told",
     "The types of an external function are inferred from its uses. Where they do not suffice, declare it:\n"
     "`def fun area(List<pos> corners) -> float`.",
     "local:\n    bool b\nStep:\n    eff:\n        b = same([], [])\nsummary same(p, q) -> r: r or not r\n",
     "check"},
    {Kind::kKoordStreamMisuse, "koord-stream-misuse", Severity::kError,
     "a stream used as a value, or a value as a stream",
     "A stream takes values with `<<` and can be used in no other way; nothing else takes `<<`.",
     "local:\n    int i\nStep:\n    eff:\n        i << \"hello\"\n", "check"},
    {Kind::kKoordSensorWrite, "koord-sensor-write", Severity::kError, "a write to a sensor",
     "Sensors are written by the environment between two rounds. A program can only read them.",
     "using Motion:\n    sensors:\n        pos psn\nStep:\n    eff:\n        Motion.psn = pos(0, 0, 0)\n",
     "check"},
    {Kind::kKoordActuatorRead, "koord-actuator-read", Severity::kError, "a read of an actuator",
     "An actuator hands a value to the controller; what the controller makes of it comes back through sensors. A\n"
     "program that needs the value again keeps it in a local variable. (Specifications may read actuators.)",
     "using Motion:\n"
     "    actuators:\n"
     "        pos target\n"
     "local:\n"
     "    pos p\n"
     "Step:\n"
     "    eff:\n"
     "        p = Motion.target\n",
     "check"},
    {Kind::kKoordAllreadOwnership, "koord-allread-ownership", Severity::kError,
     "a write to another robot's cell",
     "Every robot reads all cells of an `allread` variable and writes one: its own, `x[pid]`. The index must be\n"
     "literally `pid`, so that the reader sees it too.",
     "allread:\n    int x[N_sys]\nStep:\n    eff:\n        x[pid + 1] = 1\n", "check"},
    {Kind::kKoordNotAssignable, "koord-not-assignable", Severity::kError, "a value assigned to what is fixed",
     "Parameters, loop variables, the number of robots and the results of functions cannot be assigned to. Functions\n"
     "cannot write the robot's variables.",
     "param float limit\nStep:\n    eff:\n        limit = 1.0\n", "check"},
    {Kind::kKoordLostUpdate, "koord-lost-update", Severity::kWarning,
     "a write that another robot may overwrite in the same round",
     "All robots read the values at the start of the round. If two of them write an `allwrite` variable in the same\n"
     "round, neither sees the other's value, and the last writer's value stays. Inside `atomic:` only one robot runs the\n"
     "event in a round.",
     "allwrite:\n    int total\nAdd:\n    eff:\n        total = total + 1\n", "check"},
};

}  // namespace

std::span<const KindInfo> KoordTypeKinds() { return kTable; }

}  // namespace rondo::diag
