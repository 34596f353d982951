#!/usr/bin/env python3
"""Robots that run for long: no process grows, and rounds go on. For `./dev nightly`.

  soak.py RONDO [MINUTES]     default: 30
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FLEET = """[run]
delta = 0.01
[rounds]
lease = 2
patience = 2
[[robot]]
name = "r"
model = "point_mass"
position = [0, 0, 0]
count = 4
"""
# Lists that grow and shrink, locks, something that all write.
PROGRAM = """
allwrite:
    List<int> orders
    int taken = 0
local:
    int n = 0
Order:
    pre: len(orders) < 6
    eff:
        atomic:
            orders.append(pid + n)
        n = (n + 1) % 7
Take:
    pre: len(orders) > 3
    eff:
        atomic:
            taken = orders[0]
            orders.remove(orders[0])
"""


def resident(pid):
    """Kilobytes."""
    for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1])
    return 0


def main():
    rondo = str(pathlib.Path(sys.argv[1]).resolve())
    minutes = float(sys.argv[2]) if len(sys.argv) > 2 else 30
    env = dict(os.environ, ROS_DOMAIN_ID=str(50 + os.getpid() % 40), ROS_LOCALHOST_ONLY="1")
    problems = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "soak.koord").write_text(PROGRAM)
        (folder / "soak.toml").write_text(FLEET)
        robots = [subprocess.Popen([rondo, "run", str(folder / "soak"), "--robot", f"r{r}", "--duration", str(60 * minutes), "--json",
                                    "--log", str(folder / f"r{r}.mcap")], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=env, text=True)
                  for r in range(4)]
        # What is kept for memory has its size after a sixth of the time.
        time.sleep(10 * minutes)
        before = [resident(p.pid) for p in robots]
        time.sleep(45 * minutes)
        after = [resident(p.pid) for p in robots]
        reports = [json.loads(p.communicate(timeout=10 * minutes + 120)[0]) for p in robots]
    for number, (a, b, report) in enumerate(zip(before, after, reports)):
        # The index of a log grows by a few bytes for each line.
        good = b < 1.1 * a + 200 * minutes and report["rounds"] > 0.9 * 6000 * minutes and report["status"] == 0
        problems += not good
        print(f"r{number}: {a} kB, then {b} kB; {report['rounds']} rounds; fell back {report['fallbacks']} times{'' if good else '  WRONG'}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
