"""A fault is a row of the table: many trials of one kind, two at a time, and what became of them."""

import random
import shutil
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Callable

from program import Broken

SEED = 21
VERDICTS = ("lost", "wrong", "crashes", "hangs")


class Skipped(Exception):
    """The row cannot be tried here; says why."""


@dataclass
class Fault:
    """`prepare(scenes, folder)` makes what the trials share; `trial(shared, draw, folder, number)` is one of them, with
    random numbers and an empty folder of its own. It throws Broken, and returns how many faults it tried (none: one)."""

    name: str   # of --only
    title: str
    how: str    # for the page
    full: int   # trials
    quick: int
    trial: Callable
    prepare: Callable = lambda scenes, folder: scenes


@dataclass
class Row:
    fault: Fault
    tried: int = 0
    counts: dict[str, int] = field(default_factory=lambda: dict.fromkeys(VERDICTS, 0))
    skipped: str = ""
    seconds: float = 0.0

    def failures(self):
        return sum(self.counts.values())

    def cells(self):
        tried = self.skipped or f"{self.tried:,}"
        return [self.fault.title, self.fault.how, tried] + [str(self.counts[verdict]) for verdict in VERDICTS]


def _one(fault, shared: Any, folder: Path, number):
    draw = random.Random(f"{SEED} {fault.name} {number}")
    here = folder / str(number)
    here.mkdir()
    try:
        return fault.trial(shared, draw, here, number) or 1, None
    except Broken as broken:
        return 1, broken
    except (OSError, ValueError, KeyError) as unreadable:  # a result that cannot be looked at
        return 1, Broken("wrong", repr(unreadable))
    finally:
        shutil.rmtree(here, ignore_errors=True)


def measure(fault, scenes, folder, quick):
    """Tries the fault as often as it says."""
    row = Row(fault)
    began = time.monotonic()
    (folder / "shared").mkdir(parents=True)
    try:
        shared = fault.prepare(scenes, folder / "shared")
    except Skipped as reason:
        row.skipped = f"skipped: {reason}"
        print(f"{fault.name}: {row.skipped}", flush=True)
        return row
    with ThreadPoolExecutor(2) as pool:
        trials = range(fault.quick if quick else fault.full)
        for tried, broken in pool.map(lambda number: _one(fault, shared, folder, number), trials):
            row.tried += tried
            if broken:
                row.counts[broken.verdict] += 1
                if row.failures() <= 5:
                    print(f"  {fault.name}: {broken}", flush=True)
    row.seconds = time.monotonic() - began
    counts = ", ".join(f"{count} {verdict}" for verdict, count in row.counts.items())
    print(f"{fault.name}: {row.tried} tried, {counts} ({row.seconds:.0f} s)", flush=True)
    shutil.rmtree(folder, ignore_errors=True)
    return row
