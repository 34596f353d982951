#!/usr/bin/env python3
"""How long a synchronous message of a choreography takes on DDS, beside a ping and its answer written by hand over the same library
(bench/dds/messages.cc), in turn, in one run: with nothing lost, and with a fifth of all packets. What is lost is sent again after 10 ms, by both.

  messages.py RONDO
"""
import os
import pathlib
import subprocess
import sys

COUNT, RESEND = 4000, 10_000


def quantile(values, share):
    return sorted(values)[int(share * (len(values) - 1))]


def run(program, kind, count, lost):
    env = dict(os.environ, ROS_DOMAIN_ID="91", ROS_LOCALHOST_ONLY="1")
    answers = subprocess.Popen([program, kind, "1", str(count), str(RESEND), str(lost)], env=env)
    sends = subprocess.run([program, kind, "0", str(count), str(RESEND), str(lost)], env=env, capture_output=True, text=True, timeout=300)
    answers.wait(timeout=60)
    return [float(line) for line in sends.stdout.split()]


def main():
    program = pathlib.Path(sys.argv[1]).resolve().parent / "messages"
    print("lost      what     median         p99        most")
    for lost, count in ((0, COUNT), (200, COUNT // 4)):
        times = {"hand": [], "rondo": []}
        for _ in range(3):
            for kind, all_ in times.items():
                all_ += run(program, kind, count, lost)
        for kind, all_ in times.items():
            print(f"{lost / 1000:4.1f}  {kind:>8}  {quantile(all_, 0.5):6.0f} us  {quantile(all_, 0.99):7.0f} us  {max(all_):7.0f} us")
        print(f"      ratio     {quantile(times['rondo'], 0.5) / quantile(times['hand'], 0.5):6.2f}     {quantile(times['rondo'], 0.99) / quantile(times['hand'], 0.99):7.2f}")


if __name__ == "__main__":
    main()
