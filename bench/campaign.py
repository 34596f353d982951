#!/usr/bin/env python3
"""Campaigns: how fast virtual time is, and after how many runs each broken core is found.

  campaign.py RONDO [--runs N] [--speed]     --speed: without the broken cores, which have to be compiled

The table of broken cores has the faults of the area `rounds` in tests/faults/faults.toml, each active in the same binary.
"""
import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
KEPT = os.path.join(tempfile.gettempdir(), "rondo-bench.scenario.toml")
PROGRAM = "src/sim/campaign/testdata/fleet.koord"


def campaign(rondo, *args, fault=None):
    environment = {**os.environ, **({"RONDO_FAULT": fault} if fault else {})}
    try:
        done = subprocess.run([rondo, "campaign", *map(str, args), "--save", KEPT, "--json"], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=1200)
        return json.loads(done.stdout)
    except subprocess.TimeoutExpired:
        return {"runs": 0, "failure": {"what": "it never ends"}}
    except ValueError:
        return {"runs": 0, "failure": {"what": "it crashes"}}


def speed(rondo):
    print("| program | N | rounds | datagrams per robot and round | virtual s / s (each run twice, and judged) | rounds judged / s | longest recovery |\n| --- | --- | --- | --- | --- | --- | --- |")
    for program in (PROGRAM, "examples/koord/mutex", "examples/koord/lineform", "examples/koord/delivery"):
        for robots in (2, 4, 7):
            out = campaign(rondo, program, "--robots", robots, "--runs", 200)
            each = out["datagrams"] / out["rounds"] / robots
            print(f"| {pathlib.Path(program).stem} | {robots} | {out['rounds']} | {each:.1f} | {2 * out['virtual_seconds'] / out['seconds']:.0f} | {out['rounds'] / out['judging_seconds']:.0f} | {out['longest_recovery']:.3f} s |")


def mutants(runs):
    spec = importlib.util.spec_from_file_location("faults", ROOT / "tests/faults/run.py")
    faults = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(faults)
    areas, all_faults = faults.load()
    faults.weave(all_faults)
    faults.build({"rounds": areas["rounds"]}, [])
    rondo = str(faults.BINARY / "bin/rondo")
    out = campaign(rondo, PROGRAM, "--runs", 500)
    print(f"\nwithout a fault: {out['runs']} runs, {'nothing found' if out['failure'] is None else out['failure']}")
    print("\n| broken core | found after runs | robots | what is seen |\n| --- | --- | --- | --- |")
    missed = 0
    for fault in (f for f in all_faults if f["area"] == "rounds"):
        out = campaign(rondo, PROGRAM, "--runs", runs, fault=fault["name"])
        failure = out["failure"]
        missed += failure is None
        print(f"| {fault['name'].removeprefix('rounds-').replace('-', ' ')} | {out['runs'] if failure else '**not found**'} | {failure.get('robots', '') if failure else ''} | {failure['what'] if failure else ''} |", flush=True)
    return missed


def main():
    rondo = str(pathlib.Path(sys.argv[1]).resolve())
    runs = int(sys.argv[sys.argv.index("--runs") + 1]) if "--runs" in sys.argv else 10_000
    speed(rondo)
    return 1 if "--speed" not in sys.argv and mutants(runs) else 0


if __name__ == "__main__":
    sys.exit(main())
