#!/usr/bin/env python3
"""Simulated examples: what they end with, that the same seed gives the same bytes whatever the number of threads, that
traces replay and are read by the reference reader of MCAP, and that broken files are refused.

  simulations.py RONDO
"""
import hashlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
from random import Random

from mcap_files import unsealed
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
checks = [0, 0]


def check(condition, what):
    checks[0 if condition else 1] += 1
    if not condition:
        print(f"FAILED: {what}")


def run(rondo, *args):
    return subprocess.run([rondo, *map(str, args)], capture_output=True, text=True, timeout=600)


def simulate(rondo, stem, *args):
    done = run(rondo, "simulate", stem, "--json", *args)
    return done.returncode, json.loads(done.stdout)


def examples(rondo, folder):
    expected = {
        # name: status, what is violated
        "lineform": (0, set()),
        "shapeform": (0, set()),
        "mapping": (0, set()),
        "crossing": (0, set()),
        "platoon": (0, set()),
        "coverage": (0, set()),
        "consensus": (0, set()),
        "auction": (0, set()),
        "warehouse": (0, set()),
        "hvac": (0, set()),
        # What is assumed of all points is not checked.
        "delivery": (3, set()),
    }
    for name, (status, violated) in expected.items():
        traces = []
        for jobs in (1, 2):
            trace = folder / f"{name}{jobs}.mcap"
            got, report = simulate(rondo, f"examples/koord/{name}", "--seed", 1, "--jobs", jobs, "--trace", trace)
            traces.append(hashlib.sha256(trace.read_bytes()).hexdigest())
            check(got == status, f"{name}: status {got}: {report['diagnostics']}")
            allowed = {v["what"] for v in report["violations"]}
            check(violated <= allowed and (violated or not allowed), f"{name}: violated {allowed}")
            check(not (folder / f"{name}{jobs}.mcap.partial").exists(), "a partial file is left")
        check(len(set(traces)) == 1, f"{name}: the trace depends on the number of threads")
        if name == "mapping":
            check(report["ended"] == "mapped" and report["map"]["wrong"] == 0 and report["map"]["missing"] == 0, f"the map: {report['map']}")
        if name == "lineform":
            check(report["collisions"] == 0, "lineform: robots touch")
        if name == "warehouse":
            check(report["ended"] == "quiet", "warehouse: every order is carried out")
            # Its models are in the trace: it replays where there are none, and can be drawn there.
            for verb in (["replay", trace], ["plot", trace, "--svg", folder / "warehouse.svg"]):
                done = subprocess.run([rondo, *map(str, verb)], cwd=folder, capture_output=True, text=True, timeout=600)
                check(done.returncode == 0, f"{verb[0]} elsewhere: {done.stdout}{done.stderr}")
        done = run(rondo, "replay", trace)
        check(done.returncode == 0 and "bit for bit" in done.stdout, f"{name}: {done.stdout}")
        read(trace, name)
    other, _ = simulate(rondo, "examples/koord/mapping", "--seed", 2, "--trace", folder / "other.mcap")
    check(other == 0, "mapping with another seed")
    check((folder / "other.mcap").read_bytes() != (folder / "mapping1.mcap").read_bytes(), "the seed changes nothing")


def read(trace, name):
    """By the reference implementation of MCAP and of the ROS 2 messages."""
    with open(trace, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        summary = reader.get_summary()
        counted = {}
        last = None
        topics = [c.topic for c in summary.channels.values() if c.schema_id and summary.schemas[c.schema_id].encoding == "ros2msg"]
        for schema, _, _, decoded in reader.iter_decoded_messages(topics=topics):
            counted[schema.name] = counted.get(schema.name, 0) + 1
            if schema.name == "geometry_msgs/msg/PoseStamped":
                q = decoded.pose.orientation
                check(abs(q.x**2 + q.y**2 + q.z**2 + q.w**2 - 1) < 1e-9, "a rotation of length 1")
                check(decoded.header.frame_id == "world", "the frame")
            if schema.name == "nav_msgs/msg/OccupancyGrid":
                last = decoded
            if schema.name == "sensor_msgs/msg/LaserScan" and counted[schema.name] == 1:
                check(len(decoded.ranges) == 360 and abs(decoded.angle_increment - 0.0174533) < 1e-5, "a scan")
        check(summary.statistics.message_count > 0, "the statistics")
        check(counted.get("visualization_msgs/msg/MarkerArray") == 1, f"{name}: the world: {counted}")
        if name == "mapping":
            check(last is not None and last.info.width == 22 and -1 not in last.data, "the last map")


def javascript(rondo, folder):
    """The reference reader of browsers agrees with itself and with that of Python, and notices a flipped bit."""
    modules = pathlib.Path("build/node").resolve()
    if not (modules / "node_modules").is_dir():
        print("skipped: @mcap/core (./dev setup)")
        return

    def read(trace):
        return subprocess.run(["node", "tests/e2e/read_mcap.mjs", modules, trace], capture_output=True, text=True)

    for name in ("mapping", "shapeform"):
        trace = folder / f"{name}1.mcap"
        done = read(trace)
        with open(trace, "rb") as file:
            summary = make_reader(file).get_summary()
        counts = {summary.channels[c].topic: n for c, n in summary.statistics.channel_message_counts.items() if n}
        check(done.returncode == 0 and json.loads(done.stdout) == counts, f"{name}: {done.stdout[:300]}{done.stderr}")
    bad = bytearray((folder / "mapping1.mcap").read_bytes())
    bad[len(bad) // 2] ^= 4
    (folder / "flipped.mcap").write_bytes(bad)
    check(read(folder / "flipped.mcap").returncode == 1, "@mcap/core reads a flipped bit")


def damaged(rondo, folder):
    good = (folder / "shapeform1.mcap").read_bytes()
    bad = folder / "bad.mcap"
    for what, data in [("cut off", good[: len(good) // 2]), ("empty", b""), ("text", b"hello"), ("only magic", good[:8])]:
        bad.write_bytes(data)
        for verb in (["replay", bad], ["plot", bad, "--svg", folder / "bad.svg"]):
            done = run(rondo, *verb)
            check(done.returncode == 1 and done.stderr + done.stdout != "", f"{what}: {verb[0]} ends with {done.returncode}")
    check(not (folder / "bad.svg").exists(), "a picture of nothing")
    # One position differs in its last bit: the message is named.
    at = good.find(b"/upper1/pose")
    at = good.find(b"world\0", at)
    changed = bytearray(good)
    changed[at + 20] ^= 1
    bad.write_bytes(changed)
    done = run(rondo, "replay", bad)
    check(done.returncode == 1 and "checksum" in done.stderr + done.stdout, f"a flipped bit: {done.stdout}{done.stderr}")
    bad.write_bytes(unsealed(bytes(changed)))
    done = run(rondo, "replay", bad)
    check(done.returncode == 1 and "differs: /" in done.stdout, f"a changed position: {done.stdout}")


def refused(rondo, folder):
    done = run(rondo, "simulate", "examples/koord/mutex")
    check(done.returncode == 1 and "mutex.toml" in done.stderr, f"a missing fleet: {done.stderr}")
    done = run(rondo, "simulate", "examples/koord/nosuch")
    check(done.returncode == 1 and "nosuch.koord" in done.stderr, f"a missing program: {done.stderr}")
    trace = folder / "never.mcap"
    done = run(rondo, "simulate", "src/sim/testdata/simulate/fail_ports.koord", "--trace", trace)
    check(done.returncode == 1 and not trace.exists() and not pathlib.Path(f"{trace}.partial").exists(), "a trace of a run that never began")
    done = run(rondo, "simulate", "examples/koord/shapeform", "--trace", "/proc/nosuch/x.mcap")
    check(done.returncode == 1 and "cannot write" in done.stderr, "a trace that cannot be written")


def interrupted(rondo, folder):
    trace = folder / "long.mcap"
    process = subprocess.Popen([rondo, "simulate", "examples/koord/lineform", "--duration", "1000000", "--trace", str(trace)], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    time.sleep(1)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    check(process.returncode == 3 and b"interrupted" in out, f"interrupted: {process.returncode}")
    check(trace.exists(), "what was simulated is kept")
    done = run(rondo, "plot", trace, "--distances", "--svg", folder / "long.svg")
    check(done.returncode == 0 and (folder / "long.svg").exists(), "it can be drawn")


def runs(rondo, folder):
    saved = folder / "run.json"
    done = run(rondo, "explore", "examples/koord/mutex_naive.koord", "--save", saved)
    check(done.returncode == 1, "the naive mutual exclusion")
    done = run(rondo, "replay", saved)
    check(done.returncode == 0, f"its run: {done.stdout}")
    text = saved.read_text()
    saved.write_text(text.replace('"Enter"', '"Leave"', 1))
    done = run(rondo, "replay", saved)
    check(done.returncode == 1 and "step 1" in done.stdout, f"a changed event: {done.stdout}")
    for broken in ("{}", "[]", "{", '{"format": "rondo-run/1"}', text.replace('"robots": 2', '"robots": 0'), text.replace('"kind": "start"', '"kind": 7')):
        saved.write_text(broken)
        done = run(rondo, "replay", saved)
        check(done.returncode == 1, f"a broken run ends with {done.returncode}: {broken[:40]}")
    # Bytes and values changed at random: never anything but "the same" or "differs".
    random = Random(7)
    trace = folder / "run.mcap"
    done = run(rondo, "explore", "examples/koord/mutex_naive.koord", "--trace", trace)
    check(run(rondo, "replay", trace).returncode == 0, "a run kept as a trace")
    for good in (text.encode(), trace.read_bytes()):
        for _ in range(150):
            data = bytearray(good)
            for _ in range(random.randint(1, 3)):
                at = random.randrange(len(data))
                data[at : at + random.randint(1, 4)] = random.choice([b"", b"0", b"[]", b"{}", b'"', b"null", b"-1", bytes([random.randrange(256)])])
            saved.write_bytes(data)
            done = run(rondo, "replay", saved)
            check(done.returncode in (0, 1), f"a damaged run ends with {done.returncode}: {done.stdout}{done.stderr}")
    # A counterexample of the prover that a search turns into a run, with the parameters of the counterexample.
    program = folder / "drift.koord"
    program.write_text("param int limit\nassume limit >= 2 and limit <= 2\nlocal:\n    int n = 0\n    int m = 0\nStep:\n    eff:\n        n = m\n        m = m + limit\ninvariant small: forall i in ID: n[i] <= 3\n")
    done = run(rondo, "prove", "--no-cache", "--reach", 6, "--json", program)
    report = json.loads(done.stdout)
    check(done.returncode == 1 and report["reach"][0]["found"], f"a run to the violation: {report.get('reach')}")
    done = run(rondo, "replay", report["reach"][0]["run"])
    check(done.returncode == 0, f"and its replay: {done.stdout}")
    done = run(rondo, "prove", "--no-cache", "--reach", 1, "--json", program)
    check(not json.loads(done.stdout)["reach"][0]["found"], "too few rounds")


def networks(rondo, folder):
    """Robots that agree over a network: the same run again, what happens to the team, mistakes in the file."""
    radio = "examples/koord/radio.toml"
    trace = folder / "network.mcap"
    status, report = simulate(rondo, "examples/koord/lineform", "--duration", 20, "--network", radio, "--trace", trace)
    check(status == 0, f"a network: {report['diagnostics']}")
    network = report["network"]
    check(report["rounds"] > 15 and network["fallbacks"] >= 15, "rounds until the crash, and everybody falls back")
    check([h["what"] for h in network["happenings"]][:1] == ["crashes"], f"a crash first: {network['happenings'][:1]}")
    done = run(rondo, "replay", trace)
    check(done.returncode == 0 and "bit for bit" in done.stdout, f"replay of a network: {done.stdout}")
    # Planners that take three rounds, and a robot that is slow: fewer plans.
    slow = folder / "slow.toml"
    slow.write_text("".join(f'[[fault]]\nkind = "planner"\nat = 0\nlength = 1000\nrobot = {r}\namount = 0.6\n' for r in range(4))
                    + '[[fault]]\nkind = "slow"\nat = 1\nlength = 3\nrobot = 1\namount = 0.0002\n')
    quick = folder / "quick.toml"
    quick.write_text("[network]\nloss = 0\n")
    (_, fast), (_, late) = (simulate(rondo, "examples/koord/mapping", "--network", network, "--duration", 12) for network in (quick, slow))
    check(1 <= late["plans"] < fast["plans"], f"slow planners: {fast['plans']} and {late['plans']} plans")
    for way in ("sequencer", "central"):
        fleet = folder / "way.toml"
        fleet.write_text((ROOT / "examples/koord/lineform.toml").read_text() + f'\n[rounds]\nexchange = "{way}"\n')
        status, report = simulate(rondo, "examples/koord/lineform", "--duration", 10, "--fleet", fleet, "--network", quick)
        check(status == 0 and report["rounds"] >= 19, f"{way}: {report['rounds']} rounds")
    _, alone = simulate(rondo, "examples/koord/lineform", "--duration", 20)
    check(alone["network"] is None and alone["rounds"] == 40, "without a network")
    for text, message in [("loss = 2", "it may have network, fault"), ("[network]\nloss = 2", "`loss`"),
                          ("[[fault]]\nkind = \"crush\"", "`kind` cannot be this"),
                          ("[[fault]]\nkind = \"crash\"\nrobot = \"drone99\"", "`robot` cannot be this"),
                          ("[[fault]]\nkind = \"crash\"\nrobot = 16", "`robot`"), ("[network", "TOML")]:
        bad = folder / "bad.toml"
        bad.write_text(text)
        done = run(rondo, "simulate", "examples/koord/lineform", "--network", bad)
        check(done.returncode == 1 and "bad.toml" in done.stderr and message in done.stderr,
              f"{text!r}: {done.returncode} {done.stderr}")
    done = run(rondo, "simulate", "examples/koord/lineform", "--network", folder / "none.toml")
    check(done.returncode == 1 and "none.toml" in done.stderr, "a network file that is not there")
    many = folder / "many.toml"
    many.write_text((ROOT / "examples/koord/lineform.toml").read_text().replace("count = 16", "count = 300"))
    done = run(rondo, "simulate", "examples/koord/lineform", "--fleet", many, "--network", radio)
    check(done.returncode == 1 and "more than can agree" in done.stderr, f"300 robots: {done.stderr}")


def main():
    rondo = str(pathlib.Path(sys.argv[1]).resolve())
    os.chdir(ROOT)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        examples(rondo, folder)
        javascript(rondo, folder)
        damaged(rondo, folder)
        refused(rondo, folder)
        interrupted(rondo, folder)
        runs(rondo, folder)
        networks(rondo, folder)
    print(f"{checks[0]} passed, {checks[1]} failed")
    return 1 if checks[1] else 0


if __name__ == "__main__":
    sys.exit(main())
