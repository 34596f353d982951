#!/usr/bin/env python3
"""How long a round takes on DDS, beside a barrier written by hand over the same library (bench/dds/barrier.cc): two exchanges of
150 bytes, one thread, what is lost is written again after a millisecond. In turn, in one run, rounds of 10 ms.

  dds.py RONDO
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
LOSSY = ('<CycloneDDS><Domain Id="any"><General><Interfaces><NetworkInterface name="lo" multicast="true"/></Interfaces><AllowMulticast>true'
         "</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex></Discovery><Internal><Test><XmitLossiness>{}"
         "</XmitLossiness></Test></Internal></Domain></CycloneDDS>")
FLEET = """[run]
delta = 0.01
[rounds]
lease = 2
patience = 2
[[robot]]
name = "r"
model = "point_mass"
position = [0, 0, 0]
count = {}
"""


def quantile(values, share):
    return sorted(values)[int(share * (len(values) - 1))]


def together(commands, env):
    processes = [subprocess.Popen(c, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=env) for c in commands]
    return [p.communicate(timeout=300)[0] for p in processes]


def barrier(program, robots, lost, env):
    out = together([[program, str(robots), str(r), "500", "10000", "150", str(lost)] for r in range(robots)], env)
    spans = [int(line) * 1e-6 for text in out for line in text.split()]
    return quantile(spans, 0.5), quantile(spans, 0.99)


def rounds(rondo, folder, robots, lost, env):
    (folder / "mutex.koord").write_text((ROOT / "examples/koord/mutex.koord").read_text())
    (folder / "mutex.toml").write_text(FLEET.format(robots))
    if lost:
        env = dict(env, CYCLONEDDS_URI=LOSSY.format(lost))
    out = together([[rondo, "run", str(folder / "mutex"), "--robot", f"r{r}", "--duration", "6", "--json"] for r in range(robots)], env)
    waits = [json.loads(text)["wait"] for text in out]
    # Of the robot in the middle: the barrier's are of all together.
    return quantile([w["median"] for w in waits], 0.5), quantile([w["p99"] for w in waits], 0.5)


def main():
    rondo = str(pathlib.Path(sys.argv[1]).resolve())
    program = str(pathlib.Path(rondo).parent / "barrier")
    env = dict(os.environ, ROS_DOMAIN_ID=str(90 + os.getpid() % 9), ROS_LOCALHOST_ONLY="1")
    env.pop("CYCLONEDDS_URI", None)
    print("robots  loss   median   99 of 100   barrier: median   99 of 100   ratios (bars: 1.3 without loss, 1.5 of 99 in 100 with)")
    with tempfile.TemporaryDirectory() as name:
        for robots, lost in ((4, 0), (16, 0), (3, 200)):
            theirs = barrier(program, robots, lost, env)
            ours = rounds(rondo, pathlib.Path(name), robots, lost, env)
            print(f"{robots:6} {lost / 10:4.0f} %  {1e3 * ours[0]:6.2f} ms   {1e3 * ours[1]:6.2f} ms     {1e3 * theirs[0]:11.2f} ms   {1e3 * theirs[1]:6.2f} ms   "
                  f"{ours[0] / theirs[0]:.2f}  {ours[1] / theirs[1]:.2f}")


if __name__ == "__main__":
    main()
