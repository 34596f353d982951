#!/usr/bin/env python3
"""Simulated fleets: how much faster than real time.

  sim.py RONDO [--runs K]
"""
import argparse
import hashlib
import json
import pathlib
import subprocess
import sys
import tempfile

FOLLOW = """using Motion:
    sensors:
        pos psn
    actuators:
        pos target

allread:
    pos x[N_sys]

Go:
    pre: true
    eff:
        x[pid] = Motion.psn
        Motion.target = pos(50 - Motion.psn.x, 50 - Motion.psn.y, 0)

assume initially: x[pid] == Motion.psn
invariant inside: forall i in ID: x[i] in rect(pos(-100, -100, -1), pos(200, 200, 1))
"""
SCAN = """using MotionWithScan:
    sensors:
        pos psn
        List<pos, Scan> pscan
    actuators:
        pos target

local:
    int seen = 0

Look:
    pre: true
    eff:
        seen = seen + len(MotionWithScan.pscan)
        MotionWithScan.target = MotionWithScan.psn + pos(1, 0.5, 0)
"""


def fleet(model, count, columns, run, extra=""):
    return f"""[run]
{run}

{extra}
[[robot]]
name = "r"
model = "{model}"
position = [0, 0, 0]
count = {count}
columns = {columns}
step = [1.5, 0, 0]
row_step = [0, 1.5, 0]
"""


def world():
    text = "[lidar]\nrange = 10\nbeams = 360\nrate = 10\nnoise = 0.01\nresolution = 0.01\n\n[world]\nlow = [-50, -50, 0]\nhigh = [50, 50, 3]\n"
    for i in range(30):
        text += f"\n[[world.box]]\ncentre = [{(i * 37) % 41 - 20}, {(i * 23) % 43 - 20}, 0.5]\nsize = [0.98, 0.98, 1]\n"
    return text


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("rondo")
    parser.add_argument("--runs", type=int, default=3)
    options = parser.parse_args()
    root = pathlib.Path(__file__).resolve().parent.parent
    cases = []
    with tempfile.TemporaryDirectory() as folder:
        def make(name, program, fleet_text):
            (pathlib.Path(folder) / f"{name}.koord").write_text(program)
            (pathlib.Path(folder) / f"{name}.toml").write_text(fleet_text)
            return str(pathlib.Path(folder) / name)
        run = "delta = 0.1\nduration = 10\nmonitor = 0.1"
        for model in ("car", "unicycle", "cart"):
            cases.append((f"1000 x {model}", make(f"many_{model}", FOLLOW, fleet(model, 1000, 40, run)), "5"))
        cases.append(("100 x quadrotor", make("drones", FOLLOW, fleet("quadrotor", 100, 10, run)), ""))
        cases.append(("100 x LIDAR, 360 beams, 10 Hz", make("scans", SCAN, fleet("car", 100, 10, run, world())), "1"))
        for name in ("lineform", "delivery", "mapping", "shapeform"):
            cases.append((name, str(root / "examples/koord" / name), ""))
        print(f"{'':32} {'simulated':>10} {'wall':>9} {'x real time':>12} {'bar':>5}  trace (SHA-256)")
        worst = 0
        for name, stem, bar in cases:
            best, report, hashes = None, None, set()
            for k in range(options.runs):
                trace = pathlib.Path(folder) / "run.mcap"
                # Timed without a trace; hashed with one, with one thread and with two.
                done = subprocess.run([options.rondo, "simulate", stem, "--json"], capture_output=True, text=True)
                report = json.loads(done.stdout)
                if best is None or report["seconds"] < best:
                    best = report["seconds"]
                subprocess.run([options.rondo, "simulate", stem, "--json", "--trace", str(trace), "--jobs", str(1 + k % 2)], capture_output=True)
                hashes.add(hashlib.sha256(trace.read_bytes()).hexdigest())
            ratio = report["time"] / best
            worst |= len(hashes) != 1
            print(f"{name:32} {report['time']:8.1f} s {best:7.2f} s {ratio:12.1f} {bar:>5}  {sorted(hashes)[0][:16]}{'' if len(hashes) == 1 else ' DIFFER'}")
    print("the original: 12 drones 0.752, 16 drones 0.627 of real time on average (Gazebo, one workstation)")
    return worst


if __name__ == "__main__":
    sys.exit(main())
