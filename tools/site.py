#!/usr/bin/env python3
"""The documentation as a site: the pages of docs/, a page for each verb and each diagnostic. Fails on a dead link.

  site.py RONDO OUT       needs Sphinx with myst-parser and furo
  site.py --links         only looks for dead links, and for pages that stand nowhere
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# What the pages are called in the list at the side, in order; every page of docs/ stands in one part.
PARTS = [
    ("Begin", ["tutorial-fleet", "tutorial-warehouse", "tutorial-handover"]),
    ("Use", ["language", "choreographies", "motion", "reach", "simulation", "robots", "build", "viewer", "editors", "json"]),
    ("Understand", ["architecture", "theory", "runtime"]),
    ("Extend", None),  # docs/howto
    ("Decisions", None),  # docs/adr
]
CONFIGURATION = """
project = "Rondo"
html_title = "Rondo"
extensions = ["myst_parser"]
myst_heading_anchors = 4
myst_enable_extensions = ["html_image"]
html_theme = "furo"
html_copy_source = False
html_show_copyright = False
exclude_patterns = []
suppress_warnings = ["misc.highlighting_failure"]
"""


def title(path):
    """The first heading of a page."""
    for line in path.read_text().splitlines():
        if line.startswith("# "):
            return line[2:].strip()
    return path.stem


def contents(caption, entries):
    return "\n".join(["```{toctree}", ":maxdepth: 1", f":caption: {caption}", "", *entries, "```", ""])


def fenced(text, language=""):
    fence = "`" * (3 + max((len(run) for run in re.findall("`+", text)), default=0))
    return f"{fence}{language}\n{text.rstrip()}\n{fence}\n"


def anchor(heading):
    """What GitHub calls a heading, too: links in the pages are written that way."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def links(page, wrong):
    """Links out of docs/ become the names of files; links to a part of a page, and to files, must lead somewhere."""
    # What a listing is for, docs/howto says in the place of its language.
    text = re.sub(r"^```(new|old)\b.*$", "```text", page.read_text(), flags=re.M)

    def follow(found):
        label, target = found.group(1), found.group(2)
        if re.match(r"[a-z]+:", target):
            return found.group(0)
        path, _, part = target.partition("#")
        whole = (page.parent / path).resolve() if path else page
        if not whole.exists():
            wrong.append(f"{page.relative_to(ROOT)}: `{target}` is not there")
            return found.group(0)
        if part and whole.suffix == ".md":
            headings = [anchor(line.lstrip("#").strip()) for line in whole.read_text().splitlines() if line.startswith("#")]
            if part not in headings:
                wrong.append(f"{page.relative_to(ROOT)}: `{target}`: no such heading")
        inside = whole.is_relative_to(ROOT / "docs") and whole.is_file()
        return found.group(0) if inside else f"{label} (`{whole.relative_to(ROOT)}`)"

    return re.sub(r"(?<!!)\[([^\]]*)\]\(([^)\s]+)\)", follow, text)


def verbs(rondo, folder):
    listed = subprocess.run([rondo, "help"], capture_output=True, text=True, check=True).stdout
    names = re.findall(r"^  ([a-z]+) +\S", listed.split("Subcommands:")[1], re.M)
    folder.mkdir()
    for name in names:
        text = subprocess.run([rondo, "help", name], capture_output=True, text=True, check=True).stdout
        (folder / f"{name}.md").write_text(f"# rondo {name}\n\n{fenced(text, 'text')}")
    return names


def diagnostics(rondo, folder):
    folder.mkdir()
    kinds = json.loads(subprocess.run([rondo, "explain", "--json"], capture_output=True, text=True, check=True).stdout)["kinds"]
    for kind in kinds:
        name = kind["kind"]
        said = json.loads(subprocess.run([rondo, "explain", name, "--json"], capture_output=True, text=True, check=True).stdout)
        page = [f"# {name}", "", f"**{said['severity']}**: {said['summary']}", "", said["explanation"], ""]
        if said.get("example"):
            page += [f"What `rondo {said['verb']}` says it of:", "", fenced(said["example"])]
        (folder / f"{name}.md").write_text("\n".join(page))
    return [kind["kind"] for kind in kinds]


def main():
    wrong = []
    pages = {page: links(page, wrong) for page in sorted((ROOT / "docs").rglob("*.md"))}
    for page in [*ROOT.glob("*.md"), *(ROOT / "editors").glob("*.md")]:
        links(page, wrong)
    named = {name for _, names in PARTS for name in names or []}
    wrong += [f"docs/{page.name} stands in no part of the site" for page in sorted((ROOT / "docs").glob("*.md")) if page.stem not in named]
    if wrong or sys.argv[1:] == ["--links"]:
        print("\n".join(wrong) or f"{len(pages)} pages, 0 problems")
        return 1 if wrong else 0
    rondo, out = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    source = out / "source"
    shutil.rmtree(out, ignore_errors=True)
    shutil.copytree(ROOT / "docs", source)
    for page, text in pages.items():
        (source / page.relative_to(ROOT / "docs")).write_text(text)
    index = ["# Rondo", "", "Write coordination code for a team of robots once, prove that the team keeps its promises, explore and simulate it, run it, look at every run.", ""]
    for caption, names in PARTS:
        folder = {"Extend": "howto", "Decisions": "adr"}.get(caption)
        entries = [f"{folder}/{p.stem}" for p in sorted((source / folder).glob("*.md"))] if folder else names
        if folder == "adr":
            listing = "\n".join(f"{title(source / f'{p}.md')} <{p.split('/')[1]}>" for p in entries)
            (source / "adr/index.md").write_text(f"# Decisions\n\n{contents('', listing.splitlines())}".replace(":caption: \n", ""))
            entries = ["adr/index"]
        index.append(contents(caption, entries))
    for folder, heading, names in [("verbs", "Verbs", verbs(rondo, source / "verbs")), ("diagnostics", "Diagnostics", diagnostics(rondo, source / "diagnostics"))]:
        (source / folder / "index.md").write_text(f"# {heading}\n\n{contents('', names)}".replace(":caption: \n", ""))
    index.append(contents("Reference", ["verbs/index", "diagnostics/index"]))
    (source / "index.md").write_text("\n".join(index))
    (source / "conf.py").write_text(CONFIGURATION)
    done = subprocess.run([sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html", str(source), str(out / "html")], check=False)
    print(f"{len(list((out / 'html').rglob('*.html')))} pages in {out / 'html'}")
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
