#!/usr/bin/env python3
"""Campaigns as people run them: nothing is found, the same each time, scenarios from files, errors with a place, Ctrl-C.

  campaigns.py RONDO
"""
import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
RONDO = str(pathlib.Path(sys.argv[1]).resolve())
checks = [0, 0]


def check(condition, what):
    checks[0 if condition else 1] += 1
    if not condition:
        print(f"FAILED: {what}")


def campaign(*args, cwd=ROOT):
    return subprocess.run([RONDO, "campaign", *map(str, args)], cwd=cwd, capture_output=True, text=True, timeout=600)


SCENARIO = """[[scenario]]
robots = 3
rounds = 25
on_loss = "evict"
disks = true
[[scenario.fault]]
kind = "alone"
at = 0.8
length = 1.5
robot = 2
[[scenario.fault]]
kind = "crash"
at = 0.2
length = 0.3
robot = 1
"""

for name in ("mutex", "leader", "delivery", "lineform"):
    done = campaign(f"examples/koord/{name}", "--runs", 8, "--rounds", 15, "--json")
    out = json.loads(done.stdout)
    check(done.returncode == 0 and out["failure"] is None, f"{name}: {out}")
    check(out["runs"] == 8 and out["rounds"] >= 80 and out["datagrams"] > out["rounds"], f"{name}: {out}")
    check("collecting -> stored" in out["steps_of_cores"], f"{name}: {out['steps_of_cores']}")

once, twice = (json.loads(campaign("examples/koord/mutex", "--runs", 5, "--seed", 77, "--json").stdout) for _ in range(2))
times = {"seconds": 0, "judging_seconds": 0}
check({**once, **times} == {**twice, **times}, "the same each time")
done = campaign("examples/koord/mutex", "--runs", 3, "--robots", 4)
check(done.returncode == 0 and "3 runs" in done.stdout and "nothing is wrong" in done.stdout, done.stdout)

with tempfile.TemporaryDirectory() as folder:
    file = pathlib.Path(folder) / "s.toml"
    file.write_text(SCENARIO)
    done = campaign("examples/koord/mutex", "--scenarios", file, "--json")
    check(done.returncode == 0 and json.loads(done.stdout)["runs"] == 1, done.stdout + done.stderr)
    file.write_text(SCENARIO.replace('"alone"', '"alnoe"'))
    done = campaign("examples/koord/mutex", "--scenarios", file)
    check(done.returncode == 1 and "did you mean `alone`" in done.stderr and "s.toml:7" in done.stderr, done.stderr)
    done = campaign("examples/koord/mutex", "--scenarios", pathlib.Path(folder) / "none.toml")
    check(done.returncode == 1 and "none.toml" in done.stderr, done.stderr)
    done = campaign("examples/koord/none")
    check(done.returncode == 1 and "none.koord" in done.stderr, done.stderr)
    # A parameter without a value is what the program lacks, not a crash.
    (pathlib.Path(folder) / "p.koord").write_text("allwrite:\n    int x = 0\nparam int limit\nStep:\n    pre: x < limit\n    eff:\n        x += 1\n")
    done = campaign("p.koord", cwd=folder)
    check(done.returncode == 1 and "limit" in done.stderr, done.stdout + done.stderr)

process = subprocess.Popen([RONDO, "campaign", "examples/koord/mutex", "--runs", "1000000"], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
time.sleep(2)
process.send_signal(signal.SIGINT)
out, _ = process.communicate(timeout=60)
check(process.returncode == 3 and "interrupted: go on with `--seed" in out, f"{process.returncode}: {out}")

print(f"{checks[0]} checks passed, {checks[1]} failed")
sys.exit(1 if checks[1] or not checks[0] else 0)
