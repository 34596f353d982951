#!/usr/bin/env python3
"""rondo reach beyond its verdicts: refutations replay and damaged ones are refused, pictures, sweeps, tubes of one
robot that serve others, certificates, tubes that are learned, simulators of the user's.

  reachability.py RONDO
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import xml.dom.minidom

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
EXAMPLES = ROOT / "examples" / "reach"
checks = [0, 0]


def check(condition, what):
    checks[0 if condition else 1] += 1
    if not condition:
        print(f"FAILED: {what}")


def run(rondo, *args):
    return subprocess.run([rondo, *map(str, args)], capture_output=True, text=True, timeout=600)


def replays(rondo, folder):
    saved = folder / "wide.json"
    done = run(rondo, "reach", "--contract", "Wide", "--save", saved, EXAMPLES / "quadrotor_altitude.rondo")
    check(done.returncode == 1 and f"rondo replay {saved}" in done.stdout, f"a refutation is saved: {done.stdout}")
    done = run(rondo, "replay", saved)
    check(done.returncode == 0 and "breaks `during`" in done.stdout, f"it replays: {done.stdout}{done.stderr}")
    good = json.loads(saved.read_text())
    damaged = {
        "a start elsewhere": {"start": [5.0] + good["start"][1:]},
        "a start that breaks nothing": {"start": [0.0] * len(good["start"])},
        "another time": {"time": 0.1},
        "a time after the end": {"time": 1e9},
        "too short a start": {"start": good["start"][:3]},
        "another contract": {"contract": "Quadrotor: Nothing()"},
        "another claim": {"breaks": "nothing"},
        "no file": {"files": ["/nowhere.rondo"]},
        "no numbers": {"start": ["x"]},
        "no list": {"inputs": 3},
        "no period": {"input_period": 0},
    }
    for what, change in damaged.items():
        saved.write_text(json.dumps({**good, **change}))
        done = run(rondo, "replay", saved)
        check(done.returncode == 1, f"{what} is refused: {done.stdout}")
    for text in ("", "{", '{"format": "rondo-trajectory/1"}', '{"format": "rondo-trajectory/1", "files": []}'):
        saved.write_text(text)
        check(run(rondo, "replay", saved).returncode == 1, f"`{text}` is refused")


def pictures(rondo, folder):
    svg = folder / "tube.svg"
    done = run(rondo, "reach", "--svg", svg, EXAMPLES / "lotka_volterra.rondo")
    check(done.returncode == 0 and svg.exists(), "a picture of a proof")
    check("proved and certified" in done.stdout, f"a touch is certified: {done.stdout}")
    xml.dom.minidom.parse(str(svg))
    text = svg.read_text()
    check("y over x" in text and "crossings" in text, "with the plane and every state")
    done = run(rondo, "reach", "--svg", folder / "q.svg", "--save", folder / "q.json", EXAMPLES / "quadrotor_altitude.rondo")
    check(all((folder / f"q-{k}.svg").exists() for k in (1, 2, 3)), f"a picture for each contract: {done.stdout}")
    xml.dom.minidom.parse(str(folder / "q-3.svg"))
    done = run(rondo, "reach", "--svg", svg / "x.svg", EXAMPLES / "van_der_pol.rondo")
    check(done.returncode == 1, "a picture that cannot be written")


def sweeps(rondo, folder):
    model = folder / "ball.rondo"
    # Critically damped at gain 4: less damping overshoots.
    model.write_text("""robot Ball {
  param damping = 4
  state x: length in [-3 m, 3 m]
  state v: speed in [-9 m / 1 s, 9 m / 1 s]
  input push: acceleration
  dynamics { x' = v; v' = push }
  motion Settle() noninterruptible [5 s, 5 s] {
    modifies x, v
    pre x == -1 m and v == 0
    during x < 5 cm
    control { push = -4 / 1 s / 1 s * x - damping / 1 s * v }
  }
}
""")
    done = run(rondo, "reach", "--json", "--sweep", "damping", "1..8", "--parts", "64", model)
    parts = json.loads(done.stdout)["sweeps"][0]["parts"]
    check(parts[0]["verdict"] == "refuted" and parts[-1]["verdict"] == "proved" and parts[-1]["to"] == 8, f"{parts}")
    # exp(-pi z / sqrt(1 - z^2)) = 0.05 with z = damping / 4: 2.76
    boundary = next(p["from"] for p in parts if p["verdict"] == "proved")
    check(2.76 < boundary < 2.76 + 3 * 7 / 64, f"the proved boundary is {boundary}")
    refuted = next(p["to"] for p in reversed(parts) if p["verdict"] == "refuted")
    check(refuted <= boundary and refuted > 2.4, f"refuted up to {refuted}")
    # A start that is a parameter, a parameter with a default: 4 e^0.4 is 5.967.
    grows = folder / "grows.rondo"
    grows.write_text("""robot Grows {
  state x: length in [-9 m, 9 m]
  dynamics { x' = x / 1 s }
  motion Go(x0: length in [1 m, 4 m], room: length = 5 m) noninterruptible [0.4 s, 0.4 s] {
    modifies x
    pre x == x0
    during x <= room
  }
}
""")
    done = run(rondo, "reach", "--json", "--no-cache", grows)
    check(json.loads(done.stdout)["contracts"][0]["verdict"] == "refuted", f"{done.stdout}")
    done = run(rondo, "reach", "--json", "--sweep", "room", "5..7", "--parts", "2", grows)
    parts = json.loads(done.stdout)["sweeps"][0]["parts"]
    check([(p["verdict"], p["to"]) for p in parts] == [("refuted", 6), ("proved", 7)], f"{parts}")
    # Behind a choreography: every robot that has the parameter.
    team = folder / "team.rondo"
    team.write_text("""import "ball.rondo"
world W { a: Ball(damping = 5) b: Ball at (9 m, 0, 0) }
choreography C in W {
  initially a.x == -1 m and a.v == 0 and b.x == -1 m and b.v == 0
  { a: Settle(), b: Settle() }
}
""")
    done = run(rondo, "reach", "--json", "--sweep", "damping", "3..4", "--parts", "2", team)
    swept = json.loads(done.stdout)["sweeps"]
    check(done.returncode == 0 and [s["contract"] for s in swept] == ["a: Settle()", "b: Settle()"], f"{swept}")
    # Behind a program: its own parameters, and those of the model. Of 0.4 degrees a minute, 0.4 a round.
    hvac = ROOT / "examples" / "koord" / "hvac.koord"
    done = run(rondo, "reach", "--json", "--sweep", "drift", "0..1", "--parts", "8", hvac)
    for swept in json.loads(done.stdout)["sweeps"]:
        proved = [p for p in swept["parts"] if p["verdict"] == "proved"]
        check(done.returncode == 1 and proved[0]["from"] == 0.5 and proved[-1]["to"] == 1, f"{swept}")
    check(run(rondo, "reach", "--sweep", "nothing", "1..2", model).returncode == 1, "a parameter that is not there")
    check(run(rondo, "reach", "--sweep", "damping", "2..1", model).returncode == 1, "a range that is none")
    check(run(rondo, "reach", "--sweep", "damping", "1", model).returncode == 1, "no range")


# x = -(1 + 2 t) exp(-2 t), v = 4 t exp(-2 t).
def ranges(rondo, folder):
    model = folder / "ball.rondo"
    done = run(rondo, "reach", "--json", "--no-cache", "--range", "v", "--range", "x + 1 m * sin(clock * 0)", model)
    check(done.returncode == 1 and "clock" in done.stdout, f"what is not there cannot be asked for: {done.stdout}")
    done = run(rondo, "reach", "--json", "--no-cache", "--range", "v", "--range", "abs(x) - 2 cm", model)
    found = json.loads(done.stdout)["contracts"][0]["ranges"]
    check(done.returncode == 0 and [r["unit"] for r in found] == ["m/s", "m"] and found[0]["to"] == 5, f"{found}")
    check(0.735758 < found[0]["most"] < 0.736 and -1e-3 < found[0]["least"] <= 0, f"the speed is {found[0]}")
    check(0.98 <= found[1]["most"] < 0.981 and -0.03 < found[1]["least"] < -0.0195, f"{found[1]}")
    done = run(rondo, "reach", "--json", "--no-cache", "--range", "v", "--between", "0.5..0.5", model)
    one = json.loads(done.stdout)["contracts"][0]["ranges"][0]
    check(0.73575 < one["least"] <= 0.7357588823428847 <= one["most"] < 0.73577, f"{one}")
    for wrong in (["--range", "v +"], ["--range", "v < 1"], ["--range", "v + x"], ["--range", "v", "--between", "9..10"],
                  ["--range", "v", "--between", "2..1"], ["--between", "1..2"], ["--range", "v", "--statistical"]):
        check(run(rondo, "reach", "--no-cache", *wrong, model).returncode == 1, f"{wrong} is refused")


def reuse(rondo, folder):
    done = run(rondo, "reach", "--json", "--no-cache", ROOT / "examples" / "choreo" / "driven.rondo")
    contracts = json.loads(done.stdout)["contracts"]
    check(done.returncode == 0 and sum("same_as" in c for c in contracts) == 2, f"two of four tubes serve: {done.stdout}")
    check(all(c["certified"] for c in contracts), f"all are certified: {done.stdout}")
    # Which way it goes does not matter, unless something has a direction.
    model = (ROOT / "models" / "car.rondo").read_text()
    (folder / "car.rondo").write_text(model)
    (folder / "windy.rondo").write_text(model.replace("x' = speed * cos(theta)", "x' = speed * cos(theta) + 1 cm / 1 s"))
    for name, proofs in ("car", 1), ("windy", 2):
        team = folder / f"{name}_team.rondo"
        team.write_text(f"""import "{name}.rondo"
world W {{ a: Car b: Car at (9 m, 0, 0) }}
choreography C in W {{
  initially a.x == 0 and a.y == 0 and a.theta == 0 and b.x == 0 and b.y == 0 and b.theta == 50 deg
  {{ a: FollowLine(0, 0, 0), b: FollowLine(0, 0, 50 deg) }}
}}
""")
        done = run(rondo, "reach", "--json", "--no-cache", "--timeout", "280", team)
        contracts = json.loads(done.stdout)["contracts"]
        check(done.returncode == 0 and all(c["certified"] for c in contracts), f"{name}: {done.stdout}")
        check(sum("same_as" not in c for c in contracts) == proofs, f"{name}: {contracts}")
    done = run(rondo, "reach", "--json", "--no-cache", "--contract", "FollowLine", folder / "car.rondo")
    one = json.loads(done.stdout)["contracts"][0]
    check(one["verdict"] == "proved" and one["whatever"] == ["x0", "y0", "heading"], f"{one}")


def certificates(rondo, folder):
    def certify(path):
        return run(rondo, "certify", path)

    model = folder / "groove.rondo"
    text = (ROOT / "src" / "robot" / "dynamics" / "testdata" / "contracts" / "proved.rondo").read_text().split("#>")[0]
    model.write_text(text)
    done = run(rondo, "reach", "--no-cache", "--contract", "Settle", "--certificates", folder / "proofs", model)
    written = sorted((folder / "proofs").glob("*.tube.json"))
    check(done.returncode == 0 and len(written) == 1 and str(written[0]) in done.stdout, f"a file is written: {done.stdout}")
    done = certify(written[0])
    check(done.returncode == 0 and "accepted" in done.stdout, f"it is accepted: {done.stdout}{done.stderr}")
    good = json.loads(written[0].read_text())
    bad = folder / "bad.tube.json"
    steps = good["parts"][0]["steps"]
    damaged = {
        "no parts": {"parts": []},
        "half of the initial set": {"parts": [{"path": [[0, True]], "steps": steps}]},
        "a state that there is none of": {"parts": [{"path": [[99, b]], "steps": steps} for b in (False, True)]},
        "no steps": {"parts": [{"path": [], "steps": []}]},
        "steps that are none": {"parts": [{"path": [], "steps": [["x", 1]]}]},
        "a kind of step that there is none of": {"parts": [{"path": [], "steps": [{"kind": 3}]}]},
        "another contract": {"contract": "Ball: Nothing()"},
        "no file": {"files": ["/nowhere.rondo"]},
        "another format": {"format": "rondo-tube/0"},
    }
    for what, change in damaged.items():
        bad.write_text(json.dumps({**good, **change}))
        done = certify(bad)
        check(done.returncode == 1 and "certificate-rejected" in done.stderr, f"{what} is refused: {done.stdout}{done.stderr}")
    for part in ("{", '{"format": "rondo-tube/1"}', written[0].read_text()[:200]):
        bad.write_text(part)
        check(certify(bad).returncode == 1, f"`{part}` is refused")
    model.write_text(text.replace("during abs(x) < 0.25 m", "during abs(x) < 0.2 m"))
    done = certify(written[0])
    check(done.returncode == 1 and "is not shown" in done.stderr, f"a contract that fails is not certified: {done.stderr}")
    # An event: its time is checked.
    lift = (ROOT / "src" / "robot" / "dynamics" / "testdata" / "contracts" / "events.rondo").read_text().split("#>")[0]
    model.write_text(lift)
    run(rondo, "reach", "--no-cache", "--certificates", folder / "lift", model)
    written = next((folder / "lift").glob("*.tube.json"))
    check(certify(written).returncode == 0, "events are certified")
    record = json.loads(written.read_text())
    crossing = next(s for p in record["parts"] for s in p["steps"] if isinstance(s, dict) and s["kind"] == "cross")
    for key, value in {"event": 7, "length": 1e-6, "together": 1e3, "time": [[[0], -1.0]]}.items():
        was, crossing[key] = crossing[key], value
        bad.write_text(json.dumps(record))
        crossing[key] = was
        check(certify(bad).returncode == 1, f"an event with another `{key}` is not shown")


def samples(rondo, folder):
    model = EXAMPLES / "van_der_pol.rondo"
    done = run(rondo, "reach", "--json", "--statistical", "--tube", "compat", "--runs", "500", model)
    compat = json.loads(done.stdout)["contracts"][0]
    done = run(rondo, "reach", "--json", "--statistical", "--tube", "careful", "--runs", "500", model)
    careful = json.loads(done.stdout)["contracts"][0]
    check(done.returncode == 3, "a tube of samples proves nothing")
    check(compat["corner_failures"] > 0 and careful["corner_failures"] == 0, f"{compat} {careful}")
    done = run(rondo, "reach", "--json", "--statistical", "--runs", "300", EXAMPLES / "lotka_volterra.rondo")
    check(json.loads(done.stdout)["contracts"][0]["failures"] == 0, f"events are simulated: {done.stdout}")
    done = run(rondo, "reach", "--statistical", "--simulator", folder / "none.so", model)
    check("cannot load" in done.stdout, f"a library that is not there: {done.stdout}")
    compiler = os.environ.get("CC") or shutil.which("cc")
    if compiler is None:
        return
    source = folder / "simulator.c"
    source.write_text('''#include "rondo_simulator.h"
int rondo_simulate(const double* start, size_t n, double dt, size_t steps, double* trace) {
  double x = start[0], y = start[1], h = dt / 200;
  for (size_t k = 0; k <= steps; ++k) {
    trace[k * n] = x;
    trace[k * n + 1] = y;
    for (int s = 0; s < 200; ++s) {
      double a = y, b = (1 - x * x) * y - x;
      x += h * a;
      y += h * b;
    }
  }
  return FAIL;
}
''')
    for fail in (0, 7):
        library = folder / f"simulator{fail}.so"
        subprocess.run([compiler, "-shared", "-fPIC", f"-DFAIL={fail}", "-I", ROOT / "src" / "reach" / "simulation",
                        "-o", library, source], check=True)
        done = run(rondo, "reach", "--json", "--statistical", "--runs", "200", "--simulator", library, model)
        result = json.loads(done.stdout)["contracts"][0]
        if fail == 0:
            check(result["failures"] == 0 and result["verdict"] == "statistical", f"a library simulates: {result}")
        else:
            check(result["verdict"] == "unknown" and "failed with 7" in result["reason"], f"a library fails: {result}")


def main():
    rondo = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        os.environ["XDG_CACHE_HOME"] = str(folder / "cache")
        replays(rondo, folder)
        pictures(rondo, folder)
        sweeps(rondo, folder)
        ranges(rondo, folder)
        reuse(rondo, folder)
        certificates(rondo, folder)
        samples(rondo, folder)
    print(f"{checks[0]} checks passed, {checks[1]} failed")
    return 1 if checks[1] else 0


if __name__ == "__main__":
    sys.exit(main())
