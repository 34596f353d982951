#!/usr/bin/env python3
"""The interval solver on collision questions: verdict, time, boxes; beside dReal where one is installed.

  bench/solver.py RONDO [--queries FOLDER] [--dreal PROGRAM] [--limit SECONDS]

The scenes are generated (bench/scenes.py). FOLDER holds scenarios of recorded queries, each a folder with *.smt2 and an
index.tsv that gives the expected answers; each scenario is one process on all cores. Times of single questions are those
that the solver reports, on one thread; dReal's are of its process, with precision 0.001.
"""
import csv
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import scenes


def option(name, default=None):
    return sys.argv[sys.argv.index(name) + 1] if name in sys.argv else default


def rondo_answer(rondo, path, limit, *extra):
    done = subprocess.run([rondo, "solve", "--json", "--solver", "icp", "--jobs", "1", "--timeout", str(limit), *extra, str(path)],
                          capture_output=True, text=True, check=False)
    answer = json.loads(done.stdout)["files"][0]["answers"][0]
    return answer["answer"], answer["seconds"], answer["boxes"]


def dreal_answer(dreal, path, limit):
    start = time.perf_counter()
    try:
        done = subprocess.run([dreal, str(path)], capture_output=True, text=True, timeout=limit, check=False)
        said = done.stdout.split("\n")[0].split(" ")[0] or "error"
    except subprocess.TimeoutExpired:
        said = "time-out"
    return said, time.perf_counter() - start


def generated(rondo, dreal, limit, folder):
    head = f"{'scene':12} {'answer':9} {'time':>9} {'boxes':>9} {'boxes/s':>9}   {'no lemmas':>9} {'boxes':>9}"
    print(head + ("   dReal" if dreal else ""))
    for family, make, gaps in scenes.FAMILIES:
        for gap in gaps:
            path = pathlib.Path(folder) / f"{family}_{gap}.smt2"
            path.write_text(make(gap))
            answer, seconds, boxes = rondo_answer(rondo, path, limit)
            _, plain, plain_boxes = rondo_answer(rondo, path, limit, "--no-lemmas")
            expected = "unsat" if gap > 0 else "sat"
            mark = "" if answer == expected else f"  EXPECTED {expected}"
            line = (f"{path.stem:12} {answer:9} {seconds:7.4f} s {boxes:9} {boxes / max(seconds, 1e-9) / 1e6:7.2f} M"
                    f"   {plain:7.4f} s {plain_boxes:9}{mark}")
            if dreal:
                said, took = dreal_answer(dreal, path, limit)
                line += f"   {said} {took:.2f} s ({took / max(seconds, 1e-4):.0f} x)"
            print(line, flush=True)


def recorded(rondo, folder, limit):
    print(f"\n{'scenario':24} {'queries':>7} {'as expected':>11} {'otherwise':>9} {'undecided':>9} {'time':>9}")
    for scenario in sorted(p for p in pathlib.Path(folder).iterdir() if (p / "index.tsv").exists()):
        with open(scenario / "index.tsv", encoding="utf-8") as index:
            expected = {row["file"]: row["expected"] for row in csv.DictReader(index, delimiter="\t") if row["file"] != "-"}
        files = [str(scenario / name) for name in expected]
        start = time.perf_counter()
        done = subprocess.run([rondo, "solve", "--json", "--solver", "icp", "--timeout", str(limit), *files],
                              capture_output=True, text=True, check=False)
        took = time.perf_counter() - start
        answers = {pathlib.Path(f["file"]).name: f["answers"][0]["answer"] for f in json.loads(done.stdout)["files"]}
        good = sum(answers[f] == e for f, e in expected.items())
        other = sum(answers[f] != e and answers[f] in ("sat", "unsat") for f, e in expected.items())
        print(f"{scenario.name:24} {len(files):7} {good:11} {other:9} {len(files) - good - other:9} {took:7.3f} s", flush=True)


def main():
    rondo = str(pathlib.Path(sys.argv[1]).resolve())
    limit = float(option("--limit", "60"))
    dreal = option("--dreal", shutil.which("dreal"))
    with tempfile.TemporaryDirectory() as folder:
        generated(rondo, dreal, limit, folder)
    if option("--queries"):
        recorded(rondo, option("--queries"), limit)


if __name__ == "__main__":
    main()
