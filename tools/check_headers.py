#!/usr/bin/env python3
"""Fails on a header that does not compile alone.

  check_headers.py COMPILER [FLAG...]

A header with a source of its name is the first that the source includes, so building the source compiles it behind
nothing but the precompiled headers. What those provide, each header has to include itself: this is checked by the
names that it uses. A header without a source is compiled alone, without precompiled headers.
"""
import atexit
import functools
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent / "src"

# Names of the precompiled headers, and of what they are likely to bring along.
OWNERS = {
    "algorithm": ["ranges::(?:sort|find|find_if|any_of|all_of|none_of|max|min|copy|equal|reverse|stable_sort|count)",
                  "sort", "find", "max", "min", "clamp", "any_of", "all_of", "none_of", "copy", "fill", "reverse"],
    "array": ["array"],
    "atomic": ["atomic", "atomic_bool"],
    "cmath": ["sqrt", "sin", "cos", "abs", "fabs", "hypot", "isfinite", "isnan", "isinf", "floor", "ceil", "nextafter"],
    "cstdint": ["u?int(?:8|16|32|64)_t"],
    "functional": ["function", "hash", "reference_wrapper"],
    "limits": ["numeric_limits"],
    "map": ["map", "multimap"],
    "memory": ["unique_ptr", "shared_ptr", "weak_ptr", "make_unique", "make_shared"],
    "mutex": ["mutex", "lock_guard", "scoped_lock", "unique_lock"],
    "optional": ["optional", "nullopt"],
    "set": ["set", "multiset"],
    "span": ["span"],
    "string": ["string", "to_string"],
    "string_view": ["string_view"],
    "tuple": ["tuple", "tie"],
    "unordered_map": ["unordered_map"],
    "unordered_set": ["unordered_set"],
    "utility": ["move", "pair", "swap", "exchange", "forward"],
    "variant": ["variant", "monostate", "holds_alternative", "get_if", "visit"],
    "vector": ["vector"],
}
# Headers that are specified to provide what another one has.
ALSO = {"string_view": ["string"], "utility": ["map", "algorithm", "memory"], "cstdint": ["cinttypes"]}


def without_comments(text):
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', "", text, flags=re.S)


def made_of_messages(header):
    """Headers that tools/ros_messages.py makes of src/ros/msg."""
    path = pathlib.PurePosixPath(header)
    return path.parent.name == "ros" and (ROOT / "ros" / "msg" / path.stem).is_dir()


@functools.cache
def included_by(header):
    """The foreign headers that a header of ours includes, itself or by others of ours."""
    if made_of_messages(header):
        return {"array", "string", "vector"} | included_by("ros/cdr.h") | included_by("ros/message.h")
    text = (ROOT / header).read_text(encoding="utf-8")
    found = set(re.findall(r"#include <([^>]+)>", text))
    for other in re.findall(r'#include "([^"]+)"', text):
        found |= included_by(other)
    return found


@functools.cache
def messages():
    """A folder with the headers of messages."""
    folder = tempfile.mkdtemp(prefix="rondo-messages-")
    atexit.register(shutil.rmtree, folder)
    subprocess.run([sys.executable, str(ROOT.parent / "tools/ros_messages.py"), str(ROOT / "ros/msg"), folder], check=True)
    return folder


def missing(name):
    text = (ROOT / name).read_text(encoding="utf-8")
    included = included_by(name)
    code = without_comments(re.sub(r"#include [^\n]*", "", text))
    for header, names in OWNERS.items():
        if header in included or any(other in included for other in ALSO.get(header, [])):
            continue
        prefix = r"(?:std::)?" if header == "cstdint" else "std::"
        used = re.search(rf"\b{prefix}(?:{'|'.join(names)})\b", code)
        if used:
            yield f"uses {used.group(0)} without <{header}>"
    if re.search(r"\bfmt::", code) and not any(name.startswith("fmt/") for name in included):
        yield "uses fmt:: without <fmt/...>"


def main():
    problems = []
    headers = sorted(ROOT.rglob("*.h"))
    for header in headers:
        name = str(header.relative_to(ROOT))
        problems += [f"{name}: {what}" for what in missing(name)]
        source = header.with_suffix(".cc")
        if source.exists():
            first = re.search(r"#include ([<\"][^>\"]+)", source.read_text(encoding="utf-8"))
            if not first or first.group(1)[1:] != name:
                problems.append(f"{source.relative_to(ROOT)}: includes something before {name}")
        else:
            result = subprocess.run(sys.argv[1:] + ["-std=c++20", "-fsyntax-only", "-I", str(ROOT), "-I", messages(), "-x", "c++", "-"],
                                    input=f'#include "{name}"\n', text=True, capture_output=True)
            if result.returncode:
                problems.append(f"{name}: does not compile alone:\n{result.stderr}")
    if len(headers) < 50:
        problems.append(f"only {len(headers)} headers found: is this the right folder?")
    for problem in problems:
        print(problem)
    print(f"{len(headers)} headers, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
