#!/usr/bin/env python3
"""Every choreography among the examples is proved, and none with a fault is: each for the reason that is to be expected.

  motions.py RONDO
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from motion_faults import EXAMPLES, FAULTS, ROOT, faulty, stage

RONDO = str(pathlib.Path(sys.argv[1]).resolve())
results = {"passed": 0, "failed": 0}


def check(name, good, why=""):
    results["passed" if good else "failed"] += 1
    if not good:
        print(f"{name}: {why}")


def prove(path, *args):
    done = subprocess.run([RONDO, "prove", "--json", "--no-cache", *args, str(path)], capture_output=True, text=True, timeout=1200)
    return done.returncode, json.loads(done.stdout)


for example in sorted(EXAMPLES.glob("*.rondo")):
    if example.read_text().split("\n", 1)[0] != "# check: ok":
        continue
    status, report = prove(example, "--timeout", "60")  # on a machine that has other things to do, too
    proofs = [o for c in report["choreographies"] for o in c["obligations"] if o["required"]]
    check(example.name, status == 0 and proofs and all(o["verdict"] == "proved" and o["certified"] for o in proofs),
          f"status {status}: " + "; ".join(d["message"] for d in report["diagnostics"]))

with tempfile.TemporaryDirectory() as folder:
    place = stage(folder)
    for name, example, old, new, kind in FAULTS:
        if example == "sorting" and "RONDO_CASES" not in os.environ:
            continue  # half a minute under sanitizers
        text = faulty(example, old, new, kind)
        check(name, text is not None, "nothing to replace")
        path = place / f"{example}.rondo"
        path.write_text(text)
        status, report = prove(path, "--timeout", "5", "--no-certify")
        kinds = {d["kind"] for d in report["diagnostics"]}
        check(name, status == 1 and kind in kinds, f"status {status}, {sorted(kinds)}")
        refuted = [o for c in report["choreographies"] for o in c["obligations"] if o["verdict"] == "refuted" and o["required"]]
        check(f"{name}: no witness", kind.startswith("process-") or any("state" in o for o in refuted) or kind == "choreo-contract", str(refuted)[:300])
    # Without regions, they are found.
    for example in ("lanes4", "fetch", "producer"):
        text = (EXAMPLES / f"{example}.rondo").read_text()
        path = place / f"{example}.rondo"
        path.write_text(re.sub(r"(thread[^{\n]*?)\s+region [^{]*?(?=\{)", r"\1 ", text))
        status, report = prove(path)
        check(f"{example} without regions", status == 0 and report["choreographies"][0]["regions"], f"status {status}")

# The listings of the tutorial get the verdicts that it states.
with tempfile.TemporaryDirectory() as folder:
    text = (ROOT / "docs/tutorial-handover.md").read_text()
    listings = re.findall(r"<!-- prove: (\d) ?(\S*) -->\n```\n(.*?)```", text, re.DOTALL)
    check("tutorial", len(listings) == 4, str(len(listings)))
    for i, (wanted, kind, listing) in enumerate(listings):
        path = pathlib.Path(folder) / f"listing{i}.rondo"
        path.write_text(listing)
        status, report = prove(path)
        kinds = {d["kind"] for d in report["diagnostics"]}
        check(f"listing {i + 1} of the tutorial", status == int(wanted) and kinds == ({kind} - {""}), f"status {status}, {sorted(kinds)}")

    # What it suggests to try at the end.
    whole = pathlib.Path(folder) / "whole.rondo"
    whole.write_text(listings[-1][2].replace("70 deg", "130 deg").replace("in [0 deg, 90 deg]", "in [0 deg, 140 deg]"))
    status, report = prove(whole)
    check("an arm that bends too far", status == 3 and {d["kind"] for d in report["diagnostics"]} == {"choreo-no-region"}, f"status {status}")

print(f"{results['passed']} passed, {results['failed']} failed")
sys.exit(1 if results["failed"] else 0)
