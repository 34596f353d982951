#!/usr/bin/env python3
"""Fleets as processes: `rondo run`, `rondo launch`, `rondo doctor`, `rondo replay LOG ...`, with nothing but DDS between them,
and drivers of other vendors.

  robots.py RONDO [PART...]
"""
import json
import os
import pathlib
import random
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

from mcap_files import unsealed

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
RONDO = pathlib.Path(sys.argv[1]).resolve()
DRIVER = RONDO.parent / "fastdds_driver"
LIBRARIES = RONDO.parent.parent / "adapters"
SLEEPER = RONDO.parent / "sleeping_node"
RUST = ROOT / "build/rust/release/rust_driver"
PYTHON = ROOT / "build/python/bin/python3"
LINEFORM = str(ROOT / "examples/koord/lineform")
TURTLES = ROOT / "examples/koord/turtlebots.toml"
# A domain that other tests are not in.
DOMAIN = 50 + os.getpid() % 40
os.environ.update(ROS_DOMAIN_ID=str(DOMAIN), ROS_LOCALHOST_ONLY="1")
os.environ.pop("CYCLONEDDS_URI", None)
problems = []


def check(what, good, *shown):
    if not good:
        problems.append(what)
        print("FAILED:", what, *shown)


def rondo(*arguments, **more):
    return subprocess.run([str(RONDO), *map(str, arguments)], capture_output=True, text=True, timeout=240, **more)


def launch(program, *arguments):
    done = rondo("launch", program, "--json", *arguments)
    try:
        return done.returncode, json.loads(done.stdout)
    except json.JSONDecodeError:
        check("launch writes JSON", False, done.stdout, done.stderr)
        return done.returncode, {"judged": {}, "robots": []}


def clean(name, report, rounds):
    judged = report.get("judged") or {}
    check(f"{name}: rounds go on", judged.get("rounds", 0) >= rounds, judged)
    check(f"{name}: each round is one of the program's", judged.get("explained", 0) >= rounds and judged.get("findings") == [], judged)
    check(f"{name}: the specification is kept", judged.get("violations") == [], judged)


def fleet(folder, name, *changes):
    text = TURTLES.read_text()
    for old, new in changes:
        check(f"{old} is in the fleet", old in text)
        text = text.replace(old, new)
    path = folder / name
    path.write_text(text)
    return path


def fleets(folder):
    status, report = launch(LINEFORM, "--fleet", TURTLES, "--duration", 5, "--logs", folder / "logs")
    clean("cmd_vel", report, 15)
    check("cmd_vel: status", status == 0, status, report)
    check("cmd_vel: they move", moved(folder / "logs" / "bot1.mcap"))
    drones = fleet(folder, "drones.toml", ('model = "unicycle"', 'model = "quadrotor"'), ("position = [0, 0, 0]", "position = [0, 0, 1]"),
                   ('target = { cmd_vel = "cmd_vel" }', ""), ("{ max_speed = 0.6 }", "{ tolerance = 0.2 }"))
    status, report = launch(LINEFORM, "--fleet", drones, "--duration", 4)
    clean("goal_pose", report, 12)
    check("goal_pose: status", status == 0, status, report)
    cars = fleet(folder, "cars.toml", ('model = "unicycle"', 'model = "car"'), ('cmd_vel = "cmd_vel"', 'ackermann = "drive"'))
    status, report = launch(LINEFORM, "--fleet", cars, "--duration", 4)
    clean("ackermann", report, 12)
    check("ackermann: status", status == 0, status, report)
    drones = fleet(folder, "px4.toml", ('model = "unicycle"', 'model = "quadrotor"\norigin = "start"'), ("position = [0, 0, 0]", "position = [0, 0, 1]"),
                   ('psn = { ros2 = "odom", max_age = 0.5 }', 'psn = { px4 = "fmu" }'), ('target = { cmd_vel = "cmd_vel" }', 'target = { px4 = "fmu" }'),
                   ("{ max_speed = 0.6 }", "{ tolerance = 0.2 }"))
    status, report = launch(LINEFORM, "--fleet", drones, "--duration", 6, "--logs", folder / "px4")
    clean("px4", report, 20)
    check("px4: status", status == 0, status, report)
    check("px4: they fly", moved(folder / "px4" / "bot1.mcap"))


def simulated_time(folder):
    """A clock that runs faster, and one that stands still; goals of Nav2 and joints, whose drivers say what became of them."""
    text = (ROOT / "examples/koord/delivery.toml").read_text()
    path = folder / "delivery.toml"
    path.write_text(text + '\n[ros]\nuse_sim_time = true\n\n[ports]\npath = { nav2 = "plan" }\n'
                    'reached = { nav2 = "navigate_to_pose/_action/status" }\n')
    status, report = launch(ROOT / "examples/koord/delivery", "--fleet", path, "--duration", 60, "--speed", 3)
    clean("delivery", report, 30)
    check("delivery: every robot stopped", status == 3 and all(r["status"] == 0 for r in report["robots"]), status, report)
    text = (ROOT / "examples/koord/hvac.toml").read_text().replace("../../models", str(ROOT / "models"))
    path = folder / "hvac.toml"
    path.write_text(text + '\n[rounds]\nlease = 150\npatience = 150\n\n[ros]\nuse_sim_time = true\n\n[ports]\n'
                    'temperature = { joint_states = "joint_states", joint = "room", reliable = true }\n'
                    'power = { joint_trajectory = "heater/joint_trajectory", joint = "room", within = 1 }\n')
    status, report = launch(ROOT / "examples/koord/hvac", "--fleet", path, "--duration", 500, "--speed", 100)
    clean("joints", report, 8)
    check("joints: status", status == 0, status, report)
    done = rondo("launch", LINEFORM, "--fleet", TURTLES, "--speed", 2)
    check("speed: not without a simulated clock", done.returncode == 1 and "use_sim_time" in done.stderr, done.stderr)
    for what, psn in (("a pose", '{ pose = "amcl_pose", with_covariance = true }'), ("transforms", '{ tf = "base_link", max_age = 0.5 }'), ("a bare pose", '{ pose = "pose" }')):
        path = fleet(folder, "posed.toml", ("[ros]", "[ros]\nuse_sim_time = true"), ('psn = { ros2 = "odom", max_age = 0.5 }', f"psn = {psn}"))
        status, report = launch(LINEFORM, "--fleet", path, "--duration", 6, "--speed", 3, "--logs", folder / "posed")
        clean(what, report, 20)
        check(f"{what}: status, and they move", status == 0 and moved(folder / "posed" / "bot1.mcap"), status, report)
    path = fleet(folder, "paused.toml", ("[ros]", "[ros]\nuse_sim_time = true"))
    process = subprocess.Popen([str(RONDO), "launch", LINEFORM, "--fleet", str(path), "--duration", "8", "--json"], stdout=subprocess.PIPE, text=True)
    time.sleep(4)
    process.send_signal(signal.SIGSTOP)  # the world, and its clock: for longer than a lease
    time.sleep(3)
    process.send_signal(signal.SIGCONT)
    report = json.loads(process.communicate(timeout=120)[0])
    clean("paused", report, 12)
    check("paused: nobody is given up", all("falls back" not in h["what"] for h in report["judged"]["happenings"]), report["judged"])


def adapters(folder):
    """Hardware that only libraries of the user know."""
    example = ROOT / "examples/adapters"
    (folder / "lantern.koord").write_text((example / "lantern.koord").read_text())
    fleet_ = (example / "lantern.toml").read_text()
    for old, new in (("libbattery.so", str(LIBRARIES / "libbattery.so")), ("liblamp.so", str(LIBRARIES / "liblamp.so")),
                     ("/sys/class/power_supply/BAT0/capacity", str(folder / "charge")), ("/sys/class/leds/lantern/brightness", str(folder / "lamp"))):
        check(f"{old} is in the fleet", old in fleet_)
        fleet_ = fleet_.replace(old, new)
    (folder / "lantern.toml").write_text(fleet_)
    (folder / "charge").write_text("80\n")
    process = subprocess.Popen([str(RONDO), "run", folder / "lantern.koord", "--robot", "lantern"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def lamp(value):
        for _ in range(100):
            if (folder / "lamp").exists() and (folder / "lamp").read_text() == value:
                return True
            time.sleep(0.1)
        return False
    check("adapters: it shines", lamp("1"))
    (folder / "charge").write_text("10\n")
    check("adapters: it rests", lamp("0"))
    (folder / "charge").write_text("none\n")
    time.sleep(1.5)
    (folder / "charge").write_text("90\n")
    check("adapters: it shines again", lamp("1"))
    process.send_signal(signal.SIGTERM)
    out, err = process.communicate(timeout=60)
    check("adapters: it ends", process.returncode == 0, out, err)
    check("adapters: a bad sensor is said", "skips: `charge`" in err and "cannot read" in err, err)
    check("adapters: it is safe at the end", (folder / "lamp").read_text() == "0")
    (folder / "lantern.toml").write_text(fleet_.replace("libbattery.so", "libnone.so"))
    done = rondo("run", folder / "lantern.koord", "--robot", "lantern")
    check("adapters: no library", done.returncode == 1 and "cannot load the adapter of `charge`" in done.stderr, done.stderr)


def secured(folder):
    path = fleet(folder, "secured.toml", ("[ros]", '[ros]\nkeys = "keys"'))
    done = rondo("launch", LINEFORM, "--fleet", path, "--duration", 2)
    check("keys: there are none", done.returncode == 1 and "`rondo keys` makes them" in done.stderr, done.stderr)
    done = rondo("keys", LINEFORM, "--fleet", path, "--json")
    made = json.loads(done.stdout)
    check("keys: made", done.returncode == 0 and len(made["made"]) == 6 and made["owner"] == "made", made)
    key = folder / "keys/enclaves/bot0/key.pem"
    before = key.read_text()
    check("keys: for their owner alone", (folder / "keys/private").stat().st_mode & 0o77 == 0 and key.parent.stat().st_mode & 0o77 == 0)
    rondo("keys", LINEFORM, "--fleet", path)
    check("keys: stay", key.read_text() == before)
    process = subprocess.Popen([str(RONDO), "launch", LINEFORM, "--fleet", str(path), "--duration", "9", "--json", "--logs", folder / "secured"],
                               stdout=subprocess.PIPE, text=True)
    replayed = stranger(2.5)
    done = subprocess.run([str(PYTHON), str(ROOT / "tests/peers/cyclonedds_listener.py"), str(DOMAIN), "bot0", "2"], capture_output=True, text=True, timeout=60)
    check("keys: who has none hears nothing", done.stdout == "nothing\n", done.stdout, done.stderr)
    done = rondo("doctor", LINEFORM, "--fleet", path, "--seconds", 2)
    check("keys: the doctor has one", done.returncode == 0 and "nothing is wrong" in done.stdout, done.stdout, done.stderr)
    report = json.loads(process.communicate(timeout=120)[0])
    clean("keys", report, 25)
    check("keys: status", process.returncode == 0, report)
    check("keys: said", "DDS with security" in (folder / "secured/bot0.txt").read_text())
    print(f"replayed and oversized: {replayed}")
    other = fleet(folder, "altered.toml", ("[ros]", '[ros]\nkeys = "keys"'), ("lease = 1", "lease = 2"))
    done = rondo("run", LINEFORM, "--fleet", other, "--robot", "bot0")
    check("keys: other files than were signed", done.returncode == 1 and "is not what was signed" in done.stderr, done.stderr)
    signed = folder / "keys/enclaves/bot0/files.p7s"
    signed.write_text(signed.read_text().replace("program ", "program 0", 1))
    done = rondo("run", LINEFORM, "--fleet", path, "--robot", "bot0")
    check("keys: an altered signature", done.returncode == 1 and "it is not what was signed" in done.stderr, done.stderr)


def stranger(seconds):
    """Repeats what it hears on the wire, and sends datagrams that are too long or none; says how many."""
    try:
        ear = socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(0x0800))
        ear.bind(("lo", 0))
    except OSError:
        return "skipped: nobody may listen to the wire here"
    ear.settimeout(0.2)
    mouth = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    first, count, heard = 7400 + 250 * DOMAIN, 0, []
    end = time.time() + seconds
    while time.time() < end:
        try:
            frame = ear.recv(65536)
        except TimeoutError:
            continue
        if len(frame) < 42 or frame[23] != 17:
            continue
        port, data = int.from_bytes(frame[36:38], "big"), frame[42:]
        if first <= port < first + 250 and len(heard) < 3000:
            heard.append((socket.inet_ntoa(frame[30:34]), port, data))
    random.seed(1)
    for address, port, data in heard:
        broken = bytearray(data)
        broken[random.randrange(len(broken))] ^= 0xff
        for bytes_ in (data, bytes(broken), data + bytes(60000 - len(data)) if count % 50 == 0 else data[: len(data) // 2]):
            try:
                mouth.sendto(bytes_, (address, port))
                count += 1
            except OSError:
                pass
    check("keys: something was repeated", count > 100, count)
    return count


def moved(log):
    text = log.read_bytes().decode("latin-1")
    seen = set(re.findall(r'"Motion.psn":\[{[^}]*},({[^}]*})', text))
    return len(seen) > 5


def logs(folder):
    names = sorted((folder / "logs").glob("*.mcap"))
    done = rondo("replay", *names, "--json")
    judged = json.loads(done.stdout)
    check("logs: nothing is wrong", done.returncode == 0 and judged["findings"] == [] and judged["violations"] == [], judged)
    done = rondo("replay", *names[1:])
    check("logs: one is missing", done.returncode == 3 and "logs of 3 of 4 robots" in done.stdout, done.stdout)
    done = rondo("replay", names[0], *names)
    check("logs: one is there twice", done.returncode == 1 and "is there twice" in done.stderr, done.stderr)
    done = rondo("replay", *names, TURTLES)
    check("logs: one is none", done.returncode == 1 and "not an MCAP file" in done.stderr, done.stderr)
    bytes_ = names[2].read_bytes()
    # Another state in the log of one robot: its stores differ from those of the others.
    at = bytes_.index(b'"store":"', bytes_.index(b'"round":7,'))
    end = bytes_.index(b'"', at + 9)
    spot = at + 9 + (end - at - 9) // 2 // 2 * 2
    other = bytearray(unsealed(bytes_))
    other[spot + 1] = ord("1") if other[spot + 1] != ord("1") else ord("2")
    bad = folder / "bad.mcap"
    bad.write_bytes(other)
    done = rondo("replay", names[0], names[1], bad, names[3], "--json")
    check("logs: robots disagree", done.returncode == 1, done.stdout, done.stderr)
    flipped = bytearray(bytes_)
    flipped[len(flipped) // 2] ^= 1
    bad.write_bytes(flipped)
    done = rondo("replay", names[0], names[1], bad, names[3])
    check("logs: a bit is another", done.returncode == 1 and "checksum" in done.stderr, done.stdout, done.stderr)
    cut = folder / "cut.mcap"
    cut.write_bytes(bytes_[: len(bytes_) // 2])
    done = rondo("replay", names[0], names[1], cut, names[3])
    check("logs: one is cut off", done.returncode == 3 and "cut off" in done.stdout, done.stdout, done.stderr)


def altered(folder):
    """Logs whose lines are changed: what is wrong is found, or the file refused; nothing crashes."""
    names = sorted((folder / "logs").glob("*.mcap"))
    bytes_ = unsealed(names[1].read_bytes())

    def judged(old, new, count=1):
        check(f"{old} is in the log", old in bytes_)
        changed = folder / "altered.mcap"
        changed.write_bytes(bytes_.replace(old, new, count))
        return rondo("replay", names[0], changed, *names[2:])
    for what, old, new in (("a text for a number", b'"life":1', b'"life":"'), ("a robot of another log", b'"robot":1,"round"', b'"robot":2,"round"'),
                           ("a robot that does not exist", b'{"life":1', b'{"life":9'), ("no store", b'"store":"', b'"stora":"'),
                           ("another lease", b'"engine":"run"', b'"engine":"rum"'), ("a kind that does not exist", b'"did":"acted"', b'"did":"acter"')):
        done = judged(old, new)
        check(f"altered: {what}", done.returncode in (1, 3) and "bug" not in done.stderr, done.returncode, done.stdout, done.stderr)
    # A machine with a clock of its own.
    machine = re.search(rb'"machine":"([^"]*)"', bytes_).group(1)
    done = judged(machine, b"x" * len(machine))
    check("altered: another machine", done.returncode == 3 and "whose clocks are not one" in done.stdout, done.stdout, done.stderr)
    done = judged(b'"until":', b'"until":1', 10**6)  # much later
    check("altered: all is well after that", done.returncode in (0, 1), done.stdout)


def killed(folder, on_loss):
    path = fleet(folder, f"{on_loss}.toml", ('on_loss = "evict"', f'on_loss = "{on_loss}"'))
    process = subprocess.Popen([str(RONDO), "launch", LINEFORM, "--fleet", str(path), "--duration", "9", "--json", "--logs", folder / on_loss],
                               stdout=subprocess.PIPE, text=True)
    time.sleep(4)
    check(f"{on_loss}: a robot is there to be killed", subprocess.run(["pkill", "-9", "-f", "[-]-robot bot2 "]).returncode == 0)
    report = json.loads(process.communicate(timeout=120)[0])
    judged = report["judged"]
    fell = [h["time"] for h in judged["happenings"] if "falls back" in h["what"]]
    check(f"{on_loss}: all others fall back", len(fell) >= 3, judged)
    check(f"{on_loss}: nothing else is wrong", judged["findings"] == [] and judged["violations"] == [], judged)
    if on_loss == "halt":
        check("halt: the session is over", sorted(r["status"] for r in report["robots"]) == [-1, 1, 1, 1], report)
        return
    check("evict: all others end well", sorted(r["status"] for r in report["robots"]) == [-1, 0, 0, 0], report)
    teams = [h["time"] for h in judged["happenings"] if h["what"] == "the team is bot0, bot1, bot3"]
    check("evict: the others go on", len(teams) == 1 and teams[0] - min(fell) < 3, judged)
    check("evict: rounds go on", judged["rounds"] > 25, judged)


def interrupted(folder):
    process = subprocess.Popen([str(RONDO), "launch", LINEFORM, "--fleet", str(TURTLES), "--logs", folder / "stop"], stdout=subprocess.PIPE, text=True)
    time.sleep(3)
    process.send_signal(signal.SIGINT)
    text = process.communicate(timeout=60)[0]
    check("Ctrl-C: it says so", process.returncode == 3 and "interrupted" in text, process.returncode, text)
    check("Ctrl-C: nobody is left", subprocess.run(["pgrep", "-f", f"{folder}/stop/bot"], stdout=subprocess.DEVNULL).returncode == 1)
    check("Ctrl-C: they stay where they are", "it stays where it is" in (folder / "stop/bot0.txt").read_text())


def doctor(folder):
    process = subprocess.Popen([str(RONDO), "launch", LINEFORM, "--fleet", str(TURTLES), "--duration", "60"], stdout=subprocess.PIPE)
    time.sleep(3)
    done = rondo("doctor", LINEFORM, "--fleet", TURTLES, "--json")
    found = json.loads(done.stdout)
    check("doctor: all is well", done.returncode == 0 and len(found["robots"]) == 4 and len(found["ways"]) == 4, found)
    check("doctor: answers come", all(w["answered"] > 0.8 * w["asked"] and abs(w["ahead"]) < 0.02 for w in found["ways"]), found)
    other = fleet(folder, "other.toml", ("lease = 1", "lease = 1.1"))
    done = rondo("doctor", LINEFORM, "--fleet", other, "--seconds", 1.5)
    check("doctor: other files", done.returncode == 1 and "it runs another program, specification or fleet" in done.stdout, done.stdout)
    other = fleet(folder, "typed.toml", ('ros2 = "odom"', 'ros2 = "cmd_vel"'), ('cmd_vel = "cmd_vel"', 'ros2 = "odom"'))
    done = rondo("doctor", LINEFORM, "--fleet", other, "--seconds", 1.5)
    check("doctor: other types", done.returncode == 1 and "carries `geometry_msgs/msg/Twist`" in done.stdout, done.stdout)
    subprocess.run(["pkill", "-9", "-f", "[-]-robot bot3 "])
    time.sleep(2.5)
    done = rondo("doctor", LINEFORM, "--fleet", TURTLES, "--seconds", 2)
    check("doctor: one is gone", done.returncode == 1 and "bot3: nobody says anything of it" in done.stdout and "does not hear bot3" in done.stdout,
          done.stdout)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    solo(folder)
    sleeper = subprocess.Popen([str(SLEEPER), str(DOMAIN), "solo", "6"])
    done = rondo("doctor", folder / "solo", "--seconds", 1.5)
    check("doctor: a node that is not active", "/solo/localizer is a lifecycle node, and not active" in done.stdout, done.stdout)
    sleeper.kill()
    done = rondo("doctor")
    check("doctor: of this machine", done.returncode == 0, done.stdout)
    done = rondo("doctor", env=dict(os.environ, ROS_DOMAIN_ID="1000"))
    check("doctor: a domain that cannot be", done.returncode == 1 and "ROS_DOMAIN_ID is `1000`" in done.stderr, done.stderr)


SOLO = """
using Motion:
    sensors:
        pos psn
    actuators:
        pos target
Go:
    eff:
        Motion.target = pos(3, 2.5, 0)
"""
SOLO_FLEET = """
[run]
delta = 0.1
[[robot]]
name = "solo"
model = "unicycle"
position = [0, 0, 0]
"""


def solo(folder):
    (folder / "solo.koord").write_text(SOLO)
    (folder / "solo.toml").write_text(SOLO_FLEET)


def driven(folder, driver, name, says):
    """One robot, whose driver another vendor's library has: both directions."""
    solo(folder)
    process = subprocess.Popen([str(RONDO), "run", str(folder / "solo"), "--robot", "solo", "--duration", "4", "--json"], stdout=subprocess.PIPE)
    heard = subprocess.run([str(driver), str(DOMAIN), "solo", "9"], capture_output=True, text=True, timeout=60)
    report = json.loads(process.communicate(timeout=60)[0])
    check(f"{name} drives a robot", report["status"] == 0 and report["rounds"] >= 30 and report["blind"] == 0, report)
    check(f"{name} is told where to go", re.fullmatch(says, heard.stdout), heard.stdout, heard.stderr)


def vendors(folder):
    solo(folder)
    if DRIVER.exists():
        driven(folder, DRIVER, "Fast DDS", r"goals \d+ at 3.000 2.500 in map; nodes /solo/rondo\n")
    else:
        print("note: Fast DDS is not there: `./dev setup` installs it")
    process = subprocess.Popen([str(RONDO), "launch", str(folder / "solo"), "--duration", "8", "--json"], stdout=subprocess.PIPE)
    time.sleep(1.5)
    heard = subprocess.run([str(PYTHON), str(ROOT / "tests/peers/cyclonedds_listener.py"), str(DOMAIN), "solo", "5"], capture_output=True,
                           text=True, timeout=60)
    process.communicate(timeout=60)
    check("another Cyclone DDS hears where a robot is", re.match(r"\d\d+ map solo/base_link \S+ \S+", heard.stdout), heard.stdout, heard.stderr)


def rust(folder):
    if not RUST.exists():
        return print("note: the driver in Rust is not there: `./dev nightly` makes it")
    return driven(folder, RUST, "a driver in Rust", r"goals [1-9]\d* at 3.000 2.500 in map\n")


def wire(folder):
    """What Wireshark's dissector sees on the wire, and what `rosbags` reads of a trace and a log."""
    solo(folder)
    capture, trace = folder / "wire.pcapng", folder / "wire.mcap"
    first = 7400 + 250 * DOMAIN
    shark = None
    if shutil.which("tshark"):
        shark = subprocess.Popen(["tshark", "-q", "-i", "lo", "-w", capture, "-f", f"udp portrange {first}-{first + 249}"],
                                 stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        time.sleep(1.5)
    done = rondo("launch", folder / "solo", "--duration", 3, "--trace", trace, "--logs", folder / "solo_logs")
    check("wire: the fleet runs", done.returncode == 0, done.stdout, done.stderr)
    if shark is None or shark.poll() is not None:
        print("note: skipped: nobody may listen to the wire here, or there is no tshark")
    else:
        shark.send_signal(signal.SIGINT)
        shark.communicate(timeout=30)

        def fields(only, *names):
            shown = subprocess.run(["tshark", "-r", capture, "-Y", only, "-T", "fields", *(word for name in names for word in ("-e", name))],
                                   capture_output=True, text=True, timeout=120)
            return [line.split("\t") for line in shown.stdout.splitlines()]
        told = {pair for names, types in fields("rtps.param.topicName", "rtps.param.topicName", "rtps.param.typeName")
                for pair in zip(names.split(","), types.split(","))}
        for pair in (("rt/solo/odom", "nav_msgs::msg::dds_::Odometry_"), ("rt/solo/goal_pose", "geometry_msgs::msg::dds_::PoseStamped_"),
                     ("rt/tf", "tf2_msgs::msg::dds_::TFMessage_"), ("ros_discovery_info", "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_")):
            check(f"wire: {pair[0]} is announced", pair in told, sorted(told))
        kinds = {kind for (line,) in fields("rtps.param.serialize.encap_kind", "rtps.param.serialize.encap_kind") for kind in line.split(",")}
        check("wire: data is CDR, parameters are lists", kinds == {"0x0001", "0x0003"}, kinds)
        check("wire: nothing is malformed", fields("rtps && _ws.malformed", "frame.number") == [])
    for file, wanted in ((trace, {"geometry_msgs/msg/PoseStamped", "tf2_msgs/msg/TFMessage"}), (folder / "solo_logs/solo.mcap", set())):
        read = subprocess.run([str(PYTHON), "-c", ROSBAGS, str(file)], capture_output=True, text=True, timeout=60)
        check(f"rosbags reads {file.name}", read.returncode == 0 and wanted <= set(read.stdout.split()), read.stdout, read.stderr)


ROSBAGS = """
import pathlib, sys
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore
store = get_typestore(Stores.ROS2_JAZZY)
with Reader(pathlib.Path(sys.argv[1])) as reader:
    for count, (connection, _, data) in enumerate(reader.messages()):
        if connection.msgtype.count('/') == 2:
            store.deserialize_cdr(data, connection.msgtype)
            print(connection.msgtype)
assert count > 5
"""


FAULTS = SOLO.replace("        Motion.target = pos(3, 2.5, 0)", "        n = 1 / (n - n)").replace("Go:", "local:\n    int n = 0\nGo:")


def mistakes(folder):
    (folder / "faults.koord").write_text(FAULTS)
    (folder / "faults.toml").write_text(SOLO_FLEET)
    status, report = launch(folder / "faults", "--duration", 2)
    found = (report.get("judged") or {}).get("violations", [])
    check("an operation without a value is a violation", status == 1 and found and "the divisor is zero" in found[0]["what"], status, report)
    (folder / "twice.toml").write_text(SOLO_FLEET + '[[robot]]\nname = "b"\nmodel = "unicycle"\nposition = [3, 0, 0]\nnamespace = "solo"\n')
    done = rondo("launch", folder / "solo", "--fleet", folder / "twice.toml")
    check("two robots on one topic", done.returncode == 1 and "have one topic for `psn`: /solo/odom" in done.stderr, done.stderr)
    process = subprocess.Popen([str(RONDO), "launch", str(folder / "solo"), "--duration", "30", "--json"], stdout=subprocess.DEVNULL)
    time.sleep(2.5)
    done = rondo("launch", folder / "solo")
    check("two fleets in one domain", done.returncode == 1 and "somebody else has a driver of `solo`" in done.stderr, done.stderr)
    process.kill()
    process.wait()
    time.sleep(5)
    check("the launcher is killed: nobody is left", subprocess.run(["pgrep", "-f", "[-]-robot solo "], stdout=subprocess.DEVNULL).returncode == 1)
    begun = time.monotonic()
    process = subprocess.Popen([str(RONDO), "launch", LINEFORM, "--fleet", str(TURTLES), "--json"], stdout=subprocess.PIPE, text=True)
    killed_one = False
    while not killed_one and time.monotonic() - begun < 5:
        killed_one = subprocess.run(["pkill", "-9", "-f", "[-]-robot bot2 "]).returncode == 0
    report = json.loads(process.communicate(timeout=60)[0])
    check("one dies in the beginning", process.returncode == 1 and any(r["signal"] == 9 for r in report["robots"]), report)


def refusals(folder):
    done = rondo("run", LINEFORM, "--fleet", TURTLES, "--robot", "bott0")
    check("run: a robot that does not exist", done.returncode == 1 and "did you mean `bot0`?" in done.stderr, done.stderr)
    done = rondo("run", LINEFORM, "--fleet", TURTLES, "--robot", "bot0", "--log", "/dev/null/x")
    check("run: a log that cannot be written", done.returncode == 1 and "cannot write `/dev/null/x`" in done.stderr, done.stderr)
    drones = fleet(folder, "no.toml", ('model = "unicycle"', 'model = "quadrotor"'), ("{ max_speed = 0.6 }", "{ tolerance = 0.2 }"))
    done = rondo("launch", LINEFORM, "--fleet", drones)
    check("launch: drones have no wheels", done.returncode == 1 and "not driven by velocities" in done.stderr, done.stderr)
    odom, drive = 'psn = { ros2 = "odom", max_age = 0.5 }', 'target = { cmd_vel = "cmd_vel" }'
    for what, old, new, says in (("nav2", odom, 'psn = { nav2 = "odom" }', "Nav2 knows nothing of `psn`"),
                                 ("joints", odom, 'psn = { joint_states = "j", joint = "a" }', "`psn` is no sensor of type `float`"),
                                 ("a car that flies", drive, 'target = { px4 = "fmu" }', "which does not fly"),
                                 ("a port that is none", odom, 'psm = { ros2 = "odom" }', "did you mean `psn`?"),
                                 ("a word that is none", drive, 'target = { cmd_val = "a" }', "`target` needs a topic")):
        done = rondo("launch", LINEFORM, "--fleet", fleet(folder, "wrong.toml", (old, new)))
        check(f"ports: {what}", done.returncode == 1 and says in done.stderr, done.stderr)
    drones = fleet(folder, "no.toml", ('model = "unicycle"', 'model = "quadrotor"'), ("{ max_speed = 0.6 }", "{ tolerance = 0.2 }"),
                   (drive, 'target = { px4 = "fmu" }'))
    done = rondo("launch", LINEFORM, "--fleet", drones)
    check("ports: an autopilot without an origin", done.returncode == 1 and 'origin = "start"' in done.stderr, done.stderr)
    done = rondo("keys", LINEFORM, "--fleet", TURTLES)
    check("keys: nobody says where", done.returncode == 1 and "`-o FOLDER`" in done.stderr, done.stderr)
    done = rondo("launch", LINEFORM, "--fleet", folder / "nosuch.toml", "--json")
    check("launch: a fleet that does not exist", done.returncode == 1 and json.loads(done.stdout)["diagnostics"], done.stdout)


def cores(folder):
    """A fleet in which C++ runs the events of some robots, and the machine those of others: they are one team."""
    made = folder / "cpp"
    done = rondo("build", LINEFORM, "--fleet", TURTLES, "-o", made)
    check("cores: made", done.returncode == 0, done.stderr)
    headers = RONDO.parent.parent / "include"
    library = made / "core.so"
    done = subprocess.run(["c++", "-std=c++20", "-O1", "-shared", "-fPIC", "-ffp-contract=off", f"-I{headers}", f"-I{headers}/rondo",
                           f"-I{made}", made / "koord/lineform.cc", made / "koord/lineform_core.cc", "-o", library], capture_output=True, text=True)
    check("cores: compiled", done.returncode == 0, done.stderr)
    status, report = launch(LINEFORM, "--fleet", TURTLES, "--duration", 5, "--core", f"bot1={library}", "--core", f"bot3={library}",
                            "--logs", folder / "logs")
    clean("cores", report, 15)
    check("cores: status", status == 0, status, report)
    check("cores: they move", moved(folder / "logs" / "bot1.mcap"))
    done = rondo("launch", LINEFORM, "--fleet", TURTLES, "--core", f"bot9={library}")
    check("cores: no such robot", done.returncode == 1 and "no robot `bot9`" in done.stderr, done.stderr)
    done = rondo("run", LINEFORM, "--fleet", TURTLES, "--robot", "bot0", "--core", folder / "nothing.so")
    check("cores: no library", done.returncode == 1 and "cannot load" in done.stderr, done.stderr)


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        parts = {"refusals": refusals, "fleets": fleets, "simulated_time": simulated_time, "adapters": adapters, "secured": secured, "logs": logs,
                 "altered": altered, "evict": lambda f: killed(f, "evict"), "halt": lambda f: killed(f, "halt"), "interrupted": interrupted,
                 "doctor": doctor, "vendors": vendors, "rust": rust, "cores": cores, "wire": wire, "mistakes": mistakes}
        for part in [parts[word] for word in sys.argv[2:]] or parts.values():
            part(folder)
    print(f"{len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
