#!/usr/bin/env python3
"""Follows the pages of docs/howto literally, in a copy of the sources.

  howto.py             whether every edit of every page still has its place, and each page counts its files rightly
  howto.py --build [PAGE...]   also builds the copy (build/howto) and runs the commands of the pages

In a page, a block ```diff FILE changes a file: lines that begin with a blank or `-` stand there, once, one after the
other; those with `-` go, those with `+` come. A block ```new FILE is a new file. A block ```sh are commands; `$` lines
are run, and what stands below one is part of what it prints.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
COPY = ROOT / "build/howto"
BLOCK = re.compile(r"^```(diff|new|sh)(?: (\S+))?\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def edited(text, block):
    """The text after a change; None if the place is not there exactly once."""
    lines = block.splitlines()
    before = [line[1:] for line in lines if line[:1] in (" ", "-")]
    after = [line[1:] for line in lines if line[:1] in (" ", "+")]
    old = "\n".join(before) + "\n"
    return text.replace(old, "\n".join(after) + "\n") if ("\n" + text).count("\n" + old) == 1 else None


def follow(page, folder, build):
    """What is wrong with the page; `folder` has the sources afterwards as the page says."""
    problems, touched = [], set()
    text = page.read_text(encoding="utf-8")
    for kind, name, block in BLOCK.findall(text):
        if kind == "sh":
            continue
        touched.add(name)
        path = folder / name
        if kind == "new":
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block, encoding="utf-8")
            continue
        changed = edited(path.read_text(encoding="utf-8"), block) if path.is_file() else None
        if changed is None:
            problems.append(f"{page.name}: this change has no place in {name}:\n{block}")
        else:
            path.write_text(changed, encoding="utf-8")
    counted = re.search(r"^(\d+) files\b", text, re.MULTILINE)
    if not counted or int(counted.group(1)) != len(touched):
        problems.append(f"{page.name}: {len(touched)} files are touched, the page says {counted and counted.group(1)}")
    if build and not problems:
        problems += run(page, text, folder)
    return problems


def run(page, text, folder):
    subprocess.run(["cmake", "--preset", "release"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    if subprocess.run(["cmake", "--build", "--preset", "release"], cwd=folder).returncode != 0:
        return [f"{page.name}: what it says does not compile"]
    problems = []
    for kind, _, block in BLOCK.findall(text):
        if kind != "sh":
            continue
        for command, printed in re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", block, re.MULTILINE):
            done = subprocess.run(command, shell=True, cwd=folder, capture_output=True, text=True)
            if printed.strip() not in done.stdout + done.stderr:
                problems.append(f"{page.name}: `{command}` prints\n{done.stdout}{done.stderr}")
    return problems


def sources(folder):
    """A copy of the sources as they are, beside what an earlier build left behind."""
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=ROOT,
                            capture_output=True, text=True, check=True).stdout.splitlines()
    for path in [p for p in folder.rglob("*") if p.is_file() and "build" not in p.relative_to(folder).parts]:
        if str(path.relative_to(folder)) not in listed:
            path.unlink()
    for name in listed:
        path, to = ROOT / name, folder / name
        if path.is_file() and not (to.is_file() and to.read_bytes() == path.read_bytes()):
            to.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(path, to)
            os.utime(to)


def main():
    build = "--build" in sys.argv
    names = [a for a in sys.argv[1:] if not a.startswith("-")]
    pages = [p for p in sorted((ROOT / "docs/howto").glob("*.md")) if not names or p.stem in names]
    problems = []
    for page in pages:
        sources(COPY)
        problems += follow(page, COPY, build)
    for problem in problems:
        print(problem)
    print(f"{len(pages)} pages, {len(problems)} problems")
    return 1 if problems or not pages else 0


if __name__ == "__main__":
    sys.exit(main())
