"""Viscosity of a ring without self-gravity against its optical depth, with errors, and its two parts.

Each point is three runs that differ in their seed; the error is that of their mean. A sweep runs them side by side, each
in a process, and leaves all of them in a folder: called again, the script finds them done and only draws.
"""

import keeler
from common import RING, arguments, plt

figure, quick = arguments(__doc__, "viscosity.png")
depths = [0.2, 1.0] if quick else [0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.4, 2.0]
count = 300 if quick else 1500
grid = {
    "scene": RING,
    "seeds": [1, 2, 3],
    "since": 4.0 if quick else 10.0,  # orbits until the dispersion is in balance
    "set": {"time.end": 8.0 if quick else 40.0},
    # a patch that shrinks as the ring gets denser, so that all have as many particles
    "axis": [{"keys": ["particles.optical_depth", "box.size"],
              "values": [[tau, [round((count * 3.1416 / tau) ** 0.5, 1)] * 2] for tau in depths]}],
}
points = keeler.sweep(grid, figure.with_name(figure.stem + ("-runs-quick" if quick else "-runs")))["points"]

tau = [point["particles.optical_depth"] for point in points]
for part, label in [("total", "in all"), ("collisional", "by contacts"), ("translational", "by particles that move")]:
    nu = [point[f"{part}_viscosity_r2_omega"] for point in points]
    error = [point[f"{part}_viscosity_error_r2_omega"] for point in points]
    plt.errorbar(tau, nu, yerr=error, fmt="o-", ms=4, lw=1, label=label)
plt.xlabel(r"optical depth $\tau$")
plt.ylabel(r"viscosity $\nu$ ($r^2\,\Omega$)")
plt.xlim(left=0)
plt.ylim(bottom=0)
plt.legend()
plt.savefig(figure)
for point in points:
    print(f"tau {point['particles.optical_depth']:g}: viscosity {point['total_viscosity_r2_omega']:.3f} "
          f"+- {point['total_viscosity_error_r2_omega']:.3f} r2 Omega")
