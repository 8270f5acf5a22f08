#!/usr/bin/env python3
"""headers.py SOURCE_DIR: include/keeler/keeler.hpp includes every other header of include/keeler, once; the table of
docs/manual/library.md lists the same headers under the same subjects, with the folder of each as its component."""

import re
import sys
from pathlib import Path

SUBJECT_OR_INCLUDE = r"// (.*)|#include <keeler/(.*)>"
SUBJECT_OR_ROW = r"\| \*\*(.*)\*\* \| \| \||\| `(\S+\.hpp)` \| `(.*?)` \|"


def by_subject(text, pattern):
    """Returns (subject, header, what follows) for each header, in order."""
    subject, headers = None, []
    for name, *header in re.findall(rf"(?m)^(?:{pattern})", text):
        if name:
            subject = name
        else:
            headers.append((subject, *header))
    return headers


def main():
    root = Path(sys.argv[1])
    folder = root / "include/keeler"
    umbrella = folder / "keeler.hpp"
    there = sorted(str(path.relative_to(folder)) for path in folder.rglob("*.hpp") if path != umbrella)
    included = by_subject(umbrella.read_text(encoding="utf-8").split("#pragma once")[1], SUBJECT_OR_INCLUDE)
    table = by_subject((root / "docs/manual/library.md").read_text(encoding="utf-8"), SUBJECT_OR_ROW)
    faults = []
    if sorted(header for _, header in included) != there:
        faults.append(f"keeler.hpp does not include each header of include/keeler once: {sorted(set(there) ^ {h for _, h in included})}")
    if [row[:2] for row in table] != included:
        faults.append(f"the table of library.md is not what keeler.hpp includes: {sorted({row[:2] for row in table} ^ set(included))}")
    faults += [f"library.md: {header} is not of component {component}" for _, header, component in table
               if header.split("/")[0] != component]
    print("\n".join(faults) or f"{len(there)} headers")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
