#!/usr/bin/env python3
"""Every difference between the Koord dialects (the original compiler, the paper's grammar, the paper's programs) is accepted
or rejected as docs/language.md says.

  dialects.py RONDO
"""
import json
import pathlib
import subprocess
import sys
import tempfile

STEP = "Step:\n    pre: true\n    eff:\n        {}\n"

# (what, program, kinds of the errors that must be reported; empty: accepted)
CASES = [
    ("module header with colon", "using Motion:\n    sensors:\n        pos psn\n" + STEP.format("stop"), []),
    ("module header without colon", "using Motion\n    sensors:\n        pos psn\n" + STEP.format("stop"), []),
    ("`using module`", "using module Motion:\n    actuators:\n        pos target\n" + STEP.format("stop"), []),
    ("one-line sections", "using Motion:\n    sensors: pos psn\n    actuators: pos target\nallread: pos x[N_sys]\n" + STEP.format("x[pid] = Motion.psn"), []),
    ("actuators before sensors", "using Motion:\n    actuators:\n        pos target\n    sensors:\n        pos psn\n" + STEP.format("Motion.target = Motion.psn"), []),
    ("boolean, true, False", "local:\n    boolean a = true\n    bool b = False\n" + STEP.format("a = b"), []),
    ("not and !", "local:\n    bool a\n" + STEP.format("a = not a\n        a = !a"), []),
    ("&& || and or", "local:\n    bool a\n" + STEP.format("a = a && a || a and a or a"), []),
    ("N_sys and its older names", "local:\n    int n\n" + STEP.format("n = N_sys + numAgents + numBots + Nsys"), []),
    ("pre with brackets", "local:\n    bool a\nStep:\n    pre (a)\n    eff:\n        stop\n", []),
    ("pre without colon", "local:\n    bool a\nStep:\n    pre !a\n    eff:\n        stop\n", []),
    ("no pre", "Step:\n    eff:\n        stop\n", []),
    ("event with brackets", "step():\n    pre: true\n    eff: stop\n", []),
    ("event body at column 1", "Step:\n pre: true\n eff:\n  stop\n", []),
    ("eff with a deeper continuation", "local:\n    bool a\n    int n\nStep:\n    pre: true\n    eff: a = False\n        n = 1\n", []),
    ("eff: atomic:", "allwrite:\n    int n\nStep:\n    pre: true\n    eff: atomic:\n        n = 1\n", []),
    ("else: atomic:", "allwrite:\n    int n\nlocal:\n    bool a\nStep:\n    eff:\n        if a:\n            stop\n        else: atomic:\n            n = 1\n", []),
    ("for over a range", "local:\n    int n\n" + STEP.format("for i = 0, 5:\n            n = i"), []),
    ("for over a list, with break", "local:\n    List<int> l\n    int n\n" + STEP.format("for x in l:\n            n = x\n            break"), []),
    ("for over pairs", "local:\n    List<pos, Scan> l\n    pos q\n" + STEP.format("for p, s in l:\n            q = p"), []),
    ("lists and their methods", "local:\n    List<int> l\n    int n\n" + STEP.format("l = [1, 2]\n        l.remove(1)\n        l.append(3)\n        n = len(l)\n        if l != []:\n            n = l[0]"), []),
    ("List(Point), Queue<int>, T[]", "local:\n    List(Point) a\n    Queue<int> b\n    int[] c\n" + STEP.format("stop"), []),
    ("def adt and def", "def adt Task:\n    int id\n    pos target\ndef Other:\n    int id\nlocal:\n    Task t\n    Other o\n" + STEP.format("t.id = o.id"), []),
    ("types that nobody defines", "local:\n    GridMap m\n    Task t\n    pos p\n" + STEP.format("m = merge(m, m)\n        p = t.target"), []),
    ("functions with bodies", "def fun twice(int a) -> int:\n    return a + a\nlocal:\n    int n\n" + STEP.format("n = twice(2)"), []),
    ("parameters called `type`", "def fun same(type a type b):\n    return a == b\nlocal:\n    bool n\n" + STEP.format("n = same(1, 2)"), []),
    ("external functions", "local:\n    bool b\n    int n\n" + STEP.format("b = clear(n, pid)"), []),
    ("callable port", "using M:\n    sensors:\n        PathPlanner planner\n    actuators:\n        List<pos> path\nlocal:\n    pos p\n    List<pos> q\n" + STEP.format("q = M.planner(p)\n        M.path = q"), []),
    ("bare callable port", "using M:\n    sensors:\n        PathPlanner planner\nlocal:\n    pos p\n    List<pos> q\n" + STEP.format("q = planner(p)"), []),
    ("bare port", "using Log:\n    actuators:\n        stream stdout\n" + STEP.format('stdout << "1 + 1 = " << 2'), []),
    ("mid and midpoint", "local:\n    pos p\n" + STEP.format("p = mid([p, p])\n        p = midpoint(p, p)"), []),
    ("underscores and upper-case events", "local:\n    bool on_task\nTarget_Update:\n    eff:\n        on_task = true\n", []),
    ("line joining with a backslash", "local:\n    int n\n" + STEP.format("n = 1 + \\\n            2"), []),
    ("line joining in brackets", "local:\n    int n\n" + STEP.format("n = max(1,\n  2)"), []),
    ("both kinds of comments", "# one\n// two\nlocal:  # three\n    int n // four\n" + STEP.format("n = 1  # five"), []),
    ("CRLF", ("local:\n    int n\n" + STEP.format("n = 1")).replace("\n", "\r\n"), []),
    ("no line end at the end", "local:\n    int n\nStep:\n    eff:\n        n = 1", []),
    ("blank lines with blanks", "local:\n    int n\n   \n" + STEP.format("n = 1\n     \n        n = 2"), []),
    ("a blank line first", "\nlocal:\n    int n\n" + STEP.format("n = 1"), []),
    ("elif", "local:\n    int n\n" + STEP.format("if n == 1:\n            n = 2\n        elif n == 2:\n            n = 3\n        else:\n            n = 4"), []),
    ("one-line if", "local:\n    int n\n" + STEP.format("if n == 1: n = 2"), []),
    ("two indices", "local:\n    int m[2][3]\n    int n\n" + STEP.format("m[1][2] = 3\n        n = m[0][1]"), []),
    ("int becomes float", "local:\n    float f\n" + STEP.format("f = 1\n        f = 1.5 * 2"), []),
    ("a == true", "local:\n    bool a\n" + STEP.format("a = a == true"), []),
    ("= as equality in a condition", "local:\n    int n\nStep:\n    pre: not (pid = N_sys - 1 or pid = 0)\n    eff:\n        n = 1\n", []),
    ("++ and += and %", "local:\n    int n\n" + STEP.format("n++\n        n += 2\n        n = n % 3"), []),
    ("-= *= /= -- and pass", "local:\n    float n\n" + STEP.format("n -= 1\n        n *= 2\n        n /= 2\n        n--\n        pass"), []),
    ("a value that depends on a condition", "local:\n    int n\n    float f\n" + STEP.format("n = 1 if n > 2 else 2 if n > 1 else 3\n        f = 1 if n > 2 else 0.5\n        n = (n if f > 1 else 0) + 1"), []),
    ("local variables of a block", "local:\n    List<pos> l\n" + STEP.format("int k = 1\n        List<pos> way = l\n        k += len(way)\n        if k > 2:\n            int j = k\n            k = j"), []),
    ("for over range()", "local:\n    int n\n" + STEP.format("for i in range(5):\n            n = i\n        for i in range(2, 5):\n            n = i"), []),
    ("while", "local:\n    int n\n" + STEP.format("while n < 3 within 8:\n            n += 1\n            if n == 2:\n                break\n            continue"), []),
    ("const", "const int most = 3\nlocal:\n    int n\n" + STEP.format("n = most"), []),
    ("a variable called pass, let or while", "local:\n    int pass\n    int let\n    int while\n" + STEP.format("pass = let\n        let -= 1\n        while = 2"), []),
    ("enum and stage", "def stage {pick, go}\nlocal:\n    stage s = pick\n    enum {on, off} t = on\n" + STEP.format("s = go\n        t = off"), []),
    ("agent header", "agent Follow\nlocal:\n    int n\n" + STEP.format("n = 1"), []),
    ("allread with [] and [*]", "allread:\n    pos[] x\n    int y[*]\n    int z\n" + STEP.format("y[pid] = 1\n        z[pid] = y[0]"), []),
    ("signs of mathematics", "local:\n    bool a\n    int n\n" + STEP.format("a = \u00ac a \u2227 n \u2264 3 \u2228 n \u2265 4 or n \u2260 5"), []),
    ("numbers", "local:\n    float f\n" + STEP.format("f = .5 + 5. + 1e-3 + 2.5E2"), []),
    ("strings", "local:\n    string s\n" + STEP.format("s = \"a\" + 'b'\n        s = \"1\" + 2"), []),
    ("section repeated", "local:\n    int a\nlocal:\n    int b\n" + STEP.format("a = b"), []),
    ("map, list, type, module as names", "local:\n    int map\n    int list\n    int type\n    int module\n" + STEP.format("map = list + type + module"), []),
    ("urgent", "Step:\n    pre urgent: true\n    eff:\n        stop\n", []),
    ("SafetyProp", STEP.format("stop") + "SafetyProp: N_sys > 0\n", []),
    ("semicolons", "local:\n    int a; int b\n" + STEP.format("a = 1; b = 2"), []),
    ("tabs count, with a warning", "local:\n\tint a\nStep:\n\teff:\n\t\ta = 1\n", []),
    # Rejected.
    ("chained comparison", "local:\n    bool a\n    int n\n" + STEP.format("a = n < 1 < 2"), ["syntax-unexpected"]),
    ("inconsistent dedent", "Step:\n    eff:\n            stop\n        stop\n", ["syntax-indentation"]),
    ("no event", "local:\n    int n\n", ["koord-no-event"]),
    ("keyword as name", "local:\n    int eff\n" + STEP.format("stop"), ["syntax-reserved-name"]),
    ("duplicate event", STEP.format("stop") + STEP.format("stop"), ["koord-duplicate"]),
    ("non-Boolean pre", "local:\n    int n\nStep:\n    pre: n\n    eff:\n        stop\n", ["koord-not-boolean"]),
    ("ill-typed initialiser", "local:\n    int n = \"x\"\n" + STEP.format("stop"), ["koord-type-mismatch"]),
    ("float to int", "local:\n    int n\n" + STEP.format("n = 1.5"), ["koord-type-mismatch"]),
    ("actuator read", "using M:\n    actuators:\n        pos t\nlocal:\n    pos p\n" + STEP.format("p = M.t"), ["koord-actuator-read"]),
    ("sensor write", "using M:\n    sensors:\n        pos t\n" + STEP.format("M.t = pos(1, 2, 3)"), ["koord-sensor-write"]),
    ("x[pid + 12]", "allread:\n    int x[N_sys]\n" + STEP.format("x[pid + 12] = 1"), ["koord-allread-ownership"]),
    ("x[3]", "allread:\n    int x[N_sys]\n" + STEP.format("x[3] = 1"), ["koord-allread-ownership"]),
    ("(pid) is pid", "allread:\n    int x[N_sys]\n" + STEP.format("x[(pid)] = 1"), []),
    ("unknown field", "def adt T:\n    int id\nlocal:\n    T n\n    int i\n" + STEP.format("i = n.zzz"), ["koord-unknown-member"]),
    ("arity", "def fun f(int a) -> int:\n    return a\nlocal:\n    int n\n" + STEP.format("n = f(1, 2)"), ["koord-arity"]),
    ("stream assignment", "using Log:\n    actuators:\n        stream stdout\n" + STEP.format("Log.stdout = 1"), ["koord-stream-misuse", "koord-type-mismatch"]),
    ("const without a value", "const int most\n" + STEP.format("stop"), ["syntax-unexpected"]),
    ("const is fixed", "const int most = 3\n" + STEP.format("most -= 1"), ["koord-not-assignable"]),
    ("while without an end", "local:\n    int n\n" + STEP.format("while n < 3:\n            n += 1"), ["syntax-unexpected"]),
    ("range of three", "local:\n    int n\n" + STEP.format("for i in range(1, 2, 3):\n            n = i"), ["koord-arity"]),
    ("a local variable twice", "local:\n    int n\n" + STEP.format("int n = 1"), ["koord-duplicate"]),
    ("a local variable behind its block", "local:\n    int n\n" + STEP.format("if n > 0:\n            int k = 1\n        n = k"), ["koord-undeclared"]),
    ("values of two types", "local:\n    int n\n" + STEP.format("n = 1 if n > 0 else true"), ["koord-type-mismatch"]),
    ("not a program", "123 abc\n", ["syntax-unexpected"]),
    ("pos as bool", "local:\n    pos apple\n    bool banana\n" + STEP.format("apple = banana\n        banana = 1 + banana\n        banana = 1 + 2"), ["koord-type-mismatch"]),
]


def main():
    rondo = str(pathlib.Path(sys.argv[1]).resolve())
    passed, failed = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "case.koord"
        for what, program, wanted in CASES:
            path.write_bytes(program.encode())
            done = subprocess.run([rondo, "check", "--json", str(path)], capture_output=True, text=True, timeout=60)
            try:
                errors = [d for d in json.loads(done.stdout)["diagnostics"] if d["severity"] == "error"]
            except ValueError:
                errors = [{"kind": f"status {done.returncode}", "message": done.stdout + done.stderr}]
            kinds = sorted({e["kind"] for e in errors})
            good = (kinds == [] if not wanted else bool(kinds) and set(kinds) <= set(wanted)) and done.returncode == (1 if wanted else 0)
            if good and not wanted:
                # What is accepted is formatted to a fixed point.
                for _ in range(2):
                    formatted = subprocess.run([rondo, "fmt", "--stdout", str(path)], capture_output=True, timeout=60)
                    good = good and formatted.returncode == 0
                    before, _ = path.read_bytes(), path.write_bytes(formatted.stdout)
                good = good and before == formatted.stdout
                kinds = ["formatting has no fixed point"]
            passed, failed = passed + good, failed + (not good)
            if not good:
                print(f"{what}: wanted {wanted}, got {kinds} {[e['message'] for e in errors]}")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
