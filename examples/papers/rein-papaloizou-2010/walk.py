#!/usr/bin/env python3
"""How far a moonlet's orbit wanders: the rms change of its guiding centre over a time, by the moonlets.csv of a run.

    walk.py RUN            prints a table for times of 0.25 to 8 orbits
    walk.py RUN --one      prints the change over one orbit, m
"""

import csv
import math
import sys

SETTLED = 2.0  # orbits, left out
LENGTHS = (0.25, 0.5, 1, 2, 3, 4, 6, 8)  # orbits

with open(sys.argv[1] + "/moonlets.csv", newline="") as table:
    rows = [(float(row["time_orbits"]), float(row["guiding_x_m"])) for row in csv.DictReader(table)]
places = [x for orbit, x in rows if orbit >= SETTLED - 1e-9]
spacing = rows[1][0] - rows[0][0]


def change(orbits):
    """The rms change over a time, of all pairs of rows so far apart."""
    ahead = round(orbits / spacing)
    return math.sqrt(sum((b - a) ** 2 for a, b in zip(places, places[ahead:])) / (len(places) - ahead))


if "--one" in sys.argv:
    print(f"{change(1):.2f}")
else:
    changes = [change(length) for length in LENGTHS]
    print("| over orbits | " + " | ".join(f"{length:g}" for length in LENGTHS) + " |\n|---" + "|---" * len(LENGTHS) + "|")
    print("| m | " + " | ".join(f"{m:.2f}" for m in changes) + " |")
    print("| m in 100 orbits, if steps are independent | " +
          " | ".join(f"{m * math.sqrt(100 / length):.1f}" for m, length in zip(changes, LENGTHS)) + " |")
