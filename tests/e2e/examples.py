#!/usr/bin/env python3
"""Every example gets the verdict that its header states, with two solvers; every mutant is not proved.

  examples.py RONDO
A header line reads `# expect: proved ...`, `# expect: refuted ...` or `# expect: ... not inductive ...`.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
# Mutants that take a minute each with sanitizers, and fail as the others of delivery do: for `./dev nightly`.
SLOW = {"delivery_drift", "delivery_margin", "delivery_no_atomic", "delivery_no_start", "delivery_no_summary"}


def prove(rondo, *args):
    done = subprocess.run([rondo, "prove", "--no-cache", "--json", *args], cwd=ROOT, capture_output=True, text=True, timeout=600)
    try:
        return done.returncode, json.loads(done.stdout)
    except ValueError:
        return done.returncode, {"invariants": [], "diagnostics": [], "output": done.stdout + done.stderr}


def verdicts(report):
    return {row["verdict"] for row in report["invariants"]}


def main():
    rondo = str(pathlib.Path(sys.argv[1]).resolve())
    passed, failed = 0, 0

    def check(name, good, why):
        nonlocal passed, failed
        if good:
            passed += 1
        else:
            failed += 1
            print(f"{name}: {why}")

    examples = sorted((ROOT / "examples/koord").glob("*.koord"))
    for path in examples:
        expect = re.search(r"^# expect: (.*)$", path.read_text(), re.M)
        check(path.name, expect, "states no expected verdict")
        if not expect:
            continue
        status, report = prove(rondo, str(path), "--cross-check", "cvc5")
        got = verdicts(report)
        if expect.group(1).startswith("proved"):
            check(path.name, status == 0 and got == {"proved"}, f"status {status}, {got} {report.get('output', '')}")
        else:
            wanted = "not inductive" if "not inductive" in expect.group(1) else "refuted"
            check(path.name, status == 1 and wanted in got, f"status {status}, {got}, wanted {wanted}")
        check(path.name, report.get("cross_checked", 0) > 0, "nothing was cross-checked")
        errors = [d["message"] for d in report["diagnostics"] if d["severity"] == "warning"]
        if expect.group(1).startswith("proved"):
            check(path.name, not errors, f"warnings: {errors}")

    # The same verdict for any fixed number of robots.
    for robots in (1, 2, 3, 500):
        status, report = prove(rondo, "examples/koord/lineform.koord", "--robots", str(robots))
        check(f"lineform for {robots}", status == 0 and verdicts(report) == {"proved"}, f"status {status}")
        status, report = prove(rondo, "examples/koord/mutex_naive.koord", "--robots", str(robots))
        wanted = 0 if robots == 1 else 1
        check(f"mutex_naive for {robots}", status == wanted, f"status {status}")

    # Without the invariants that only say why, helpers are found; and those are enough.
    for name, left_out in (("crossing", ("others", "sent")), ("consensus", ("same",)), ("coverage", ("mine", "order"))):
        text = (ROOT / f"examples/koord/{name}.koord").read_text()
        for invariant in left_out:
            text, gone = re.subn(rf"^invariant {invariant}:.*\n(?:    .*\n)*", "", text, flags=re.M)
            check(name, gone == 1, f"has no invariant {invariant}")
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / f"{name}.koord"
            program.write_text(text)
            status, report = prove(rondo, "--helpers", str(program))
            helpers = report.get("helpers", {})
            check(f"helpers of {name}", status == 1 and helpers.get("found") and helpers["invariants"], f"status {status}: {helpers}")
            program.write_text(text + "\n" + "\n".join(helpers.get("invariants", [])) + "\n")
            status, report = prove(rondo, str(program))
            check(f"{name} with its helpers", status == 0 and verdicts(report) == {"proved"}, f"status {status}")
    status, report = prove(rondo, "--helpers", "examples/koord/mutex_naive.koord")
    check("helpers of what is refuted", status == 1 and report["helpers"]["found"] is False, f"{report.get('helpers')}")

    for path in sorted((ROOT / "tests/mutants").glob("*.koord")):
        if path.stem in SLOW and "RONDO_CASES" not in os.environ:
            continue
        status, report = prove(rondo, str(path))
        got = verdicts(report)
        errors = [d for d in report["diagnostics"] if d["severity"] == "error"]
        check(path.name, report["invariants"] and status in (1, 3) and got != {"proved"} and errors, f"status {status}, {got}")

    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
