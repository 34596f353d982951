#include "diag/registry_tables.h"

namespace rondo::diag {
namespace {

constexpr KindInfo kTable[] = {
    {Kind::kKoordUndeclared, "koord-undeclared", Severity::kError, "a name that is declared nowhere",
     "Every variable and port must be declared: local variables under `local:`, shared ones under `allread:` or\n"
     "`allwrite:`, ports in a module. Functions need no declaration (a warning says so); without a body they are external.",
     "local:\n    int counter\nStep:\n    eff:\n        count = 1\n", "check"},
    {Kind::kKoordDuplicate, "koord-duplicate", Severity::kError, "a name that is declared twice",
     "Two variables, types, functions or events cannot share a name. (An event and a variable may: they are never\n"
     "used in the same place.)",
     "local:\n    int a\nallwrite:\n    bool a\nStep:\n    eff:\n        stop\n", "check"},
    {Kind::kKoordUnknownType, "koord-unknown-type", Severity::kError, "a type that does not exist",
     "Types are int, float, bool, string, stream, pos, List<T>, Queue<T>, arrays, and what `def adt` defines. A\n"
     "capitalised name that is defined nowhere is an opaque type: only external functions look inside. Lower-case\n"
     "names are taken for typing mistakes.",
     "local:\n    flaot x\nStep:\n    eff:\n        stop\n", "check"},
    {Kind::kKoordUnknownMember, "koord-unknown-member", Severity::kError,
     "a member or port that does not exist",
     "What stands behind the dot must be a port of the module or a field of the record type before it.",
     "using Motion:\n"
     "    sensors:\n"
     "        pos psn\n"
     "local:\n"
     "    pos p\n"
     "Step:\n"
     "    eff:\n"
     "        p = Motion.position\n",
     "check"},
    {Kind::kKoordAmbiguousPort, "koord-ambiguous-port", Severity::kError,
     "a port name that several modules share",
     "A port may be named without its module only if no other module has a port with this name.",
     "using Left:\n"
     "    sensors:\n"
     "        float range\n"
     "using Right:\n"
     "    sensors:\n"
     "        float range\n"
     "local:\n"
     "    float r\n"
     "Step:\n"
     "    eff:\n"
     "        r = range\n",
     "check"},
    {Kind::kKoordUnknownFunction, "koord-unknown-function", Severity::kWarning,
     "a function that is declared nowhere",
     "A function without a declaration, a summary or a body is external: in proofs it may return anything of its type,\n"
     "though always the same for the same arguments; programs that run need a body for it. Often the name is a typing\n"
     "mistake, or a word of another language. Declare it if it is meant: `def fun f(pos p) -> float`. For a value that\n"
     "may be a different one each time, write `any q in [...]`.",
     "local:\n    pos p\n    float d\nStep:\n    eff:\n        d = distance(p, p) + 0.0\n", "check"},
};

}  // namespace

std::span<const KindInfo> KoordNameKinds() { return kTable; }

}  // namespace rondo::diag
