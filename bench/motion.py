#!/usr/bin/env python3
"""Choreographies proved from end to end: structure, obligations, certificates, processes.

  motion.py RONDO

Times are those of whole processes, with an empty cache and then with a full one, the best of three. The figures of the paper
(OOPSLA 2020, Table 3 and Figure 7; six cores of an i7-7700K) are for the compatibility of motions alone.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAPER = {"fetch": 7, "handover": 70, "twist": 203, "underpass": 114, "sorting": 2410}
BARS = {"fetch": 0.5, "handover": 1, "twist": 1, "underpass": 2, "sorting": 5, "lanes29": 0.5}
RUNS = 3


def prove(rondo, path, cache):
    env = {**os.environ, "XDG_CACHE_HOME": str(cache)}
    start = time.perf_counter()
    process = subprocess.Popen([rondo, "prove", "--json", str(path)], env=env, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    output = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    took = time.perf_counter() - start
    proofs = [o for c in json.loads(output)["choreographies"] for o in c["obligations"] if o["required"]]
    return took, os.waitstatus_to_exitcode(status), proofs, usage.ru_maxrss / 1024


def main():
    rondo = str(pathlib.Path(sys.argv[1]).resolve())
    cases = [(p.stem, p) for p in sorted((ROOT / "examples/choreo").glob("*.rondo")) if p.read_text().startswith("# check: ok\n")]
    slow = 0
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder) / "examples/choreo"
        place.mkdir(parents=True)
        (pathlib.Path(folder) / "models").symlink_to(ROOT / "models")
        for count, options in ((10, []), (29, []), (50, []), (100, []), (10, ["--together"]), (29, ["--together"]), (100, ["--together"])):
            path = place / f"lanes{count}{'t' if options else ''}.rondo"
            with open(path, "w", encoding="utf-8") as out:
                subprocess.run([sys.executable, ROOT / "examples/choreo/lanes.py", str(count), *options], stdout=out, check=True)
            cases.append((path.stem, path))
        print(f"{'':12} {'cold':>8} {'warm':>8}  obligations  certified   memory    bar   paper   ratio")
        for name, path in cases:
            cold, warm, memory, status = float("inf"), float("inf"), 0, 0
            for run in range(RUNS):
                cache = pathlib.Path(folder) / f"cache-{name}-{run}"
                took, status, proofs, used = prove(rondo, path, cache)
                cold, memory = min(cold, took), max(memory, used)
                warm = min(warm, prove(rondo, path, cache)[0])
            certified = sum(p["certified"] for p in proofs)
            bar, paper = BARS.get(name), PAPER.get(name)
            note = "" if status == 0 else f"  status {status}"
            slow += bool(bar and cold > bar) or warm > 0.2 and bool(bar) or status != 0
            print(f"{name:12} {cold:6.2f} s {warm:6.2f} s  {len(proofs):11}  {certified:9}  {memory:4.0f} MiB"
                  f"  {f'{bar} s' if bar else '':>5}  {f'{paper} s' if paper else '':>6}  {f'1/{paper / cold:.0f}' if paper else '':>6}{note}")
    return 1 if slow else 0


if __name__ == "__main__":
    sys.exit(main())
