#!/usr/bin/env python3
"""The lobes of a propeller: the surface density over the mean in boxes 5 r_H long, 1.5 to 2.5 r_H from the moonlet on both sides of it.

    keeler convert SNAPSHOT --to csv -o TABLE
    lobes.py TABLE...      prints the cells of a row, means over the tables: 0 to 30 r_H downstream, and 10 to 30 r_H upstream
"""

import csv
import math
import statistics
import sys

HILL = 15.0  # m, of this moonlet
WIDTH, LENGTH = 150.0, 900.0  # m, of the box
NEAR, FAR, STEP = 1.5 * HILL, 2.5 * HILL, 5 * HILL


def densities(path):
    """Of the boxes along the orbit, -30 to 30 r_H, positive downstream: particles over those of a uniform ring."""
    with open(path, newline="") as table:
        rows = [(float(row["r_m"]), float(row["x_m"]), float(row["y_m"])) for row in csv.DictReader(table)]
    _, moonlet_x, moonlet_y = max(rows)
    counts = [0] * 12
    for _, x, y in rows:
        radial = x - moonlet_x
        if NEAR <= abs(radial) < FAR:
            ahead = math.remainder(y - moonlet_y, LENGTH)  # the inner side overtakes the moonlet, and the outer side falls behind
            downstream = ahead if radial < 0 else -ahead
            counts[min(11, max(0, math.floor(downstream / STEP) + 6))] += 1
    uniform = (len(rows) - 1) / (WIDTH * LENGTH) * 2 * (FAR - NEAR) * STEP
    return [count / uniform for count in counts]


boxes = [statistics.fmean(column) for column in zip(*map(densities, sys.argv[1:]))]
print(" | ".join(f"{value:.2f}" for value in boxes[6:] + [statistics.fmean(boxes[:4])]))
