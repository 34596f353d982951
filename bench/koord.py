#!/usr/bin/env python3
"""Whole-process times of the Koord case studies, cold cache, beside the figures of the Koord paper.

  bench/koord.py RONDO [--runs K]

The paper (Ghosh et al., OOPSLA 2020, Tables 1 to 3; hardware not stated) reports symbolic execution in K plus constraint
construction and Z3, for a fixed number of robots. Ours is the median wall-clock time of one process that parses, checks,
states and proves all obligations, without the proof cache; `every N` is one proof for any number of robots.
"""
import pathlib
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
# program, robots (None: every N) -> the paper's seconds (T_K + T_V) for 3 and the largest N of its table
CASES = [
    ("lineform_1d", "LineForm 1-D", {3: 4.90 + 9.09, 15: 5.23 + 53.89}),
    ("lineform_2d", "LineForm 2-D", {3: 4.19 + 10.13, 10: 5.16 + 32.42}),
    ("lineform", "LineForm 3-D", {4: 5.06 + 12.77, 10: 4.34 + 33.61}),
    ("lineform_unassumed", "LineForm, no assumption", {}),
    ("delivery", "Delivery", {3: 9.90 + 10.6, 10: 12.92 + 18.34}),
    ("mapping", "Mapping", {3: 9.23 + 14.53, 10: 9.31 + 59.81}),
    ("leader", "leader election", {}),
    ("mutex", "mutual exclusion", {}),
    ("mutex_naive", "naive mutual exclusion", {}),
    ("hvac", "HVAC", {}),
    ("shapeform", "shape formation", {}),
]


def measure(rondo, program, robots, runs):
    command = [rondo, "prove", "--no-cache", str(ROOT / f"examples/koord/{program}.koord")]
    if robots:
        command += ["--robots", str(robots)]
    times, status = [], None
    for _ in range(runs):
        start = time.perf_counter()
        status = subprocess.run(command, capture_output=True, check=False).returncode
        times.append(time.perf_counter() - start)
    return statistics.median(times), status


def main():
    rondo = str(pathlib.Path(sys.argv[1]).resolve())
    runs = int(sys.argv[sys.argv.index("--runs") + 1]) if "--runs" in sys.argv else 5
    words = {0: "proved", 1: "failed", 3: "unknown"}
    print(f"{'program':26} {'verdict':8} {'every N':>9} {'N = 3':>9} {'N = 500':>9} {'500 : 3':>8}   paper")
    for program, name, paper in CASES:
        every, status = measure(rondo, program, None, runs)
        three, _ = measure(rondo, program, 3, runs)
        many, _ = measure(rondo, program, 500, runs)
        figures = ", ".join(f"N = {n}: {s:.1f} s ({s / every:.0f} x)" for n, s in paper.items())
        print(f"{name:26} {words.get(status, status):8} {every:7.3f} s {three:7.3f} s {many:7.3f} s {many / three:8.2f}   {figures}")


if __name__ == "__main__":
    main()
