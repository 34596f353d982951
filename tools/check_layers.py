#!/usr/bin/env python3
"""Fails on an include that the layer graph does not allow and on a cycle in the graph.

  check_layers.py LAYERS.TXT   (written by CMake: one line `component:dep,dep` for each rondo_component)
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent / "src"


def main():
    graph = {}
    for line in open(sys.argv[1], encoding="utf-8"):
        component, _, deps = line.strip().partition(":")
        if component:
            graph[component] = [d for d in deps.split(",") if d]
    problems = []

    done, active = set(), []

    def visit(component):
        if component in active:
            problems.append("cycle: " + " -> ".join(active[active.index(component):] + [component]))
            return
        if component in done:
            return
        active.append(component)
        for dep in graph.get(component, []):
            if dep not in graph:
                problems.append(f"{component} depends on {dep}, which does not exist")
            visit(dep)
        active.pop()
        done.add(component)

    for component in graph:
        visit(component)

    seen = 0
    for path in sorted(ROOT.rglob("*")):
        if path.suffix not in (".h", ".cc"):
            continue
        component = str(path.parent.relative_to(ROOT))
        if component not in graph:
            problems.append(f"{path.relative_to(ROOT)}: no component owns this folder")
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            include = re.match(r'\s*#include "([^"]+)"', line)
            if not include:
                continue
            seen += 1
            target = str(pathlib.PurePosixPath(include.group(1)).parent)
            if not (ROOT / include.group(1)).exists():
                problems.append(f"{path.relative_to(ROOT)}:{number}: no file {include.group(1)}")
            elif target != component and target not in graph[component]:
                problems.append(f"{path.relative_to(ROOT)}:{number}: {component} may not include {include.group(1)}")
    if seen < 50:
        problems.append(f"only {seen} includes found: is this the right folder?")
    for problem in problems:
        print(problem)
    print(f"{len(graph)} components, {seen} includes, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
