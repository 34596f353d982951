#!/usr/bin/env python3
"""Writes the page of the viewer as C++, so that `rondo view` has it wherever it is installed. Without a page: an empty one.

  embed_page.py OUTPUT [PAGE]
"""
import pathlib
import sys

DELIMITER = b"RONDO"
PIECE = 12_000  # bytes: compilers have limits for one literal


def main():
    page = pathlib.Path(sys.argv[2]).read_bytes() if len(sys.argv) > 2 else b""
    if b")" + DELIMITER + b'"' in page:
        sys.exit("the page ends the string that it stands in")
    pieces = [page[at:at + PIECE] for at in range(0, len(page), PIECE)] or [b""]
    literals = b"\n".join(b'    R"' + DELIMITER + b"(" + piece + b")" + DELIMITER + b'"' for piece in pieces)
    pathlib.Path(sys.argv[1]).write_bytes(b'#include "runs/view_page.h"\n\nnamespace rondo::runs {\nnamespace {\n\nconstexpr char kPage[] =\n'
                                          + literals + b";\n\n}  // namespace\n\nstd::string_view ViewerPage() { return {kPage, sizeof(kPage) - 1}; }\n\n}  // namespace rondo::runs\n")


if __name__ == "__main__":
    main()
