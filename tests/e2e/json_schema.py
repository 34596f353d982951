#!/usr/bin/env python3
"""What every verb writes with --json is what the published schema says (docs/schema/rondo-1.json): results, errors, files that are not there.

  json_schema.py RONDO
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import jsonschema

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
RONDO = str(pathlib.Path(sys.argv[1]).resolve())
SCHEMA = json.loads((ROOT / "docs/schema/rondo-1.json").read_text())
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)
KOORD, CHOREO = "examples/koord", "examples/choreo"
results = {"passed": 0, "failed": 0}
commands = set()


def check(name, good, *why):
    results["passed" if good else "failed"] += 1
    if not good:
        print(f"{name}:", *(str(w)[:600] for w in why))


def valid(*arguments):
    """The object, which is as the schema says and has the status of the process."""
    done = subprocess.run([RONDO, *map(str, arguments), "--json"], capture_output=True, text=True, timeout=300, cwd=ROOT)
    name = " ".join(map(str, arguments))
    try:
        found = json.loads(done.stdout)
    except ValueError:
        check(name, False, "no JSON", done.stdout, done.stderr)
        return {}
    errors = [f"{'/'.join(map(str, e.absolute_path))}: {e.message}" for e in VALIDATOR.iter_errors(found)]
    check(name, not errors and found.get("status") == done.returncode, done.returncode, found.get("status"), errors)
    commands.add(found.get("command", "").split(" ")[0])
    return found


def main():
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    # It says no to what it does not know.
    for bad in ({}, {"rondo": 1, "command": "check", "status": 0}, {"rondo": 1, "command": "check", "status": 0, "diagnostics": [], "more": 1},
                {"rondo": 2, "command": "check", "status": 0, "diagnostics": []}, {"rondo": 1, "command": "chek", "status": 0, "diagnostics": []},
                {"rondo": 1, "command": "check", "status": 0, "diagnostics": [{"kind": "x"}]}):
        check(f"refuses {bad}", not VALIDATOR.is_valid(bad))
    os.environ.update(ROS_LOCALHOST_ONLY="1", ROS_DOMAIN_ID="77")
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        valid("new", folder / "first")
        valid("new", folder / "first")  # is there already
        for example in ("lineform", "mutex_naive", "delivery", "hvac"):
            valid("check", f"{KOORD}/{example}.koord")
            valid("prove", f"{KOORD}/{example}.koord")
        valid("prove", f"{CHOREO}/handover.rondo")
        valid("prove", "tests/mutants/addnums_no_atomic.koord", "--reach", 4)
        valid("ast", f"{KOORD}/lineform.koord")
        valid("explain")
        valid("explain", "koord-lost-update")
        valid("explore", f"{KOORD}/mutex.koord", "--robots", 2)
        found = valid("explore", f"{KOORD}/mutex_naive.koord", "--save", folder / "bad.json", "--trace", folder / "bad.mcap")
        check("explore: a run", "run" in found)
        valid("replay", folder / "bad.json")
        valid("view", folder / "bad.json")
        valid("simulate", f"{KOORD}/mapping", "--duration", 3, "--trace", folder / "m.mcap")
        valid("simulate", f"{KOORD}/lineform", "--duration", 3, "--network", f"{KOORD}/radio.toml")
        valid("simulate", f"{CHOREO}/handover.rondo", "--trace", folder / "h.mcap")
        valid("simulate", f"{CHOREO}/fetch.rondo", "--runs", 3)
        valid("replay", folder / "m.mcap")
        valid("replay", folder / "h.mcap")
        valid("view", folder / "h.mcap")
        valid("campaign", f"{KOORD}/lineform.koord", "--runs", 2)
        valid("build", f"{KOORD}/lineform.koord", "--robots", 3, "-o", folder / "cpp")
        valid("keys", f"{KOORD}/lineform.koord", "-o", folder / "keys")
        valid("reach", "models/room.rondo")
        valid("reach", "models/room.rondo", "--statistical", 20)
        valid("infer", "regions", f"{CHOREO}/shuttle.rondo")
        valid("graph", f"{CHOREO}/sorting.rondo")
        valid("project", f"{CHOREO}/sorting.rondo", "carrier")
        script = next(iter(sorted((ROOT / "examples/smt").glob("*.smt2"))))
        valid("solve", script)
        valid("launch", f"{CHOREO}/fetch.rondo", "--duration", 1, "--logs", folder / "logs")
        valid("replay", *sorted((folder / "logs").glob("*.mcap")))
        # Nothing is there, or it is something else.
        (folder / "text.mcap").write_text("this is none")
        (folder / "bad.koord").write_text("Step:\n  eff: x =\n")
        (folder / "bad.rondo").write_text("world {")
        none, bad, motion, trace = folder / "none.koord", folder / "bad.koord", folder / "bad.rondo", folder / "text.mcap"
        for file in (none, bad, motion):
            for verb in ("check", "prove", "simulate"):
                valid(verb, file)
        for file in (none, bad):
            for arguments in (("ast", file), ("explore", file), ("campaign", file), ("build", file, "-o", folder / "no"), ("keys", file, "-o", folder / "no"),
                              ("run", file, "--robot", "a"), ("launch", file), ("doctor", file)):
                valid(*arguments)
        for arguments in (("run", motion, "--robot", "a"), ("launch", motion), ("graph", motion), ("project", motion, "a"), ("infer", "regions", motion), ("reach", motion),
                          ("replay", trace), ("view", trace), ("view", none), ("replay", none), ("solve", none), ("certify", none), ("certify", bad), ("solve", bad),
                          ("run", f"{CHOREO}/handover.rondo", "--robot", "nobody"), ("launch", f"{CHOREO}/handover.rondo", "--choreography", "None")):
            valid(*arguments)
    # Each verb that has the option was tried.
    listed = subprocess.run([RONDO, "--help"], capture_output=True, text=True).stdout
    for verb in re.findall(r"^  ([a-z]+)  ", listed[listed.index("Subcommands"):] if "Subcommands" in listed else listed, re.M):
        helped = subprocess.run([RONDO, "help", verb], capture_output=True, text=True).stdout
        if "--json" in helped:
            check(f"{verb} was tried", verb in commands, sorted(commands))
    print(f"{results['passed']} passed, {results['failed']} failed")
    return 1 if results["failed"] else 0


sys.exit(main())
