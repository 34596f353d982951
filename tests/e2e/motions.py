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

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
EXAMPLES = ROOT / "examples/choreo"
RONDO = str(pathlib.Path(sys.argv[1]).resolve())
results = {"passed": 0, "failed": 0}


def check(name, good, why=""):
    results["passed" if good else "failed"] += 1
    if not good:
        print(f"{name}: {why}")


def prove(path, *args):
    done = subprocess.run([RONDO, "prove", "--json", "--no-cache", *args, str(path)], capture_output=True, text=True, timeout=1200)
    return done.returncode, json.loads(done.stdout)


# Name, example, what is replaced by what, the kind that has to be reported.
FAULTS = [
    ("the carrier drives too far", "handover", "carrier: MoveCart(0, 0, 0, 0.5 m, 5 s)", "carrier: MoveCart(0, 0, 0, 0.65 m, 5 s)", "choreo-region"),
    ("both drive too far, together", "handover", "thread region x > 0.558 m { carrier: MoveCart(0, 0, 0, 0.5 m, 5 s) carrier: Idle() }", "thread region x > 0.558 m { carrier: MoveCart(0, 0, 90 deg, 0.5 m, 5 s) carrier: Idle() }", "choreo-precondition"),
    ("a region too small", "fetch", "cylinder(translate(2 m, 0, 0), 0.26 m", "cylinder(translate(2 m, 0, 0), 0.20 m", "choreo-region"),
    ("regions that overlap", "fetch", "not in cylinder(translate(2 m, 0, 0), 0.27 m", "not in cylinder(translate(2 m, 0, 0), 0.25 m", "choreo-region"),
    ("a wrong start", "fetch", "cart: MoveFromTo(point(0, 0, 0), point(2 m, 0, 0), 0)", "cart: MoveFromTo(point(0.5 m, 0, 0), point(2 m, 0, 0), 0)", "choreo-precondition"),
    ("guards that are not total", "producer", "when sensor.colour <= 0.5", "when sensor.colour <= 0.4", "choreo-no-alternative"),
    ("lanes too close", "lanes4", "at (0, 650 mm, 0)", "at (0, 400 mm, 0)", "choreo-region"),
    ("a wrong angle", "twist", "arm: Rotate(0, 120 deg - 0.35 rad,", "arm: Rotate(0, 120 deg - 0.30 rad,", "choreo-precondition"),
    ("a circle too small", "twist", "Swipe(0, 0, 0, 0.5 m,", "Swipe(0, 0, 0, 0.3 m,", "choreo-region"),
    ("a leg at another angle", "underpass", "carrier: MoveCart(0.67 m, 0, 45 deg, 0.5 m)", "carrier: MoveCart(0.67 m, 0, 60 deg, 0.5 m)", "choreo-precondition"),
    ("into the pillar", "underpass", "box(translate(-0.5 m, 0.5 m, 0) *", "box(translate(-0.3 m, 0.15 m, 0) *", "choreo-collision"),
    ("into the sensor", "sorting", "carrier: MoveCart(0, 0, 0, 0.5 m)", "carrier: MoveCart(0, 0, 0, 0.7 m)", "choreo-region"),
    ("a wrong argument in a process", "handover", "\n  MoveCart(0, 0, 0, 0.5 m, 5 s)\n", "\n  MoveCart(0, 0, 0, 0.4 m, 5 s)\n", "process-argument"),
    ("a message that is missing", "handover", "\n  send carrier.taken()\n", "\n", "process-step"),
    ("a guard of a process that is too strong", "fetch", "while dist((x, y), (0, 0)) > 0.1 m { MoveFromTo(point(2 m", "while dist((x, y), (0, 0)) > 2.5 m { MoveFromTo(point(2 m", "process-condition"),
    ("an arm that stands too low", "first", "cylinder(self, 10 cm, 15 cm, 40 cm)", "cylinder(self, 25 cm, 5 cm, 40 cm)", "choreo-collision"),
    ("a cart that turns into the arm", "first", "cart: Move(0, 1 m)", "cart: Move(0, 1.3 m)", "choreo-precondition"),
    ("an arm that reaches too low", "shuttle", "translate(0, 0, 30 cm) * rotate_z(a)", "translate(0, 0, 10 cm) * rotate_z(a) * translate(20 cm, 0, 0)", "choreo-collision"),
    ("a contract that cannot be kept", "shuttle", "post x == to and y == 0", "post x == to and y == 1 m", "choreo-contract"),
    ("a body larger than its footprint", "lanes4", "inner = 150 mm, outer = 250 mm", "inner = 350 mm, outer = 350 mm", "choreo-region"),
]

for example in sorted(EXAMPLES.glob("*.rondo")):
    if example.read_text().split("\n", 1)[0] != "# check: ok":
        continue
    status, report = prove(example, "--timeout", "60")  # on a machine that has other things to do, too
    proofs = [o for c in report["choreographies"] for o in c["obligations"] if o["required"]]
    check(example.name, status == 0 and proofs and all(o["verdict"] == "proved" and o["certified"] for o in proofs),
          f"status {status}: " + "; ".join(d["message"] for d in report["diagnostics"]))

with tempfile.TemporaryDirectory() as folder:
    # Faults, beside the models that the examples import.
    (pathlib.Path(folder) / "models").symlink_to(ROOT / "models")
    place = pathlib.Path(folder) / "examples/choreo"
    place.mkdir(parents=True)
    models = {m.name: m.read_text() for m in (ROOT / "models").glob("*.rondo")}
    for name, example, old, new, kind in FAULTS:
        if example == "sorting" and "RONDO_CASES" not in os.environ:
            continue  # half a minute under sanitizers
        text = (EXAMPLES / f"{example}.rondo").read_text()
        if old not in text:  # in a model
            text = re.sub(r'import "../../models/(.*)"\n', lambda m: models[m.group(1)], text)
        check(name, old in text, "nothing to replace")
        path = place / f"{example}.rondo"
        text = text.replace(old, new)
        if not kind.startswith("process-"):
            text = text.split("\nprocess ")[0] + "\n"
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

print(f"{results['passed']} passed, {results['failed']} failed")
sys.exit(1 if results["failed"] else 0)
