"""faults PROGRAM LIBRARY [--ranks PROGRAM] [--quick] [--only NAME]... [--write FILE]: harms Keeler's runs and files from outside, prints a
line a fault, and writes the page, where rows that were not measured stay. Exit code 1 when anything was lost or wrong,
crashed or hung."""

import argparse
import os
import sys
import tempfile
from pathlib import Path

import damage
import disks
import folders
import kills
import outputs
import page
import ranks
from program import Program
from rows import measure
from scenes import Scenes

FAULTS = kills.FAULTS + disks.FAULTS + folders.FAULTS + outputs.FAULTS + damage.FAULTS
NAMES = [fault.name for fault in FAULTS + ranks.faults(None)]


def read_options():
    parser = argparse.ArgumentParser(prog="faults", description=__doc__)
    parser.add_argument("program")
    parser.add_argument("library", help="of failing calls")
    parser.add_argument("--ranks", metavar="PROGRAM", help="built with MPI; without it faults of ranks are left out")
    parser.add_argument("--quick", action="store_true", help="a few trials of each")
    parser.add_argument("--only", metavar="NAME", action="append", choices=NAMES)
    parser.add_argument("--write", metavar="FILE")
    return parser.parse_args()


def main():
    options = read_options()
    os.nice(5)
    program = Program(os.path.abspath(options.program), os.path.abspath(options.library))
    of_ranks = ranks.faults(options.ranks and os.path.abspath(options.ranks))
    rows = []
    with tempfile.TemporaryDirectory() as work:
        scenes = Scenes(program, work)
        for fault in FAULTS + (of_ranks if options.ranks else []):
            if not options.only or fault.name in options.only:
                rows.append(measure(fault, scenes, Path(work) / fault.name, options.quick))
    cells = [row.cells() for row in rows]
    print(page.table(cells))
    if options.write:
        file = Path(options.write)
        titles = [fault.title for fault in FAULTS + of_ranks]
        file.write_text(page.written(titles, cells, file.read_text() if file.exists() else ""))
    failures = sum(row.failures() for row in rows)
    print(f"{sum(row.tried for row in rows)} tried, {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
