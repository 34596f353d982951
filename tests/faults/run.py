#!/usr/bin/env python3
"""Deliberate faults: which of them does some test notice?

Every entry of faults.toml says what one place of the sources would be if somebody had made a mistake there. All faults
are woven into a copy of the sources, each behind a switch, and compiled once; the environment variable RONDO_FAULT
chooses the one that is active. Without a fault every test must pass; with one, some test of its entry must fail.

  run.py [FAULT...]       build, then try these faults (default: all)
  run.py --check          only tell whether each entry has exactly one place in the sources
  run.py --list           the names

The status is 0 if at least nine of ten faults are noticed; those that are not are named in any case.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import time
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FOLDER = ROOT / "build/faults"
SOURCE = FOLDER / "source"
BINARY = FOLDER / "binary"
SWITCH = """#pragma once
// Made by tests/faults/run.py: is the deliberate fault of this name active?
#include <cstdlib>
#include <cstring>
namespace rondo_fault {
inline bool Chosen(const char* name) {
  const char* chosen = std::getenv("RONDO_FAULT");
  return chosen != nullptr && std::strcmp(chosen, name) == 0;
}
}  // namespace rondo_fault
#define RONDO_FAULT_IS(name) ([] { static const bool chosen = ::rondo_fault::Chosen(name); return chosen; }())
"""
FLAGS = "-O2 -w"
# Some faults make programs run for ever: that is noticed, too.
LONGEST = 300


def load():
    with open(ROOT / "tests/faults/faults.toml", "rb") as file:
        data = tomllib.load(file)
    return data["areas"], data["fault"]


def woven(fault):
    """The text with both variants: a statement if it ends like one, otherwise an expression."""
    switch = f'RONDO_FAULT_IS("{fault["name"]}")'
    old, new = fault["old"].strip("\n"), fault["new"].strip("\n")
    if ";" in old and old.rstrip().endswith((";", "}")):
        return f"if ({switch}) {{ {new} }} else {{ {old} }}"
    return f"({switch} ? ({new}) : ({old}))"


def check(areas, faults):
    problems = []
    names = [f["name"] for f in faults]
    problems += [f"{n}: the name occurs twice" for n in set(names) if names.count(n) > 1]
    for fault in faults:
        text = (ROOT / fault["file"]).read_text()
        count = text.count(fault["old"].strip("\n"))
        if count != 1:
            problems.append(f"{fault['name']}: its text occurs {count} times in {fault['file']}")
    # The unit tests of a component are one program, named after its folder.
    units = {"rondo_" + "_".join(path.parent.relative_to(ROOT / "src").parts) + "_test" for path in ROOT.glob("src/**/*_test.cc")}
    problems += [f"{name}: there is no such program" for name in programs(areas, faults) if name.startswith("rondo_") and name not in units]
    return problems


def programs(areas, faults):
    """The test programs that are named, beside `rondo` itself."""
    tests = [t for ts in areas.values() for t in ts] + [t for f in faults for t in f.get("tests", [])]
    return sorted({t.partition(":")[0] for t in tests} - {"golden", "e2e"})


def weave(faults):
    """A copy of the sources with all faults in it; files that are as they were keep their time."""
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True, check=True)
    names = listed.stdout.splitlines()
    # What was moved away must not be compiled from here.
    for path in [*SOURCE.rglob("*.cc"), *SOURCE.rglob("*.h")]:
        if str(path.relative_to(SOURCE)) not in names and path.name != "fault_switch.h":
            path.unlink()
    for name in names:
        path = ROOT / name
        if not path.is_file():
            continue
        content = path.read_bytes()
        mine = [f for f in faults if f["file"] == name]
        if mine:
            text = content.decode()
            for fault in mine:
                text = text.replace(fault["old"].strip("\n"), woven(fault))
            content = ('#include "fault_switch.h"\n' + text).encode()
        to = SOURCE / name
        if to.is_file() and to.read_bytes() == content:
            continue
        to.parent.mkdir(parents=True, exist_ok=True)
        to.write_bytes(content)
        to.chmod(path.stat().st_mode)
    switch = SOURCE / "src/fault_switch.h"
    if not switch.is_file() or switch.read_text() != SWITCH:
        switch.write_text(SWITCH)


def build(areas, faults):
    if not (BINARY / "build.ninja").is_file():
        subprocess.run(["cmake", "-G", "Ninja", "-S", str(SOURCE), "-B", str(BINARY), "-DCMAKE_BUILD_TYPE=None",
                        f"-DCMAKE_CXX_FLAGS={FLAGS}", "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", str(BINARY), "--target", "rondo", *programs(areas, faults)], check=True)


def command(test):
    """`golden:CASE`, `e2e:SCRIPT`, or `BINARY:FILTER` of a test program."""
    name, _, rest = test.partition(":")
    rondo = str(BINARY / "bin/rondo")
    if name == "golden":
        return ["python3", "tools/golden.py", rondo, *([rest] if rest else [])]
    if name == "e2e":
        return ["python3", f"tests/e2e/{rest}.py", rondo]
    return [str(BINARY / "bin" / name), *([f"--gtest_filter={rest}"] if rest else [])]


def passes(test, fault=None):
    shutil.rmtree(FOLDER / "cache", ignore_errors=True)  # no verdict of another fault
    environment = {**os.environ, "XDG_CACHE_HOME": str(FOLDER / "cache")}
    environment.pop("RONDO_FAULT", None)
    if fault:
        environment["RONDO_FAULT"] = fault
    try:
        done = subprocess.run(command(test), cwd=SOURCE, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=LONGEST)
    except subprocess.TimeoutExpired:
        return False
    return done.returncode == 0


def main():
    areas, faults = load()
    problems = check(areas, faults)
    for problem in problems:
        print(problem)
    if problems or "--check" in sys.argv:
        print(f"{len(faults)} faults, {len(problems)} problems")
        return 1 if problems else 0
    if "--list" in sys.argv:
        print("\n".join(f["name"] for f in faults))
        return 0
    wanted = [a for a in sys.argv[1:] if not a.startswith("--")]
    unknown = [w for w in wanted if all(f["name"] != w for f in faults)]
    if unknown:
        print(f"no such fault: {', '.join(unknown)}")
        return 2
    weave(faults)
    build(areas, faults)
    chosen = [f for f in faults if not wanted or f["name"] in wanted]
    tests = {f["name"]: f.get("tests", areas[f["area"]]) for f in chosen}
    for test in dict.fromkeys(t for ts in tests.values() for t in ts):
        if not passes(test):
            print(f"{test} fails without any fault")
            return 2
    missed = []
    for fault in chosen:
        begin = time.monotonic()
        by = next((t for t in tests[fault["name"]] if not passes(t, fault["name"])), None)
        print(f"{fault['name']:40} {'noticed by ' + by if by else 'NOT NOTICED'}  {time.monotonic() - begin:.1f} s", flush=True)
        if by is None:
            missed.append(fault["name"])
    print(f"{len(chosen) - len(missed)} of {len(chosen)} faults noticed" + (f"; not noticed: {', '.join(missed)}" if missed else ""))
    return 1 if len(missed) * 10 > len(chosen) else 0


if __name__ == "__main__":
    sys.exit(main())
