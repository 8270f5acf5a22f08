#!/usr/bin/env python3
"""The viscosity of wakes and its factor C(r_h), ν = C r_h⁵ G²Σ²/Ω³, of what `keeler sweep laws.toml -o DIR` wrote.

    factor.py DIR/points.csv            prints a table
    factor.py DIR/points.csv --json     prints the mean of C over r_h and its scatter, for each law of restitution
"""

import csv
import json
import statistics
import sys

HILL = {254.8: 0.7, 380.4: 0.8, 456.2: 0.85, 541.6: 0.9}  # r_h of each density, in this planet's A ring

laws = {"constant": {}, "bridges": {}}  # of r_h: ν and its error
with open(sys.argv[1], newline="") as table:
    for row in csv.DictReader(table):
        law = laws["bridges" if "bridges" in row["collisions.restitution"] else "constant"]
        names = ("total_viscosity_g2_sigma2_omega3", "total_viscosity_error_g2_sigma2_omega3")
        if not all(row[name] for name in names):
            sys.exit(f"{sys.argv[1]}: {names[0]} is missing at a density of {row['particles.density']}")
        law[HILL[float(row["particles.density"])]] = tuple(float(row[name]) for name in names)

if "--json" in sys.argv:
    factors = {law: [viscosity / hill**5 for hill, (viscosity, _) in rows.items()] for law, rows in laws.items()}
    print(json.dumps({law: {"mean": statistics.mean(each), "scatter": statistics.stdev(each)}
                      for law, each in factors.items()}))
else:
    print("| r_h | 26 r_h⁵ | ν, ε = 0.5 | C | ν, Bridges | C |\n|---|---|---|---|---|---|")
    for hill in sorted(HILL.values()):
        cells = [f"{hill}", f"{26 * hill**5:.2f}"]
        for viscosity, error in (laws["constant"][hill], laws["bridges"][hill]):
            cells += [f"{viscosity:.2f} ± {error:.2f}", f"{viscosity / hill**5:.1f} ± {error / hill**5:.1f}"]
        print("| " + " | ".join(cells) + " |")
