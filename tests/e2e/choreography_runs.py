#!/usr/bin/env python3
"""Choreographies run: every example without an incident, each fault with one; traces replay, and the reference reader reads them.

  choreography_runs.py RONDO

RONDO_CASES: how many runs of each example, 1000 at most, for a longer search.
"""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from motion_faults import EXAMPLES, FAULTS, faulty, stage

RONDO = str(pathlib.Path(sys.argv[1]).resolve())
RUNS = min(1000, int(os.environ.get("RONDO_CASES", "0")))
results = {"passed": 0, "failed": 0}

# What shows in a run, by the kind that a proof reports. What no run can show: that a contract cannot be kept.
SHOWN = {
    "choreo-region": {"region", "fork", "collision"},
    "choreo-precondition": {"precondition"},
    "choreo-collision": {"collision"},
    "choreo-no-alternative": {"choice"},
}


def check(name, good, *why):
    results["passed" if good else "failed"] += 1
    if not good:
        print(f"{name}:", *(str(w)[:600] for w in why))


def run(*args):
    return subprocess.run([RONDO, *map(str, args)], capture_output=True, text=True, timeout=1200)


def simulate(path, *args):
    done = run("simulate", path, "--json", *args)
    try:
        return done.returncode, json.loads(done.stdout)
    except ValueError:
        return done.returncode, {"incidents": [], "ended": {}, "trouble": done.stdout + done.stderr}


def examples():
    for example in sorted(EXAMPLES.glob("*.rondo")):
        if example.read_text().split("\n", 1)[0] != "# check: ok":
            continue
        for more in ([], ["--projections"]):
            status, report = simulate(example, "--runs", RUNS or 1, "--seed", 1, "--duration", 60 if RUNS else 20, *more)
            ended = set(report["ended"]) <= {"end", "time"}
            check(f"{example.name} {more}", status == 0 and not report["incidents"] and ended and report["motions"] > 0, report)


def faults(folder):
    place = stage(folder)
    for name, example, old, new, kind in FAULTS:
        if kind.startswith("process-"):
            continue
        path = place / f"{example}.rondo"
        path.write_text(faulty(example, old, new, kind))
        # Of some only every fifth run shows them.
        status, report = simulate(path, "--runs", RUNS or {"choreo-no-alternative": 20, "choreo-collision": 6}.get(kind, 2), "--duration", 30)
        if kind == "choreo-contract":
            check(name, status == 3 and set(report["ended"]) == {"lost"} and "may end" in report["lost"], report)
            continue
        shown = {i["kind"] for i in report["incidents"]}
        check(name, status == 1 and shown & SHOWN[kind], status, report)
        # The run of the seed shows it again, alone.
        if report["incidents"]:
            first = report["incidents"][0]
            status, alone = simulate(path, "--seed", first["seed"], "--duration", 30)
            same = [i for i in alone["incidents"] if i["what"] == first["what"]]
            check(f"{name} by its seed", status == 1 and same and same[0]["first"] == first["first"], alone)
    status, report = simulate(place / "handover.rondo", "--choreography", "Nothing")
    check("another name", status == 1 and "no choreography `Nothing`" in report["diagnostics"][0]["message"], report)


def cases():
    """Small ones that were once wrong: alarms without a reason, faults that did not show, crashes."""
    for path in sorted((pathlib.Path(__file__).parent / "choreographies").glob("*.rondo")):
        wanted, *kinds = path.read_text().split("\n", 1)[0].removeprefix("# runs: ").split()
        status, report = simulate(path, "--runs", RUNS or (20 if kinds else 5), "--duration", 30)
        shown = {i["kind"] for i in report["incidents"]}
        check(path.name, status == int(wanted) and set(kinds) <= shown and (kinds or not shown), status, report)


def traces(folder):
    trace = pathlib.Path(folder) / "handover.mcap"
    done = run("simulate", EXAMPLES / "handover.rondo", "--trace", trace, "--seed", 3)
    check("a trace", done.returncode == 0 and "15 s, 6 messages, 14 motions" in done.stdout, done.stdout, done.stderr)
    done = run("replay", trace)
    check("replay", done.returncode == 0 and "the same run, bit for bit" in done.stdout, done.stdout, done.stderr)
    topics = ros_messages(trace)
    for topic in ("/cart/pose", "/arm/joint_states", "/tf", "/bodies", "/world"):
        check(topic, topics.get(topic), sorted(topics))
    frames = {m.transforms[0].child_frame_id for m in topics["/tf"]}
    check("frames", {"cart", "cart/base", "cart/top", "arm/upper", "arm/effector", "carrier/base"} <= frames, frames)
    first, last = topics["/carrier/joint_states"][0], topics["/carrier/joint_states"][-1]
    check("it comes home", list(first.name) == ["x", "y", "theta"] and all(abs(p) < 0.02 for p in last.position), last.position)
    # The carrier was put at 1.15 m, and looks back.
    pose = topics["/carrier/pose"][0].pose
    check("where it was put", abs(pose.position.x - 1.15) < 1e-9 and abs(pose.orientation.z) > 0.999, pose)
    kinds = {(m.ns, m.type) for array in topics["/bodies"] for m in array.markers}
    check("bodies", {("cart", 11), ("arm", 3), ("carrier", 1)} <= kinds, kinds)
    for options, wanted in (([], "RetractArm"), (["--scene", "7.5"], "Handover after 7."), (["--paths"], "<svg"), (["--timeline"], "taken")):
        picture = pathlib.Path(folder) / "picture.svg"
        done = run("plot", trace, "--svg", picture, *options)
        check(f"plot {options}", done.returncode == 0 and wanted in picture.read_text(), done.stderr)
    done = run("plot", trace, "--svg", picture, "--map")
    check("no map", done.returncode == 1 and "has no map" in done.stderr, done.stderr)
    # Another seed is another run; a flipped bit is noticed.
    bytes_ = trace.read_bytes()
    other = pathlib.Path(folder) / "other.mcap"
    other.write_bytes(bytes_[: len(bytes_) // 2] + bytes([bytes_[len(bytes_) // 2] ^ 1]) + bytes_[len(bytes_) // 2 + 1:])
    done = run("replay", other)
    check("a flipped bit", done.returncode == 1, done.stdout, done.stderr)
    done = run("simulate", EXAMPLES / "handover.rondo", "--trace", folder)
    check("a folder for a trace", done.returncode == 1 and "cannot write" in done.stderr, done.stderr)
    # A run that was interrupted is made again up to there.
    cut = pathlib.Path(folder) / "cut.mcap"
    process = subprocess.Popen([RONDO, "simulate", EXAMPLES / "producer.rondo", "--duration", "1e6", "--trace", cut], stdout=subprocess.DEVNULL)
    while process.poll() is None and not (cut.with_suffix(".mcap.partial").exists() and cut.with_suffix(".mcap.partial").stat().st_size > 100_000):
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    check("interrupted", process.wait(60) == 3)
    done = run("replay", cut)
    check("replay of what was interrupted", done.returncode == 0 and "the same run" in done.stdout, done.stdout, done.stderr)
    own = pathlib.Path(folder) / "own.rondo"
    own.write_text((pathlib.Path(__file__).parent / "choreographies/fast.rondo").read_text())
    done = run("simulate", own, "--trace", own)
    check("a trace over its source", done.returncode == 1 and own.read_text().startswith("# runs"), done.stderr)
    for args in (["--seed", "-1"], ["--duration", "nan"], ["--runs", "0"]):
        done = run("simulate", own, *args)
        check(f"{args}", done.returncode == 2, done.stderr)
    for args, wanted in ((["--runs", "3", "--trace", trace], "--trace"), (["--fleet", "x.toml"], "only Koord programs"),
                         (["--network", "x.toml"], "only Koord programs")):
        done = run("simulate", EXAMPLES / "handover.rondo", *args)
        check(f"{args}", done.returncode == 2 and wanted in done.stderr, done.stderr)
    done = run("simulate", EXAMPLES.parent / "koord/mutex.koord", "--runs", "3")
    check("a program", done.returncode == 2 and "only choreographies" in done.stderr, done.stderr)


def ros_messages(path):
    """By topic, what the reference reader decodes."""
    topics = {}
    with open(path, "rb") as stream:
        for _, channel, _, message in make_reader(stream, decoder_factories=[DecoderFactory()]).iter_decoded_messages(
                topics=["/tf", "/bodies", "/world", "/cart/pose", "/carrier/pose", "/arm/joint_states", "/carrier/joint_states"]):
            topics.setdefault(channel.topic, []).append(message)
    return topics


with tempfile.TemporaryDirectory() as folder:
    examples()
    faults(folder)
    cases()
    traces(folder)
print(f"{results['passed']} passed, {results['failed']} failed")
sys.exit(1 if results["failed"] else 0)
