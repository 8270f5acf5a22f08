#!/usr/bin/env python3
"""The viscosity of wakes as a power of r_h, of what `keeler sweep laws.toml -o DIR` wrote.

    fit.py DIR/points.csv            prints factor and power for each law of restitution, as JSON
    fit.py DIR/points.csv --table    prints the viscosities as a table

ν = C r_h^p in G²Σ²/Ω³. log ν = log C + p log r_h is fitted by least squares, weighted by the errors of ν.
"""

import csv
import json
import math
import sys

HILL = {254.8: 0.7, 380.4: 0.8, 456.2: 0.85, 541.6: 0.9}  # r_h of each density, in this planet's A ring


def points(path):
    """(r_h, ν, its error) of each law, by r_h."""
    laws = {"constant": [], "bridges": []}
    with open(path, newline="") as table:
        for row in csv.DictReader(table):
            law = "bridges" if "bridges" in row["collisions.restitution"] else "constant"
            laws[law].append((HILL[float(row["particles.density"])], float(row["total_viscosity_g2_sigma2_omega3"]),
                              float(row["total_viscosity_error_g2_sigma2_omega3"])))
    return {law: sorted(rows) for law, rows in laws.items()}


def power_law(rows):
    weights = [(value / error) ** 2 for _, value, error in rows]
    x = [math.log(hill) for hill, _, _ in rows]
    y = [math.log(value) for _, value, _ in rows]
    total = sum(weights)
    mean_x = sum(w * a for w, a in zip(weights, x)) / total
    mean_y = sum(w * b for w, b in zip(weights, y)) / total
    spread = sum(w * (a - mean_x) ** 2 for w, a in zip(weights, x))
    power = sum(w * (a - mean_x) * (b - mean_y) for w, a, b in zip(weights, x, y)) / spread
    factor = math.exp(mean_y - power * mean_x)
    chi2 = sum(w * (b - mean_y - power * (a - mean_x)) ** 2 for w, a, b in zip(weights, x, y))
    return {"factor": factor, "factor_error": factor * math.sqrt(1 / total + mean_x**2 / spread),
            "power": power, "power_error": 1 / math.sqrt(spread), "chi2": chi2}


laws = points(sys.argv[1])
if "--table" in sys.argv:
    print("| r_h | ε = 0.5 | Bridges | 26 r_h⁵ |\n|---|---|---|---|")
    for (hill, *constant), (_, *bridges) in zip(laws["constant"], laws["bridges"]):
        print(f"| {hill} | {constant[0]:.2f} ± {constant[1]:.2f} | {bridges[0]:.2f} ± {bridges[1]:.2f} | {26 * hill**5:.2f} |")
else:
    print(json.dumps({law: power_law(rows) for law, rows in laws.items()}))
