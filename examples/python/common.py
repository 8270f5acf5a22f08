"""What the examples share: SCRIPT.py [FIGURE] [--quick], the ring that most of them look at, and the look of figures.

FIGURE is the file to write; without it, one named after the script in the current folder. --quick makes runs short and
patches small, for tests and for a first try: seconds instead of half a minute, and numbers that are rough.
"""

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # files alone: no display is needed
import matplotlib.pyplot as plt

plt.rcParams.update({"font.size": 12, "axes.grid": True, "grid.alpha": 0.25, "figure.constrained_layout.use": True,
                     "savefig.dpi": 140, "legend.frameon": False, "errorbar.capsize": 3})

# Equal spheres of ice in Saturn's A ring, in a small patch without self-gravity. Scripts change what they are about.
RING = {
    "planet": {"preset": "saturn-a-ring"},
    "box": {"size": [100.0, 100.0]},  # m
    "particles": {"optical_depth": 0.5, "density": 900.0, "sizes": {"law": "equal", "radius": 1.0}},
    "collisions": {"restitution": {"law": "constant", "value": 0.5}},
    "time": {"step": 2e-3, "end": 40.0},  # orbits
}


def arguments(about, figure):
    """(path of the figure, whether to be quick) from the command line."""
    parser = argparse.ArgumentParser(description=about.splitlines()[0])
    parser.add_argument("figure", nargs="?", type=Path, default=figure, help="the file to write (default: %(default)s)")
    parser.add_argument("--quick", action="store_true", help="small and rough: seconds")
    given = parser.parse_args()
    return given.figure, given.quick
