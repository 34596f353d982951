#!/usr/bin/env python3
"""The grammars for editors know every word that the languages reserve, and colour every example to its end.

  grammars.py
"""
import json
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
results = [0, 0]


def check(good, why):
    results[0 if good else 1] += 1
    if not good:
        print(why)


def reserved(*sources):
    """The words in the first initialised list of words of each source."""
    words = set()
    for source, name in sources:
        text = (ROOT / "src" / source).read_text()
        body = re.search(name + r"[^{;]*\{(.*?)\};", text, re.S)
        check(body, f"{source} has no {name}")
        words |= set(re.findall(r'"(\w+)"', body.group(1) if body else ""))
    return words


def scope(grammar, word):
    """The scope of a word that stands alone; empty if it is none."""
    for pattern in grammar["patterns"]:
        if "name" in pattern and re.fullmatch(pattern["match"], word):
            return pattern["name"]
    return ""


def coloured(grammar, text):
    """How many characters of a text, blanks aside, have a scope."""
    patterns = [re.compile(p["match"]) for p in grammar["patterns"]]
    count = 0
    for line in text.split("\n"):
        at = 0
        while at < len(line):
            found = [m for m in (p.search(line, at) for p in patterns) if m and m.end() > m.start()]
            if not found:
                break
            first = min(found, key=lambda m: m.start())
            count += first.end() - first.start()
            at = first.end()
    return count


def main():
    statements = set(re.findall(r'RONDO_STATEMENT\(\w+, "\w*", "(\w+)"\)', (ROOT / "src/koord/syntax/statements.def").read_text()))
    check(len(statements) > 5, "statements.def has other lines")
    languages = {
        "koord": (reserved(("koord/syntax/parser.cc", "kWords")) | statements, ["*.koord", "*.spec"]),
        "rondo": (reserved(("choreo/syntax/parser.cc", "kWords"), ("robot/syntax/parser.cc", "kWords"), ("robot/syntax/parser.cc", "kClauses")), ["*.rondo"]),
    }
    for name, (words, files) in languages.items():
        grammar = json.loads((ROOT / f"editors/{name}.tmLanguage.json").read_text())
        for word in sorted(words):
            check(scope(grammar, word), f"{name}: `{word}` has no colour")
        paths = [p for folder in ("examples", "models") for pattern in files for p in (ROOT / folder).rglob(pattern)]
        check(len(paths) > 5, f"{name}: no examples")
        for path in paths:
            text = path.read_text()
            share = coloured(grammar, text) / max(1, len(re.sub(r"\s", "", text)))
            check(share > 0.3, f"{path.name}: only {share:.0%} is coloured")
    print(f"{results[0]} passed, {results[1]} failed")
    return 1 if results[1] else 0


if __name__ == "__main__":
    sys.exit(main())
