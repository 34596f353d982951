#!/usr/bin/env python3
"""What documents show is true: listings are files that are tried, and commands print what stands below them.

Above a listing, in comments: `part: FILE` makes it a part of that file, in order; `try: ARGS` runs `rondo ARGS` once the file is
whole, in a folder that also has `models` and `examples`, and wants status 0, or the one behind `-> `.

  documents.py RONDO
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
RONDO = str(pathlib.Path(sys.argv[1]).resolve())
results = {"passed": 0, "failed": 0, "listings": 0}
LISTING = re.compile(r"((?:^<!-- (?:part|try): [^\n]* -->\n)+)^```[^\n]*\n(.*?)^```", re.MULTILINE | re.DOTALL)


def check(name, good, why):
    results["passed" if good else "failed"] += 1
    if not good:
        print(f"{name}: {why}")


for document in sorted((ROOT / "docs").glob("*.md")):
    with tempfile.TemporaryDirectory() as folder:
        for name in ("models", "examples"):
            (pathlib.Path(folder) / name).symlink_to(ROOT / name)
        tries = []
        for comments, text in LISTING.findall(document.read_text()):
            results["listings"] += 1
            for kind, argument in re.findall(r"<!-- (part|try): (.*) -->", comments):
                if kind == "part":
                    with open(pathlib.Path(folder) / argument, "a") as file:
                        file.write(text)
                else:
                    tries.append(argument)
        for argument in tries:
            args, _, status = argument.partition(" -> ")
            environment = {**os.environ, "XDG_CACHE_HOME": folder, "NO_COLOR": "1"}
            done = subprocess.run([RONDO, *args.split()], cwd=folder, env=environment, capture_output=True, text=True, timeout=300)
            check(f"{document.name}: rondo {args}", done.returncode == int(status or 0), f"status {done.returncode}\n{done.stdout}{done.stderr}")

check("there are listings", results["listings"] >= 8, str(results["listings"]))
print(f"{results['passed']} passed, {results['failed']} failed")
sys.exit(1 if results["failed"] else 0)
