#!/usr/bin/env python3
"""A second judge of the round protocol: what robots logged in campaigns is linearizable (main.go; needs Go).

  run.py RONDO [--runs N]

Each variable is a register. It is written in each round that became final: from when the first robot says what it does in it to when
the first robot calls the next state final. Who acts reads it: from when it has the state to when it acts. Then values are exchanged in
some of the histories, and the judge has to see that.
"""
import copy
import json
import pathlib
import subprocess
import sys
import tempfile

from mcap.reader import make_reader

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PROGRAMS = ("src/sim/campaign/testdata/fleet.koord", "examples/koord/mutex", "examples/koord/delivery", "examples/koord/lineform")


def lines_of(path):
    with open(path, "rb") as file:
        return [{**json.loads(message.data), "time": message.log_time} for _, channel, message in make_reader(file).iter_messages(topics=["/rondo/log"])]


def values_of(state):
    """The variables of a state, each robot's apart."""
    for name, value in state.items():
        if isinstance(value, list):
            for i, item in enumerate(value):
                yield f"{name}[{i}]", json.dumps(item)
        else:
            yield name, json.dumps(value)


def operations_of(lines):
    said, stored, final = {}, {}, {}  # by epoch and round, by that and robot, by round
    operations = []
    # What `init` left is a write before everything else.
    for line in lines:
        place = (line["epoch"], line["round"])
        if line["did"] == "contributed":
            said.setdefault(place, line["time"])
        elif line["did"] == "stored":
            stored.setdefault((place, line["robot"]), line)
        elif line["did"] == "committed" and line["round"] not in final:
            final[line["round"]] = True
            state = stored[(place, line["robot"])]["state"]
            begin = said.get((line["epoch"], line["round"] - 1), 0)
            for key, value in values_of(state):
                operations.append({"robot": -1, "key": key, "write": True, "value": value, "call": begin, "return": line["time"]})
        elif line["did"] == "acted":
            has = stored[(place, line["robot"])]
            for key, value in values_of(has["state"]):
                operations.append({"robot": line["robot"], "key": key, "write": False, "value": value, "call": has["time"], "return": line["time"]})
    # Porcupine wants each operation to take time.
    for o in operations:
        o["call"], o["return"] = 2 * o["call"], 2 * o["return"] + 1
    return operations


def planted(operations):
    """Somebody reads what was overwritten before it began; nothing if no variable ever changes."""
    by_key = {}
    for o in operations:
        by_key.setdefault(o["key"], []).append(o)
    for key, all_of_key in by_key.items():
        writes = [o for o in all_of_key if o["write"]]
        for old in writes:
            gone = max(w["return"] for w in writes if w["value"] == old["value"])
            for w in writes:
                if w["call"] <= gone:
                    continue
                for i, read in enumerate(operations):
                    if read["key"] == key and not read["write"] and read["call"] > w["return"]:
                        wrong = copy.deepcopy(operations)
                        wrong[i]["value"] = old["value"]
                        return wrong
    return None


def judge(binary, histories):
    text = "\n".join(json.dumps(h) for h in histories)
    return subprocess.run([binary], input=text, capture_output=True, text=True)


def main():
    rondo = str(pathlib.Path(sys.argv[1]).resolve())
    runs = int(sys.argv[sys.argv.index("--runs") + 1]) if "--runs" in sys.argv else 200
    build = ROOT / "build" / "linearizable"
    build.mkdir(parents=True, exist_ok=True)
    subprocess.run(["/usr/bin/go", "build", "-o", build / "judge", "."], cwd=HERE, check=True)
    failed = 0
    for program in PROGRAMS:
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([rondo, "campaign", program, "--runs", str(runs), "--logs", folder], cwd=ROOT, capture_output=True, text=True)
            assert done.returncode == 0, done.stdout + done.stderr
            histories = [{"name": p.stem, "operations": operations_of(lines_of(p))} for p in sorted(pathlib.Path(folder).glob("*.mcap"))]
        good = judge(build / "judge", histories)
        wrong = [{"name": h["name"], "operations": p} for h in histories if (p := planted(h["operations"]))]
        found = judge(build / "judge", wrong).stdout.splitlines()[:-1] if wrong else []
        failed += good.returncode != 0 or len(found) != len(wrong) or not wrong
        print(f"{pathlib.Path(program).stem}: {good.stdout.strip().splitlines()[-1]}; of {len(wrong)} planted faults {len(found)} found", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
