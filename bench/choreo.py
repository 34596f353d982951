#!/usr/bin/env python3
"""Structural checks of choreographies: the examples, and generated ones of growing size.

  choreo.py RONDO

Times are those of whole processes. The original (facts on the tool of the paper): 0.02 to 0.3 s for each case study,
without the start of its interpreter.
"""
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
RUNS = 5


def measure(command):
    best, status = float("inf"), 0
    for _ in range(RUNS):
        start = time.perf_counter()
        done = subprocess.run(command, capture_output=True, check=False)
        best, status = min(best, time.perf_counter() - start), done.returncode
    return best, "" if status == 0 else f"  status {status}"


def rounds(count):
    """A choreography of `count` rounds with motions, messages, a choice and threads: 10 nodes each."""
    text = ["robot R {", "  state x : length in [-9 m, 9 m]", "  motion Idle() interruptible [0 s, inf) {}", "  motion Go(T = 2 s) noninterruptible [T, T] {}", "}",
            "world W { a: R b: R }", "choreography C in W {"]
    for i in range(count):
        text += [f"  {{ a: Go(), b: Idle() }}", f"  a -> b: there{i}()",
                 "  parallel { thread { a: Idle() } thread { b: Go() b: Idle() } }", f"  b -> a: done{i}()",
                 "  choose at b {", f"    when b.x > 0 m {{ b -> a: left{i}() }}", f"    when b.x <= 0 m {{ b -> a: right{i}() }}", "  }"]
    return "\n".join(text + ["}", ""])


def main():
    rondo = str(pathlib.Path(sys.argv[1]).resolve())
    print("rondo check, whole process, best of", RUNS)
    for example in sorted((ROOT / "examples/choreo").glob("*.rondo")):
        took, note = measure([rondo, "check", str(example)])
        print(f"  {example.stem:24} {took * 1000:8.1f} ms{note}")
    with tempfile.TemporaryDirectory() as folder:
        before = None
        for count in (125, 250, 500, 1000, 2000):
            path = pathlib.Path(folder) / f"rounds{count}.rondo"
            path.write_text(rounds(count))
            took, note = measure([rondo, "check", str(path)])
            growth = f"  x {took / before:.2f}" if before else ""
            print(f"  {count * 11:8} nodes           {took * 1000:8.1f} ms{growth}{note}")
            before = took


if __name__ == "__main__":
    main()
