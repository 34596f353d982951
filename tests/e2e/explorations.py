#!/usr/bin/env python3
"""Examples and mutants: what is proved is not violated by exploration, and every run that an exploration saves replays.

  explorations.py RONDO
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
checks = [0, 0]


def check(condition, what):
    checks[0 if condition else 1] += 1
    if not condition:
        print(f"FAILED: {what}")


def run(rondo, *args):
    done = subprocess.run([rondo, *map(str, args)], capture_output=True, text=True, timeout=600)
    try:
        return done.returncode, json.loads(done.stdout)
    except ValueError:
        return done.returncode, {"text": done.stdout + done.stderr}


def main():
    rondo = str(pathlib.Path(sys.argv[1]).resolve())
    os.chdir(ROOT)
    violated, held = set(), set()
    with tempfile.TemporaryDirectory() as folder:
        for program in sorted([*ROOT.glob("examples/koord/*.koord"), *ROOT.glob("tests/mutants/*.koord")]):
            name = program.stem
            saved = pathlib.Path(folder) / f"{name}.json"
            status, explored = run(rondo, "explore", "--json", "--states", 200_000, "--save", saved, program)
            check(status in (0, 1, 3), f"{name}: explore ends with {status}")
            kinds = {d["kind"] for d in explored.get("diagnostics", [])}
            if "koord-not-executable" in kinds:
                continue
            status, proof = run(rondo, "prove", "--json", "--no-cache", "--timeout", 5, program)
            check(status in (0, 1, 3), f"{name}: prove ends with {status}")
            verdicts = {i["name"]: i["verdict"] for i in proof["invariants"]}
            for size in explored["explored"]:
                broken = size["broken"] or ""
                if broken.startswith("invariant "):
                    violated.add(name)
                    check(verdicts[broken[len("invariant "):]] != "proved", f"{name}: {broken} is proved, and violated with {size['robots']} robots")
                if broken == "well-defined":
                    violated.add(name)
                    check(verdicts["well-defined"] != "proved", f"{name}: operations are proved to be defined, and fail")
                if not broken:
                    held.add(name)
            if saved.exists():
                status, replayed = run(rondo, "replay", "--json", saved)
                check(status == 0 and replayed["same"], f"{name}: its run does not replay: {replayed}")
    check({"leader", "addnums", "mutex", "hvac", "lineform", "shapeform"} <= held - violated, f"examples hold: {held - violated}")
    check({"mutex_naive", "leader_no_atomic", "mutex_not_exclusive", "hvac_not_urgent"} <= violated, f"mutants fail: {violated}")
    print(f"{checks[0]} passed, {checks[1]} failed; violated: {', '.join(sorted(violated))}")
    return 1 if checks[1] else 0


if __name__ == "__main__":
    sys.exit(main())
