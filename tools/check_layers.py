#!/usr/bin/env python3
"""Fails on an include that the layer graph does not allow, on an edge of the graph that no include needs, on a cycle,
on a header whose namespace does not begin the path of its folder, and on an include with which a core could see the
world: cores own no thread, clock, socket, file, random source or unordered container (docs/runtime.md).

  check_layers.py LAYERS.TXT   (written by CMake: one line `component:dep,dep:test_dep` for each rondo_component)
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent / "src"
CORES = ("runtime/codec", "runtime/rounds")
# What cores may use of the standard library and of others.
DETERMINISTIC = {"algorithm", "array", "bit", "compare", "cstddef", "cstdint", "cstring", "map", "optional", "set", "span", "string",
                 "string_view", "tuple", "utility", "variant", "vector", "xxhash.h"}


def read_graph(path):
    """{component: (dependencies, those of its tests)}"""
    graph = {}
    for line in open(path, encoding="utf-8"):
        component, deps, test_deps = line.strip().split(":")
        graph[component] = tuple([d for d in names.split(",") if d] for names in (deps, test_deps))
    return graph


def cycles(graph):
    done, active = set(), []

    def visit(component):
        if component in active:
            yield "cycle: " + " -> ".join(active[active.index(component):] + [component])
            return
        if component in done:
            return
        active.append(component)
        for dep in graph[component][0] if component in graph else []:
            if dep not in graph:
                yield f"{component} depends on {dep}, which does not exist"
            yield from visit(dep)
        active.pop()
        done.add(component)

    for component in graph:
        yield from visit(component)


def namespace_problem(path, component):
    """A namespace is the path of its folder or of a folder around it: `rondo::koord` in `koord/check`. Below it, there
    may be more."""
    for name in re.findall(r"^namespace (rondo(?:::\w+)+) \{", path.read_text(encoding="utf-8"), re.MULTILINE):
        parts = name.split("::")[1:]
        folders = component.split("/")
        if parts[:len(folders)] != folders[:len(parts)]:
            return f"{path.relative_to(ROOT)}: namespace {name} does not begin the path {component}"
    return None


def main():
    graph = read_graph(sys.argv[1])
    problems = list(cycles(graph))
    used = {component: (set(), set()) for component in graph}
    seen = 0
    for path in sorted(ROOT.rglob("*")):
        if path.suffix not in (".h", ".cc"):
            continue
        component = str(path.parent.relative_to(ROOT))
        if component not in graph:
            problems.append(f"{path.relative_to(ROOT)}: no component owns this folder")
            continue
        if path.suffix == ".h":
            problem = namespace_problem(path, component)
            if problem:
                problems.append(problem)
        is_test = path.stem.endswith("_test")
        allowed = graph[component][0] + (graph[component][1] if is_test else [])
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            outside = re.match(r"\s*#include <([^>]+)>", line)
            if outside and component in CORES and not is_test and outside.group(1) not in DETERMINISTIC:
                problems.append(f"{path.relative_to(ROOT)}:{number}: a core uses <{outside.group(1)}>")
            include = re.match(r'\s*#include "([^"]+)"', line)
            if not include:
                continue
            seen += 1
            target = str(pathlib.PurePosixPath(include.group(1)).parent)
            used[component][is_test].add(target)
            # Headers of messages are made of their definitions.
            made = ROOT / "ros" / "msg" / pathlib.PurePosixPath(include.group(1)).stem
            if not (ROOT / include.group(1)).exists() and not (target == "ros" and made.is_dir()):
                problems.append(f"{path.relative_to(ROOT)}:{number}: no file {include.group(1)}")
            elif target != component and target not in allowed:
                problems.append(f"{path.relative_to(ROOT)}:{number}: {component} may not include {include.group(1)}")
    for component, (deps, test_deps) in graph.items():
        for kind, names in enumerate((deps, test_deps)):
            for name in names:
                if name not in used[component][kind]:
                    problems.append(f"{component}: no include needs {'TEST_DEPS' if kind else 'DEPS'} {name}")
    if seen < 50:
        problems.append(f"only {seen} includes found: is this the right folder?")
    for problem in problems:
        print(problem)
    print(f"{len(graph)} components, {seen} includes, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
