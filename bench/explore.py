#!/usr/bin/env python3
"""Exhaustive exploration: states, seconds, bytes, and the same models in Spin where it is installed.

  explore.py RONDO [--check]      --check: fail where the numbers of states differ

Spin's times are those of its verifier (cc -O2 -DSAFETY -DNOREDUCE), the best of three runs that alternate with ours.
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# Programs whose reachable states are many and whose rounds are cheap.
COUNT = """allread:
    int x[N_sys] = 0
Step:
    pre: x[pid] < {limit}
    eff:
        x[pid] = x[pid] + 1
invariant small: forall i in ID: x[i] <= {limit}
"""

# The same programs, translated by hand. One atomic step is one round: every robot reads what was there at its start.
LEADER = """
byte candidate = 0;  /* candidate + 1 */
bit voted[N]; bit elected[N];
active proctype team() {
  byte i; byte seen; bit all; bit lock; bit before[N];
  do
  :: atomic {
       seen = candidate; all = 1; i = 0;
       do :: i < N -> before[i] = voted[i]; all = all && voted[i]; i++ :: else -> break od;
       i = 0;
       do
       :: i < N ->
          if
          :: true
          :: !before[i] && !lock -> lock = 1; voted[i] = 1; if :: i + 1 > seen -> candidate = i + 1 :: else fi
          :: all && seen == i + 1 && !elected[i] -> elected[i] = 1
          fi;
          i++
       :: else -> break
       od;
       i = 0;
       do :: i < N -> before[i] = 0; i++ :: else -> break od;
       seen = 0; all = 0; lock = 0; i = 0
     }
  od
}
"""
SUM = """
short sum = 0; short count = 0;
bit added[N]; short last[N]; bit stopped[N];
active proctype team() {
  byte i; short seen; short counted; bit lock; bit before[N];
  do
  :: atomic {
       seen = sum; counted = count; i = 0;
       do :: i < N -> before[i] = added[i]; i++ :: else -> break od;
       i = 0;
       do
       :: i < N ->
          if
          :: true
          :: !stopped[i] && !before[i] && !lock -> lock = 1; sum = seen + 2 * i; count = counted + 1; added[i] = 1
          :: !stopped[i] && before[i] && counted == N -> last[i] = seen; stopped[i] = 1
          fi;
          i++
       :: else -> break
       od;
       i = 0;
       do :: i < N -> before[i] = 0; i++ :: else -> break od;
       seen = 0; counted = 0; lock = 0; i = 0
     }
  od
}
"""
MUTEX = """
bit inside[N];
active proctype team() {
  byte i; bit free; bit lock; bit before[N];
  do
  :: atomic {
       free = 1; i = 0;
       do :: i < N -> before[i] = inside[i]; free = free && !inside[i]; i++ :: else -> break od;
       i = 0;
       do
       :: i < N ->
          if
          :: true
          :: free && !lock -> lock = 1; inside[i] = 1
          :: before[i] -> inside[i] = 0
          fi;
          i++
       :: else -> break
       od;
       i = 0;
       do :: i < N -> before[i] = 0; i++ :: else -> break od;
       free = 0; lock = 0; i = 0
     }
  od
}
"""


# Each robot counts on, or does not.
COUNTERS = """
byte x[N];
active proctype team() {
  byte i;
  do
  :: atomic {
       i = 0;
       do
       :: i < N -> if :: true :: x[i] < LIMIT -> x[i] = x[i] + 1 fi; i++
       :: else -> break
       od;
       i = 0
     }
  od
}
"""


def compiled(text, n, folder):
    """Spin's verifier of a model."""
    (pathlib.Path(folder) / "model.pml").write_text(f"#define N {n}\n{text}")
    subprocess.run(["spin", "-a", "model.pml"], cwd=folder, check=True, capture_output=True)
    subprocess.run(["cc", "-O2", "-DSAFETY", "-DNOREDUCE", "-o", "pan", "pan.c"], cwd=folder, check=True, capture_output=True)


def verified(folder):
    """States stored, seconds, and bytes for each state (its vector as stored, and what Spin keeps beside it)."""
    out = subprocess.run(["./pan", "-m1000000", "-w22"], cwd=folder, capture_output=True, text=True).stdout
    number = lambda pattern: float(found.group(1)) if (found := re.search(pattern, out)) else 0.0
    each = number(r"as stored = ([\d.]+) byte") + number(r"byte \+ ([\d.]+) byte overhead")
    return int(number(r"([\d.e+]+) states, stored")), number(r"elapsed time ([\d.]+)"), each


def spin(text, n):
    with tempfile.TemporaryDirectory() as folder:
        compiled(text, n, folder)
        return verified(folder)[:2]


def large(binary, installed):
    """Models of more than a million states, by one core and by all, in turns with Spin."""
    different = 0
    print(f"{'':20} {'states':>9} {'1 core':>8} {'all cores':>9} {'bytes/state':>12} | {'spin':>8} {'bytes/state':>12} {'1 core':>8} {'all':>6}")
    for n, limit in [(3, 120), (4, 40)]:
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "count.koord"
            path.write_text(COUNT.format(limit=limit))
            if installed:
                compiled(f"#define LIMIT {limit}\n{COUNTERS}", n, folder)
            one, every, peer = [], [], []
            for _ in range(3):
                one.append(rondo(binary, path, n, "--no-symmetry", "--jobs", "1"))
                every.append(rondo(binary, path, n, "--no-symmetry"))
                if installed:
                    peer.append(verified(folder))
            best = lambda runs: min(run["seconds"] for run in runs)
            line = (f"{n} counters to {limit:<6} {one[0]['states']:>9} {best(one):8.2f} {best(every):9.2f} "
                    f"{every[0]['bytes'] / every[0]['states']:12.1f} |")
            if installed:
                seconds = min(run[1] for run in peer)
                differs = any(run["states"] != peer[0][0] for run in one + every)
                different += differs
                line += f" {seconds:8.2f} {peer[0][2]:12.1f} {best(one) / seconds:7.2f}x {best(every) / seconds:5.2f}x{'  DIFFERENT' if differs else ''}"
            print(line)
    return different


def rondo(binary, path, n, *options):
    done = subprocess.run([binary, "explore", "--json", "--robots", str(n), *options, str(path)], capture_output=True, text=True)
    return json.loads(done.stdout)["explored"][0]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("rondo")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    binary = str(pathlib.Path(options.rondo).resolve())
    root = pathlib.Path(__file__).resolve().parent.parent / "examples/koord"
    installed = shutil.which("spin") is not None
    if not installed:
        print("spin is not installed: `apt-get install spin` for the comparison")
    different = 0
    print(f"{'':12} {'N':>3} {'states':>9} {'ending':>9} {'seconds':>8} | {'spin':>9} {'seconds':>8}")
    for name, program, model, sizes in [
        ("leader", "leader", LEADER, (2, 4, 8)),
        ("sum", "addnums", SUM, (2, 4, 8)),
        ("mutex", "mutex", MUTEX, (2, 4, 8)),
    ]:
        for n in sizes:
            ours = rondo(binary, root / f"{program}.koord", n, "--no-symmetry")
            line = f"{name:12} {n:>3} {ours['states']:>9} {ours['ending']:>9} {ours['seconds']:8.3f} |"
            if installed:
                states, seconds = spin(model, n)
                differs = states != ours["states"]
                different += differs
                line += f" {states:>9} {seconds:8.2f}{'  DIFFERENT' if differs else ''}"
            print(line)
    print()
    print(f"{'':28} {'states':>9} {'transitions':>12} {'seconds':>8} {'states/s':>10} {'bytes/state':>12}")
    with tempfile.TemporaryDirectory() as folder:
        for name, n, limit, extra in [
            ("two counters", 2, 1500, ["--no-symmetry"]),
            ("three counters, renaming", 3, 120, []),
            ("two counters, compact", 2, 1500, ["--no-symmetry", "--compact"]),
        ]:
            path = pathlib.Path(folder) / "count.koord"
            path.write_text(COUNT.format(limit=limit))
            best = min((rondo(binary, path, n, *extra) for _ in range(3)), key=lambda e: e["seconds"])
            print(f"{name:28} {best['states']:>9} {best['transitions']:>12} {best['seconds']:8.2f} {best['states'] / best['seconds']:10.0f} {best['bytes'] / best['states']:12.0f}")
    print()
    different += large(binary, installed)
    return 1 if options.check and different else 0


if __name__ == "__main__":
    sys.exit(main())
