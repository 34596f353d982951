#!/usr/bin/env python3
"""The packages on a Debian with nothing else: they install, a first project is proved, simulated and looked at. Needs root and debootstrap.

  clean_system.py PACKAGES     after `./dev package`
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SUITE = "bookworm"
USE = """set -e
cd /root
rondo new --template koord fleet
cd fleet
rondo prove fleet.koord
rondo simulate fleet.koord --duration 5 --trace run.mcap
rondo view run.mcap
test -s run.html
rondo prove /usr/share/rondo/examples/choreo/handover.rondo
rondo simulate /usr/share/rondo/examples/choreo/handover.rondo
test -s /usr/share/man/man1/rondo-prove.1.gz
test -s /usr/share/bash-completion/completions/rondo
test -s /usr/include/rondo/adapter.h
"""


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: {done.stdout[-3000:]}{done.stderr[-3000:]}")
    return done.stdout


def main():
    packages = sorted(pathlib.Path(sys.argv[1]).glob("*.deb"))
    if len(packages) != 3:
        sys.exit(f"three packages are wanted: {packages}")
    if os.geteuid() != 0 or shutil.which("debootstrap") is None:
        print("skipped: needs root and debootstrap")
        return
    # Where this machine has its packages from.
    apt = pathlib.Path("/etc/apt")
    lists = "".join(p.read_text() for p in [apt / "sources.list", *apt.glob("sources.list.d/*")] if p.is_file())
    mirror = next((m for m in re.findall(r"https?://\S+/debian(?=\s|$)", lists, re.M)), "http://deb.debian.org/debian")
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder, "debian")
        run("debootstrap", "--variant=minbase", SUITE, root, mirror)
        for configuration in apt.glob("apt.conf.d/*"):
            shutil.copy(configuration, root / "etc/apt/apt.conf.d")
        (root / "packages").mkdir()
        for package in packages:
            shutil.copy(package, root / "packages")
        run("chroot", root, "sh", "-c", "apt-get update -q && DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends /packages/*.deb")
        run("chroot", root, "sh", "-c", USE)
    print("the packages work on a clean system")


main()
