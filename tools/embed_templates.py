#!/usr/bin/env python3
"""Writes the files of first projects as C++, so that `rondo new` has them wherever it is installed.

  embed_templates.py TEMPLATES OUTPUT
"""
import pathlib
import sys

DELIMITER = "RONDO"


def main():
    folder, output = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    rows = []
    for path in sorted(p for p in folder.rglob("*") if p.is_file()):
        text = path.read_text()
        if f"){DELIMITER}\"" in text:
            sys.exit(f"{path} ends the string that it stands in")
        project, name = path.relative_to(folder).parts
        rows.append(f'    {{"{project}", "{name}", {"true" if path.stat().st_mode & 0o100 else "false"}, R"{DELIMITER}({text}){DELIMITER}"}},\n')
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text('#include "runs/project_templates.h"\n\nnamespace rondo::runs {\nnamespace {\n\nconstexpr TemplateFile kFiles[] = {\n'
                      + "".join(rows) + "};\n\n}  // namespace\n\nstd::span<const TemplateFile> TemplateFiles() { return kFiles; }\n\n}  // namespace rondo::runs\n")


if __name__ == "__main__":
    main()
