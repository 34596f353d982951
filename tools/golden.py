#!/usr/bin/env python3
"""Golden cases: programs that hold their command line and what must be reported about them.

A case is src/<folder>/testdata/<topic>/<case>.koord (or .rondo, or .smt2, where comments begin with `;`). Its first line may be
`# ARGS: prove ...` (default: check, or solve). Below each line of the program stand the diagnostics that concern it, as
comments `#? kind[:column]: message`; those about no place, or about imported files, stand at the end. With `OUTPUT` in the first line, the whole
output for people stands at the end in lines `#> `.
A case whose name starts with `fail_` must end with a status other than 0, any other with 0.

  golden.py RONDO [--update] [CASE...]
"""
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def strip(text):
    """The program without expectations."""
    lines = text.split("\n")
    return [line for line in lines if not re.match(r"\s*[#;][?>]", line)]


def run(rondo, args, path):
    done = subprocess.run([rondo, *args, str(path)], cwd=ROOT, capture_output=True, timeout=300)
    return done.returncode, done.stdout.decode("utf-8", "replace"), done.stderr.decode("utf-8", "replace")


def normalise(text):
    text = re.sub(r"kDigest = 0x\w+", "kDigest = D", text)  # of the file itself
    return re.sub(r"; \d+\.\d x real time", "", re.sub(r" +\d+\.\d\d\d? s", "  T s", text))


def expected(rondo, path, source_lines):
    """(exit status, the text of the case as it should be)."""
    first = source_lines[0] if source_lines else ""
    smt = path.suffix == ".smt2"
    mark = ";" if smt else "#"
    words = first[len("# ARGS:"):].split() if first.startswith(f"{mark} ARGS:") else ["solve" if smt else "check"]
    show = "OUTPUT" in words
    args = [w for w in words if w != "OUTPUT"]
    if args[0] == "prove":
        args.append("--no-cache")
    if args[0] == "reach" and "--timeout" not in args:
        args += ["--timeout", "280"]  # no verdict depends on how fast the machine is
    relative = path.relative_to(ROOT)
    status, out, err = run(rondo, [*args, "--json"], relative)
    try:
        diagnostics = json.loads(out)["diagnostics"]
    except (ValueError, KeyError):
        return status, f"no JSON: status {status}\n{out}\n{err}"
    # Lines of the file on disk, which has the old expectations in it, to lines of the program.
    disk = path.read_text(encoding="utf-8", errors="surrogateescape").split("\n")
    to_source, count = {}, 0
    for number, line in enumerate(disk, 1):
        if not re.match(r"\s*[#;][?>]", line):
            count += 1
        to_source[number] = count
    notes = {}
    for d in diagnostics:
        here = d.get("file") == str(relative)
        line = to_source.get(d["line"], 0) if here else len(source_lines)
        column = f":{d['column']}" if here else f":{pathlib.Path(d['file']).name}" if "file" in d else ""
        notes.setdefault(line, []).append(f"{mark}? {d['kind']}{column}: {d['message']}")
    result = []
    for number, line in enumerate(source_lines, 1):
        result.append(line)
        if number in notes and not (number == len(source_lines) and line == ""):
            result.extend(notes.pop(number))
    tail = [n for line in sorted(notes) for n in notes[line]]
    if result and result[-1] == "":
        result = result[:-1] + tail + [""]
    else:
        result += tail
    if show:
        status, out, err = run(rondo, args, relative)
        body = normalise(out + err).rstrip("\n").split("\n")
        ending = result.pop() if result and result[-1] == "" else None
        result += [f"{mark}> {line}".rstrip() for line in body]
        if ending is not None:
            result.append("")
    return status, "\n".join(result)


def main():
    rondo = str(pathlib.Path(sys.argv[1]).resolve())
    update = "--update" in sys.argv
    wanted = [a for a in sys.argv[2:] if not a.startswith("--")]
    cases = sorted([*ROOT.glob("src/**/testdata/**/*.koord"), *ROOT.glob("src/**/testdata/**/*.smt2"), *ROOT.glob("src/**/testdata/**/*.rondo")])
    if wanted:
        cases = [c for c in cases if any(w in str(c) for w in wanted)]
    failed, kinds = 0, set()
    for case in cases:
        text = case.read_bytes().decode("utf-8", errors="surrogateescape")
        source = strip(text)
        status, want = expected(rondo, case, source)
        if update and want != text:
            # Twice: the expectations move the lines that the output shows.
            for _ in range(3):
                case.write_bytes(want.encode("utf-8", errors="surrogateescape"))
                status, want = expected(rondo, case, source)
            text = case.read_bytes().decode("utf-8", errors="surrogateescape")
            print(f"updated {case.relative_to(ROOT)}")
        kinds.update(re.findall(r"^\s*[#;]\? ([a-z-]+)", text, re.M))
        problems = []
        if want != text:
            problems.append("differs from what is expected:\n" + want)
        if (status != 0) != case.name.startswith("fail_"):
            problems.append(f"ends with status {status}, against its name")
        if status not in (0, 1, 3):
            problems.append(f"ends with status {status}")
        for problem in problems:
            failed += 1
            print(f"{case.relative_to(ROOT)}: {problem}")
    if not wanted:
        listed = subprocess.run([rondo, "explain", "--json"], capture_output=True, check=True).stdout
        # A disagreement of solvers cannot be provoked with honest ones; tests/e2e does it with a dishonest one.
        for kind in json.loads(listed)["kinds"]:
            if kind["kind"] not in kinds and kind["kind"] != "koord-disagreement":
                failed += 1
                print(f"no golden case shows {kind['kind']}")
    print(f"{len(cases)} golden cases, {failed} problems")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
