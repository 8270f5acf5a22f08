"""A start of one's own: a narrow ringlet in an empty box, given by arrays, spreads by its own collisions.

The variance of a Keplerian ringlet grows by d<x^2>/dt = 6 <nu>, the mean over its mass (the diffusion equation of
Lynden-Bell & Pringle 1974, seen locally). So its growth can be foretold from what viscosity.py measured in patches.
"""

import keeler
import numpy as np
from common import RING, arguments, plt

NU = [0, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0], [0, 0.236, 0.458, 0.691, 0.858, 1.060, 1.241]  # tau, r^2 Omega
figure, quick = arguments(__doc__, "own_start.png")
width, length, tau = 20.0, 60.0 if quick else 300.0, 1.0  # m, of the ringlet of spheres of 1 m
end = 10.0 if quick else 40.0  # orbits
count = round(tau * width * length / np.pi)
corner = np.array([0.5 * width, 0.5 * length, 4.0])
positions = np.random.default_rng(1).uniform(-corner, corner, (count, 3))

# velocities are those of circular orbits, where none are given; relax moves spheres apart that overlap
sim = keeler.from_arrays(RING, positions, radii=1.0, relax=True, box={"size": [300.0, length]})
edges = np.linspace(-100.0, 100.0, 81)
times, variances, growth, shown = [], [], [], [0.0, 0.1 * end, 0.3 * end, end]
_, (left, right) = plt.subplots(1, 2, figsize=(11, 4.5))


def record(sim):
    centres = sim.elements[:, 0]  # guiding centres
    depth = np.histogram(centres, edges)[0] * np.pi / (length * np.diff(edges))
    times.append(sim.orbits)
    variances.append(centres.var())
    growth.append(6.0 * 2.0 * np.pi * np.average(np.interp(depth, *NU), weights=depth + 1e-30))  # m^2 an orbit
    if min(abs(sim.orbits - t) for t in shown) < 1e-6:
        left.stairs(depth, edges, lw=1.4, label=f"{sim.orbits:.0f} orbits")


record(sim)
sim.run(end, every=0.5, callback=record)
growth = np.array(growth)
foretold = variances[0] + np.cumsum(np.append(0.0, 0.5 * np.diff(times) * (growth[1:] + growth[:-1])))

left.set(xlabel="guiding centre $X$, outward (m)", ylabel=r"optical depth $\tau$")
right.plot(times, variances, lw=1.8, label="the ringlet")
right.plot(times, foretold, "k--", lw=1, label=r"by the viscosity of patches, $\nu(\tau)$")
right.set(xlabel="time (orbits)", ylabel=r"variance of $X$ (m$^2$)")
left.legend()
right.legend()
plt.savefig(figure)
ratio = (variances[-1] - variances[0]) / (foretold[-1] - variances[0])
print(f"{count} particles: variance {variances[0]:.0f} m2 to {variances[-1]:.0f} m2, {ratio:.2f} of what is foretold")
