#!/usr/bin/env python3
"""What `cmake --install` makes works without the sources, and `find_package(rondo)` finds it.

  install.py BUILD
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

PROJECT = """cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES NONE)
find_package(rondo {version} REQUIRED)
get_target_property(program rondo::rondo LOCATION)
file(WRITE ${{CMAKE_BINARY_DIR}}/found "${{program}}\n${{rondo_MODELS}}\n${{rondo_EXAMPLES}}\n")
"""


def run(*args, **more):
    done = subprocess.run(args, capture_output=True, text=True, **more)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, args))}: {done.stdout}{done.stderr}")
    return done.stdout


def main():
    with tempfile.TemporaryDirectory() as folder:
        prefix, user = pathlib.Path(folder, "usr"), pathlib.Path(folder, "user")
        run("cmake", "--install", sys.argv[1], "--prefix", prefix)
        version = run(prefix / "bin/rondo", "--version")
        match = re.fullmatch(r"rondo (\d+\.\d+\.\d+)( \(commit [0-9a-f]{10}\+?\))?\n", version)
        if not match:
            sys.exit(f"--version says {version!r}")
        user.mkdir()
        (user / "CMakeLists.txt").write_text(PROJECT.format(version=match.group(1)))
        run("cmake", "-S", user, "-B", user / "build", f"-DCMAKE_PREFIX_PATH={prefix}")
        program, models, examples = (user / "build/found").read_text().split("\n")[:3]
        cache = {**os.environ, "XDG_CACHE_HOME": folder}
        run(program, "check", f"{examples}/koord/lineform.koord", f"{examples}/choreo/handover.rondo", env=cache)
        # The example of an adapter, built by whoever has only what was installed.
        run("cmake", "-S", f"{examples}/adapters", "-B", user / "adapters", f"-DCMAKE_PREFIX_PATH={prefix}")
        run("cmake", "--build", user / "adapters")
        if not (user / "adapters/libbattery.so").is_file():
            sys.exit("no adapter was built")
        # A first project, as its README says, with nothing but what was installed; pages and completion are there.
        path = {**cache, "PATH": f"{prefix}/bin:{os.environ['PATH']}"}
        for template in ("koord", "choreography", "controller"):
            run(program, "new", "--template", template, "Dock", cwd=user)
            run("./check", cwd=user / "Dock", env=path)
            (user / "Dock").rename(user / f"Dock-{template}")
        page = (prefix / "share/man/man1/rondo-prove.1").read_text()
        if not page.startswith(".TH RONDO\\-PROVE 1") or "\\fB\\-\\-helpers\\fR" not in page:
            sys.exit(f"a strange page: {page[:300]}")
        for script in ("bash-completion/completions/rondo", "zsh/site-functions/_rondo", "fish/vendor_completions.d/rondo.fish"):
            if "simulate" not in (prefix / "share" / script).read_text():
                sys.exit(f"no completion in {script}")
        if not any(pathlib.Path(models).glob("**/*.rondo")):
            sys.exit(f"no models in {models}")
    print("installed, found and run")


if __name__ == "__main__":
    main()
