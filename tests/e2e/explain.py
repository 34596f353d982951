#!/usr/bin/env python3
"""The minimal example of every diagnostic kind reports exactly that kind, at its severity.

  explain.py RONDO
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile


def main():
    rondo = str(pathlib.Path(sys.argv[1]).resolve())
    passed, failed = 0, 0
    listed = json.loads(subprocess.run([rondo, "explain", "--json"], capture_output=True, check=True).stdout)["kinds"]
    with tempfile.TemporaryDirectory() as folder:
        # A solver that always says what is wrong, to make a disagreement.
        liar = pathlib.Path(folder) / "liar"
        liar.write_text("#!/bin/sh\ncat > /dev/null\necho sat\n")
        liar.chmod(0o755)
        for kind in listed:
            info = json.loads(subprocess.run([rondo, "explain", "--json", kind["kind"]], capture_output=True, check=True).stdout)
            motion = kind["kind"].startswith(("robot-", "choreo-", "process-", "reach-"))
            suffix = ".smt2" if info["verb"] in ("solve", "certify") else ".rondo" if motion else ".koord"
            args = [rondo, *info["verb"].split(), "--json"]
            # An example of several files: each begins with a line `== NAME`.
            for part in re.split("^== ", "== " + kind["kind"] + suffix + "\n" + info["example"], flags=re.MULTILINE)[1:]:
                name, text = part.split("\n", 1)
                program = pathlib.Path(folder) / name
                program.write_text(text)
                # The fleet is found beside the program.
                if program.suffix != ".toml":
                    args.append(str(program))
            if info["verb"] == "prove":
                args += ["--no-cache", "--timeout", "5"]
            if kind["kind"] == "file-unreadable":
                pathlib.Path(args[-1]).unlink()
            if kind["kind"] == "koord-disagreement":
                args += ["--cross-check", str(liar)]
            done = subprocess.run(args, capture_output=True, text=True, timeout=300)
            try:
                kinds = {(d["kind"], d["severity"]) for d in json.loads(done.stdout)["diagnostics"]}
            except ValueError:
                kinds = {(done.stdout + done.stderr, "")}
            if kind["kind"] == "file-more":  # it is one of many
                kinds = {k for k in kinds if k[1] == "note"}
            if kinds == {(kind["kind"], kind["severity"])}:
                passed += 1
            else:
                failed += 1
                print(f"{kind['kind']}: the example reports {sorted(kinds)}")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed or passed < 40 else 0


if __name__ == "__main__":
    sys.exit(main())
