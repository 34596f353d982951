#!/usr/bin/env python3
"""How long a round takes over a radio that loses, and what it sends.

Each line is LineForm on simulated quadrotors (`rondo simulate --network`), rounds of 0.1 s. Beside it stands what a barrier does
that waits for everybody's message, and then for everybody's word that it has all, over reliable messages that are repeated
every 100 ms (a usual default of ROS 2 middleware) and never forwarded, with the same loss and the same delays of 0.5 to 1.5 ms.
Bytes: those of the original middleware for LineForm with 12 drones are from its published statistics (204,598 bytes for each agent and
second; all of its traffic, rounds of unknown length).

  rounds.py RONDO
"""
import json
import pathlib
import random
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
ORIGINAL = 204_598


def quantile(values, share):
    values = sorted(values)
    return values[int(share * (len(values) - 1))]


def exchange(robots, loss, rng):
    """Until every message is there: each pair tries every 100 ms."""
    latest = 0.0
    for _ in range(robots * (robots - 1)):
        attempts = 0
        while rng.random() < loss:
            attempts += 1
        latest = max(latest, 0.1 * attempts + rng.uniform(0.0005, 0.0015))
    return latest


def barrier(robots, loss, rounds=4000):
    rng = random.Random(1)
    return [exchange(robots, loss, rng) + exchange(robots, loss, rng) for _ in range(rounds)]


def simulate(rondo, folder, robots, loss, way):
    fleet = (ROOT / "examples/koord/lineform.toml").read_text() + f'\n[rounds]\nexchange = "{way}"\n'
    fleet = fleet.replace("count = 16", f"count = {robots}").replace("delta = 0.5", "delta = 0.1")
    (folder / "fleet.toml").write_text(fleet)
    (folder / "radio.toml").write_text(f"[network]\nloss = {loss}\n")
    done = subprocess.run([rondo, "simulate", str(ROOT / "examples/koord/lineform"), "--fleet", folder / "fleet.toml", "--network",
                           folder / "radio.toml", "--duration", "100", "--json"], capture_output=True, text=True)
    return json.loads(done.stdout)


def main():
    rondo = sys.argv[1]
    print("robots  loss         way   median     p99      max   barrier p99   ratio   bytes/robot/round   bytes/robot/s   x real time")
    with tempfile.TemporaryDirectory() as name:
        for robots in (4, 12, 32):
            for loss, way in [(loss, way) for loss in (0.0, 0.2) for way in ("all-to-all", "sequencer", "central")]:
                report = simulate(rondo, pathlib.Path(name), robots, loss, way)
                network, wait = report["network"], report["network"]["wait"]
                usual = quantile(barrier(robots, loss), 0.99)
                each = network["bytes"] / robots
                print(f"{robots:6}  {loss:4.1f}  {way:>10} {1e3 * wait['median']:6.1f} ms {1e3 * wait['p99']:5.1f} ms {1e3 * wait['max']:5.1f} ms"
                      f" {1e3 * usual:10.0f} ms {usual / wait['p99']:7.1f} {each / report['rounds']:19.0f} {each / report['time']:15.0f}"
                      f" {report['time'] / report['seconds']:13.0f}")
                if robots == 12 and loss == 0 and way == "all-to-all":
                    rate = each / report["time"]
    print(f"the original middleware, 12 robots: {ORIGINAL} bytes/robot/s, {ORIGINAL / rate:.0f} times as many")


if __name__ == "__main__":
    main()
