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

from mcap_files import unsealed

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

# Patience beyond the lease keeps a fleet from going on in time: a failing run, small, that is kept and made again.
PATIENT = """[[scenario]]
seed = 2303
robots = 2
rounds = 8
on_loss = "wait"
exchange = "sequencer"
disks = true
delta = 0.05
stop_time = 0.001
patience = 3
"""
for kind, at, length, robot in (("alone", 0.11, 0.131, 1), ("alone", 0.025, 0.04, 1), ("slow", 0.055, 0.065, 1), ("crash", 0.024, 0.008, 0)):
    PATIENT += f'[[scenario.fault]]\nkind = "{kind}"\nat = {at}\nlength = {length}\nrobot = {robot}\namount = {0.05 if kind == "slow" else 0}\n'


def replay(path):
    return subprocess.run([RONDO, "replay", str(path)], cwd=ROOT, capture_output=True, text=True, timeout=600)


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    (folder / "patient.toml").write_text(PATIENT)
    done = campaign("examples/koord/mutex", "--scenarios", folder / "patient.toml", "--save", folder / "found.toml", "--json")
    out = json.loads(done.stdout)
    check(done.returncode == 1 and "is not reached" in out["failure"]["what"], done.stdout)
    check(out["saved"] == str(folder / "found.toml") and out["trace"] == str(folder / "found.mcap"), done.stdout)
    done = campaign("examples/koord/mutex", "--scenarios", folder / "found.toml", "--save", folder / "again.toml")
    check(done.returncode == 1 and "rondo replay" in done.stdout and "exchange = " in done.stdout, done.stdout)
    check((folder / "again.mcap").read_bytes() == (folder / "found.mcap").read_bytes(), "the same trace")
    done = replay(folder / "found.mcap")
    check(done.returncode == 0 and "bit for bit" in done.stdout and "is not reached" in done.stdout, done.stdout + done.stderr)
    other = unsealed((folder / "found.mcap").read_bytes())
    (folder / "other.mcap").write_bytes(other.replace(b"contributed", b"contributee", 1))
    done = replay(folder / "other.mcap")
    check(done.returncode == 1 and "differs: /rondo/log at t = " in done.stdout, done.stdout + done.stderr)
    (folder / "other.mcap").write_bytes(other.replace(b"robots = 2", b"robots = 0", 1))
    done = replay(folder / "other.mcap")
    check(done.returncode == 1 and "scenario" in done.stdout + done.stderr, done.stdout + done.stderr)
    # Good runs are kept where people ask for it.
    done = campaign("examples/koord/delivery", "--runs", 3, "--seed", 5, "--rounds", 6, "--logs", folder / "logs")
    logs = sorted((folder / "logs").glob("*.mcap"))
    check(done.returncode == 0 and [log.stem for log in logs] == ["5", "6", "7"], done.stdout + done.stderr)
    for log in logs:
        done = replay(log)
        check(done.returncode == 0 and "bit for bit" in done.stdout, done.stdout + done.stderr)

process = subprocess.Popen([RONDO, "campaign", "examples/koord/mutex", "--runs", "1000000"], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
time.sleep(2)
process.send_signal(signal.SIGINT)
out, _ = process.communicate(timeout=60)
check(process.returncode == 3 and "interrupted: go on with `--seed" in out, f"{process.returncode}: {out}")

print(f"{checks[0]} checks passed, {checks[1]} failed")
sys.exit(1 if checks[1] or not checks[0] else 0)
