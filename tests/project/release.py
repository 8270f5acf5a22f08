"""release.py SOURCE_DIR: the files that name Keeler's version or the day of its release agree with CMakeLists.txt; the newest section of
the list of changes is that version's, and examples and pages ask for a version that the package answers to."""

import re
import sys
from pathlib import Path

root = Path(sys.argv[1])


def found(pattern, file):
    match = re.search(pattern, (root / file).read_text(encoding="utf-8"), re.M)
    return match[1] if match else None


version = found(r"^project\(keeler VERSION (\S+)", "CMakeLists.txt")
date = found(r"^set\(KEELER_RELEASE_DATE (\S+)\)", "CMakeLists.txt")
faults = []
for what, expected, there in (
    ("version in CITATION.cff", version, found(r"^version: (\S+)", "CITATION.cff")),
    ("date-released in CITATION.cff", date, found(r"^date-released: (\S+)", "CITATION.cff")),
    ("first section of CHANGELOG.md", f"{version} ({date})", found(r"^## (.*)", "CHANGELOG.md")),
):
    if there != expected:
        faults.append(f"{what}: {there} instead of {expected}")
parts = [int(part) for part in version.split(".")]
for file in ("docs/manual/library.md", "examples/embed/CMakeLists.txt", "examples/embed-force/CMakeLists.txt", "tests/package/consumer/CMakeLists.txt"):
    major, minor = map(int, found(r"find_package\(keeler (\d+\.\d+)", file).split("."))
    if major != parts[0] or minor > parts[1]:
        faults.append(f"{file} asks for {major}.{minor}, which {version} is not")
print("\n".join(faults) or f"{version} of {date}")
sys.exit(1 if faults else 0)
