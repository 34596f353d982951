#!/usr/bin/env python3
"""Choreographies as processes: `rondo run`, `rondo launch` and `rondo replay LOG ...`, with nothing but DDS between them.

  choreography_robots.py RONDO
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
from mcap.writer import CompressionType, Writer

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
RONDO = str(pathlib.Path(sys.argv[1]).resolve())
EXAMPLES = ROOT / "examples/choreo"
DOMAIN = 140 + os.getpid() % 40
os.environ.update(ROS_DOMAIN_ID=str(DOMAIN), ROS_LOCALHOST_ONLY="1")
os.environ.pop("CYCLONEDDS_URI", None)
results = {"passed": 0, "failed": 0}


def check(name, good, *why):
    results["passed" if good else "failed"] += 1
    if not good:
        print(f"{name}:", *(str(w)[:900] for w in why))


def rondo(*args, **more):
    return subprocess.run([RONDO, *map(str, args)], capture_output=True, text=True, timeout=240, **more)


def launch(path, *args):
    # A machine that is busy lets bodies lag.
    done = rondo("launch", path, "--json", "--tolerance", 0.5, *args)
    try:
        return done.returncode, json.loads(done.stdout)
    except ValueError:
        return done.returncode, {"judged": {}, "robots": [], "incidents": [], "trouble": done.stdout + done.stderr}


def clean(name, status, report, messages, ended):
    judged = report["judged"]
    check(f"{name}: nothing is wrong", status == 0 and not report["incidents"] and judged.get("findings") == []
          and judged.get("gaps") == [] and judged.get("broken") == [], status, report)
    check(f"{name}: messages", judged.get("messages", 0) >= messages, judged)
    check(f"{name}: how it ended", all(r["ended"] == ended for r in report["robots"]), report["robots"])


def scenarios(folder):
    """Every example, by its processes and by its projections."""
    status, report = launch(EXAMPLES / "handover.rondo", "--logs", folder / "handover", "--trace", folder / "handover.mcap")
    clean("handover", status, report, 6, "over")
    logs = sorted((folder / "handover").glob("*.mcap"))
    done = rondo("replay", "--json", *logs)
    check("handover: its logs are judged again", done.returncode == 0 and json.loads(done.stdout)["messages"] == 6, done.stdout, done.stderr)
    done = rondo("plot", folder / "handover.mcap", "--svg", folder / "handover.svg")
    picture = (folder / "handover.svg").read_text() if done.returncode == 0 else ""
    check("handover: a picture", "MoveCart" in picture and "taken" in picture, done.stdout, done.stderr)
    done = rondo("replay", folder / "handover.mcap")
    check("handover: its trace says that it cannot be run again", done.returncode == 1 and "logs" in done.stdout + done.stderr, done.stdout, done.stderr)
    done = rondo("replay", "--json", *logs[1:])
    check("a log is missing", done.returncode == 3 and json.loads(done.stdout)["gaps"], done.stdout, done.stderr)
    # The others too, in a longer search.
    few = ("fetch", "twist", "sorting")
    for example in few if "RONDO_CASES" not in os.environ else (*few, "underpass", "shuttle", "producer", "lanes4", "driven"):
        path = EXAMPLES / f"{example}.rondo"
        status, report = launch(path, "--duration", 5)
        judged = report["judged"]
        check(example, status == 0 and not report["incidents"] and judged.get("findings") == [] and judged.get("broken") == []
              and judged.get("motions", 0) > 2, status, report)
    status, report = launch(EXAMPLES / "shuttle.rondo", "--projections", "--duration", 5)
    check("projections", status == 0 and report["judged"].get("findings") == [] and report["judged"].get("messages", 0) > 0, status, report)


def read(log):
    with open(log, "rb") as file:
        return [(channel.topic, json.loads(message.data)) for _, channel, message in make_reader(file).iter_messages()]


def write(log, lines):
    with open(log, "wb") as file:
        writer = Writer(file, compression=CompressionType.NONE)
        writer.start("ros2", "forged")
        channels = {}
        for at, (topic, line) in enumerate(lines):
            if topic not in channels:
                channels[topic] = writer.register_channel(topic, "json", 0)
            writer.add_message(channels[topic], at, json.dumps(line).encode(), at)
        writer.finish()


def forged(folder):
    """Logs that somebody changed: what they say is not believed."""
    logs = {name: read(folder / f"handover/{name}.mcap") for name in ("cart", "arm", "carrier")}
    place = folder / "forged"
    place.mkdir()

    def judged(what, robot, change, status, said):
        lines = {name: [(t, dict(j)) for t, j in log] for name, log in logs.items()}
        change(lines[robot])
        for name, log in lines.items():
            write(place / f"{name}.mcap", log)
        done = rondo("replay", *sorted(place.glob("*.mcap")))
        check(f"forged: {what}", done.returncode == status and said in done.stdout + done.stderr, done.returncode, done.stdout, done.stderr)

    def index(log, **wanted):
        return next(i for i, (_, j) in enumerate(log) if all(j.get(k) == v for k, v in wanted.items()))

    def edit(**changes):
        at = changes.pop("at")
        return lambda log: log[index(log, **at)][1].update(changes)

    judged("nothing", "cart", lambda log: None, 0, "6 messages")
    judged("the end is cut off", "cart", lambda log: log.pop(), 3, "the log of `cart` ends early")
    judged("all is gone", "cart", lambda log: log.__delitem__(slice(1, None)), 3, "ends early")
    judged("a message was never sent", "cart", lambda log: log.pop(index(log, did="sent", what="take")), 1, "did not send then")
    judged("a message was never taken", "arm", lambda log: log.pop(index(log, did="took", what="take")), 1, "does not say so")
    judged("the last message was never sent", "cart", lambda log: log.pop(index(log, did="sent", what="home", peer="arm")), 1, "did not send then")
    judged("another order", "cart", lambda log: log.insert(1, log.pop(index(log, did="sent", what="take"))), 1, "`")
    judged("values that it has not", "cart", edit(at={"did": "sent", "what": "take"}, values=[1.0]), 1, "other values")
    judged("a contract that was missed", "arm", edit(at={"did": "ends"}, missed=50), 1, "missed its contract")
    judged("one without a value", "arm", edit(at={"did": "ends"}, missed=None), 1, "has no value")
    judged("it failed", "arm", edit(at={"did": "leaves"}, outcome="failed"), 1, "arm: failed")
    judged("something behind the end", "arm", lambda log: log.append(log[index(log, did="begins")]), 1, "after it left")
    judged("another robot", "arm", edit(at={"engine": "session"}, robot="cart"), 1, "two logs")
    judged("another version", "arm", edit(at={"engine": "session"}, projections=True), 1, "different choreographies")
    judged("another session", "arm", edit(at={"engine": "session"}, session="0"), 1, "different runs")

    def early(log):
        log[:] = log[:3] + [log[-1]]

    judged("an end that is none", "carrier", early, 1, "is not")


def worlds(folder):
    """Names that ROS has not, and headings beyond half a turn."""
    robot = ("robot R {\n  state x, y: length in [-10 m, 10 m]\n  state theta: angle in [0 rad, 10 rad]\n  body box(self * translate(x, y, 0), (-10 cm, -10 cm, 0), "
             "(10 cm, 10 cm, 10 cm))\n  motion Idle() interruptible [0, inf) {}\n  motion Turn(to: angle, T = 2 s) noninterruptible [T, T] { modifies theta post theta == to }\n}\n")
    text = ("world W { A: R at (0, 0, 0) B: R at (0, 5 m, 0) }\nchoreography C in W {\n  initially A.theta == 7 rad and B.theta == 0 and A.x == 0 and B.x == 0 and A.y == 0 and B.y == 0\n"
            "  { A: Turn(7.5 rad), B: Idle() }\n  A -> B: j()\n}\n")
    path = folder / "turn.rondo"
    path.write_text(robot + text.replace("A", "a").replace("B", "b"))
    status, report = launch(path, "--trace", folder / "turn.mcap")
    clean("more than a turn", status, report, 1, "over")
    path.write_text(robot + text.replace("A", "a_b").replace("B", "a__b"))
    done = rondo("launch", path)
    check("names that are one in ROS", done.returncode == 1 and "give one of them another name" in done.stderr, done.stderr)
    done = rondo("launch", EXAMPLES / "handover.rondo", "--logs", folder / "here", "--trace", folder / "here/arm.mcap")
    check("a trace in the place of a log", done.returncode == 1 and "is the log of `arm`" in done.stderr, done.stderr)


def start(robot, *args):
    return subprocess.Popen([RONDO, "run", str(EXAMPLES / "handover.rondo"), "--robot", robot, "--json", *map(str, args)],
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def ended(process):
    out, err = process.communicate(timeout=60)
    try:
        return process.returncode, json.loads(out)
    except ValueError:
        return process.returncode, {"trouble": out + err}


def faults(folder):
    """A robot is killed, stopped, or never comes; somebody runs something else."""
    logs = folder / "killed"
    process = subprocess.Popen([RONDO, "launch", str(EXAMPLES / "handover.rondo"), "--json", "--logs", str(logs)],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    time.sleep(5)
    children = subprocess.run(["pgrep", "-P", str(process.pid), "-f", "robot carrier"], capture_output=True, text=True).stdout.split()
    check("killed: it ran", len(children) == 1, children)
    for child in children:
        os.kill(int(child), signal.SIGKILL)
    killed = time.monotonic()
    status, report = ended(process)
    check("killed: the others give up soon", time.monotonic() - killed < 6, time.monotonic() - killed)
    outcomes = {r["name"]: r["ended"] for r in report.get("robots", [])}
    why = {r["why"] for r in report.get("robots", [])}
    check("killed: they say whom they lost", status == 1 and outcomes.get("cart") == outcomes.get("arm") == "lost"
          and "`carrier` is silent" in why, report)
    check("killed: nothing that can be judged is wrong", report["judged"]["findings"] == [] and report["judged"]["gaps"], report["judged"])
    check("killed: what it logged is there", (logs / "carrier.mcap.partial").exists())
    done = rondo("replay", *logs.glob("*.mcap*"))
    check("killed: its logs are judged", done.returncode == 1 and "ends early" in done.stdout and "`carrier` is silent" in done.stdout, done.stdout, done.stderr)

    process = subprocess.Popen([RONDO, "launch", str(EXAMPLES / "handover.rondo"), "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    time.sleep(4)
    process.send_signal(signal.SIGINT)
    status, report = ended(process)
    check("interrupted", status == 3 and report["interrupted"] and report["judged"]["findings"] == [], status, report)

    # Without bodies: they say what they wait for.
    process = start("cart")
    time.sleep(2)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    check("no sensors: it waits, and can be stopped", process.returncode == 0 and json.loads(out)["motions"] == 0, out, err)

    done = rondo("run", EXAMPLES / "handover.rondo", "--robot", "carier")
    check("a typo", done.returncode == 1 and "did you mean `carrier`?" in done.stderr, done.stderr)
    done = rondo("run", EXAMPLES / "handover.rondo", "--robot", "cart", "--fleet", "x.toml")
    check("an option of the other language", done.returncode == 2 and "only Koord programs have it" in done.stderr, done.stderr)
    done = rondo("run", EXAMPLES / "nothing.rondo", "--robot", "cart")
    check("no file", done.returncode == 1 and "nothing.rondo" in done.stderr, done.stderr)


def main():
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        scenarios(folder)
        forged(folder)
        worlds(folder)
        faults(folder)
    print(f"{results['passed']} passed, {results['failed']} failed")
    return 1 if results["failed"] else 0


sys.exit(main())
