#!/usr/bin/env python3
"""The viewer: its types, its decoders on real and damaged traces, and its pages in a real browser.

  viewer.py RONDO [PICTURES]

PICTURES: a folder for what each screen looks like.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
RONDO = str(pathlib.Path(sys.argv[1]).resolve())
MODULES = ROOT / "build/node/node_modules"
PAGE = 2_000_000  # bytes, at most
problems = []


def check(what, good, *shown):
    if not good:
        problems.append(what)
        print("FAILED:", what, *(str(s)[:2000] for s in shown))


def run(*command, **more):
    return subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=600, **more)


def rondo(*arguments):
    return run(RONDO, *arguments)


def trace(folder, name, *arguments):
    path = folder / f"{name}.mcap"
    done = rondo("simulate", *arguments, "--trace", path)
    check(f"{name}: a trace", path.exists(), done.stdout, done.stderr)
    return path


def page(folder, path):
    out = folder / f"{path.stem}.html"
    done = rondo("view", path, "-o", out, "--json")
    check(f"{path.stem}: a page", done.returncode == 0 and json.loads(done.stdout)["page"] == str(out), done.stdout, done.stderr)
    check(f"{path.stem}: not too large", out.stat().st_size <= PAGE, out.stat().st_size)
    again = folder / "again.html"
    rondo("view", path, "-o", again)
    check(f"{path.stem}: the same page again", again.read_bytes() == out.read_bytes())
    return out


def sources(folder):
    """Types, and decoders against the reference reader."""
    place = folder / "viewer"
    shutil.copytree(ROOT / "viewer", place, ignore=shutil.ignore_patterns("node_modules"))
    (place / "node_modules").symlink_to(MODULES)
    done = run(MODULES / ".bin/tsc", "-p", place)
    check("types", done.returncode == 0, done.stdout)
    out = folder / "data.test.mjs"
    done = run(MODULES / ".bin/esbuild", place / "test/data.test.ts", "--bundle", "--platform=node", "--format=esm", f"--outfile={out}", "--log-level=error")
    check("the test of decoders", done.returncode == 0, done.stderr)
    return out


def errors(folder, path):
    done = rondo("view", folder / "nothing.mcap")
    check("no file", done.returncode == 1 and "nothing.mcap" in done.stderr, done.stderr)
    (folder / "text.mcap").write_text("this is none")
    done = rondo("view", folder / "text.mcap")
    check("no trace", done.returncode == 1 and "is no trace" in done.stderr and not (folder / "text.html").exists(), done.stderr)
    done = rondo("view", path, "-o", path)
    check("the trace stays", done.returncode == 1 and path.stat().st_size > 1000, done.stderr)
    done = rondo("view", path, "-o", folder / "no/such/folder.html")
    check("no folder", done.returncode == 1, done.stderr)


def main():
    if not (MODULES / "playwright-core").is_dir():
        print("skipped: the packages of the viewer (./dev setup)")
        return 0
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        bad = ROOT / "tests/e2e/choreographies"
        hostile = folder / "hostile.koord"
        text = (ROOT / "examples/koord/lineform.koord").read_text()
        hostile.write_text(text + "\n# </script><script>alert(1)</script><!-- & \"\n")
        shutil.copy(ROOT / "examples/koord/lineform.toml", folder / "hostile.toml")
        traces = [trace(folder, "handover", ROOT / "examples/choreo/handover.rondo"),
                  trace(folder, "mapping", ROOT / "examples/koord/mapping", "--duration", 30),
                  trace(folder, "lineform", hostile, "--duration", 10),
                  trace(folder, "wrong", next(p for p in sorted(bad.glob("*.rondo")) if p.read_text().startswith("# runs: 1 collision")))]
        pages = [page(folder, t) for t in traces]
        done = run("node", sources(folder), *traces)
        check("decoders", done.returncode == 0 and "decoders agree" in done.stdout, done.stdout, done.stderr)
        pictures = sys.argv[2] if len(sys.argv) > 2 else "-"
        done = run("node", ROOT / "viewer/test/pages.mjs", MODULES, pictures, *pages)
        check("pages", done.returncode == 0 and f"{len(pages)} pages" in done.stdout, done.stdout, done.stderr)
        errors(folder, traces[0])
    return 1 if problems else 0


os.environ.pop("DISPLAY", None)
sys.exit(main())
