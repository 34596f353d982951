#!/usr/bin/env python3
"""Programs as C++: projects that `rondo build` makes, compiled against what is installed, as their users do.

  build.py BUILD [PART...]
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
EXAMPLES = ROOT / "examples/koord"
BUILD = pathlib.Path(sys.argv[1]).resolve()
results = {"passed": 0, "failed": 0}

MAIN = """#include <cstdio>
#include <rondo/program/codec.h>
#include "koord/lineform.h"

int main() {{
  koord::lineform::Calls answers;
{snippet}
  return 0;
}}
"""


def check(name, good, *shown):
    results["passed" if good else "failed"] += 1
    if not good:
        print(f"{name}:", *shown)


def run(*args, **more):
    return subprocess.run([str(a) for a in args], capture_output=True, text=True, timeout=300, **more)


def must(*args, **more):
    done = run(*args, **more)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, args))}: {done.stdout}{done.stderr}")
    return done.stdout


def project(folder, prefix, name, *options):
    """Makes and compiles a project; the path of its library."""
    made = folder / name
    must(prefix / "bin/rondo", "build", EXAMPLES / name, "-o", made, *options)
    must("cmake", "-S", made, "-B", made / "build", f"-DCMAKE_PREFIX_PATH={prefix}")
    must("cmake", "--build", made / "build")
    return made / "build" / f"libkoord_{name}_core.so"


def campaigns(folder, prefix):
    """Robots whose events C++ runs do what others do: whole campaigns are equal, by the same seeds."""
    rondo = prefix / "bin/rondo"
    for name, robots, options in (("mutex", 3, ["--robots", "3"]), ("delivery", 4, ["--capacity", "16"])):
        core = project(folder, prefix, name, *options)
        seen = []
        for more in (["--robots", robots, robots], ["--core", core]):
            report = json.loads(must(rondo, "campaign", EXAMPLES / name, "--runs", "200", *more, "--json", cwd=folder))
            seen.append({k: v for k, v in report.items() if "seconds" not in k or k == "virtual_seconds"})
        check(f"campaign {name}", seen[0] == seen[1] and seen[0]["rounds"] > 1000, seen)
        wrong = run(rondo, "campaign", EXAMPLES / name, "--core", core, "--robots", robots + 1, robots + 1, cwd=folder)
        check(f"campaign {name} of another size", wrong.returncode == 1 and f"made for {robots} robots" in wrong.stderr, wrong.stderr)
    other = run(rondo, "campaign", EXAMPLES / "delivery", "--core", folder / "mutex/build/libkoord_mutex_core.so", "--robots", 3, 3, cwd=folder)
    check("a library of another program", other.returncode == 1 and "made of another program" in other.stderr, other.stderr)
    alien = run(rondo, "campaign", EXAMPLES / "mutex", "--core", BUILD / "adapters/libbattery.so", cwd=folder)
    check("a library of something else", alien.returncode == 1 and "no program that `rondo build` made" in alien.stderr, alien.stderr)


def documented(folder, prefix):
    """The team in one process that docs/build.md shows: natively, and for another processor if its compiler is here."""
    made = folder / "documented"
    must(prefix / "bin/rondo", "build", EXAMPLES / "lineform", "--robots", 6, "--fleet", EXAMPLES / "lineform.toml", "-o", made)
    text = (ROOT / "docs/build.md").read_text()
    block = next(b for b in re.findall(r"```cpp\n(.*?)```", text, re.DOTALL) if "Begin(" in b)
    (made / "main.cc").write_text(MAIN.format(snippet="\n".join("  " + line for line in block.splitlines())))
    flags = ["-std=c++20", "-O2", "-Wall", "-Wextra", "-Werror", "-ffp-contract=off", f"-I{prefix}/include", f"-I{prefix}/include/rondo", f"-I{made}"]
    must("c++", *flags, made / "main.cc", made / "koord/lineform.cc", "-o", made / "team")
    natively = must(made / "team")
    check("a team in one process", re.fullmatch(r"(-?[\d.]+ ){18}\n", natively) is not None, natively)
    if shutil.which("aarch64-linux-gnu-g++") is None or shutil.which("qemu-aarch64") is None:
        print("skipped: another processor (g++-aarch64-linux-gnu, qemu-user)")
        return
    must("aarch64-linux-gnu-g++", *flags, "-static", made / "main.cc", made / "koord/lineform.cc", "-o", made / "team64")
    check("another processor", must("qemu-aarch64", made / "team64") == natively, "it says something else")


def refusals(folder, prefix):
    rondo = prefix / "bin/rondo"
    for name, args, status, says in (
        ("no capacity", [EXAMPLES / "auction", "--print"], 1, "nothing says how many items a `List<Item>` has at most"),
        ("no robots", [EXAMPLES / "mutex", "--print"], 1, "nothing says for how many robots"),
        ("nowhere", [EXAMPLES / "mutex", "--robots", 2], 2, "say where to"),
        ("capacity", [EXAMPLES / "mutex", "--robots", 2, "--print", "--capacity", "List<int>"], 2, "neither a number"),
        ("no such type", [EXAMPLES / "auction", "--print", "--capacity", "8", "--capacity", "List<Itm>=4"], 1, "no type `List<Itm>`"),
        ("a file for a folder", [EXAMPLES / "mutex", "--robots", 2, "-o", "/dev/null"], 1, "cannot make `/dev/null`"),
        ("no program", [folder / "nothing.koord", "--robots", 2, "--print"], 1, "nothing.koord"),
    ):
        done = run(rondo, "build", *args, cwd=folder)
        check(name, done.returncode == status and says in done.stderr, done.returncode, done.stdout[:200], done.stderr)
    # What the user filled in stays.
    made = folder / "kept"
    must(rondo, "build", EXAMPLES / "mapping", "--capacity", 16, "-o", made)
    (made / "answers.h").write_text("mine")
    report = json.loads(must(rondo, "build", EXAMPLES / "mapping", "--capacity", 16, "-o", made, "--json"))
    check("answers stay", (made / "answers.h").read_text() == "mine" and not any("answers" in w for w in report["written"]), report)


PARTS = {"campaigns": campaigns, "documented": documented, "refusals": refusals}


def main():
    wanted = sys.argv[2:] or list(PARTS)
    with tempfile.TemporaryDirectory() as folder:
        prefix = pathlib.Path(folder, "usr")
        must("cmake", "--install", BUILD, "--prefix", prefix)
        os.environ["XDG_CACHE_HOME"] = folder
        for name in wanted:
            part = pathlib.Path(folder, "part-" + name)
            part.mkdir()
            PARTS[name](part, prefix)
    print(f"{results['passed']} passed, {results['failed']} failed")
    sys.exit(1 if results["failed"] else 0)


if __name__ == "__main__":
    main()
