"""A moonlet in a ring: the surface density around it, the mean of many instants, with its gaps and wakes.

The moonlet's mass opens a gap ahead of it on the inner side and behind it on the outer side, the two lobes of a
propeller; beside them run the wakes of what has just passed it. Lengths are in its Hill radius.
"""

import keeler
import numpy as np
from common import RING, arguments, plt

figure, quick = arguments(__doc__, "moonlet.png")
radius, material = 20.0, 200.0  # m, kg/m^3: as large as its Hill radius nearly, so that little falls on it
size = [300.0, 700.0] if quick else [440.0, 1500.0]  # m
scene = {**RING, "box": {"size": size}, "moonlet": [{"radius": radius, "density": material}],
         "particles": {"optical_depth": 0.1, "density": 100.0, "velocity_dispersion": 1.0,
                       "sizes": {"law": "equal", "radius": 1.5}},
         "gravity": {"solver": "tree", "opening_angle": 0.8, "kick_every": 2},
         "time": {"step": 2.5e-3, "end": 1.5 if quick else 5.0}}
sim = keeler.Simulation(scene)
moonlet = len(sim) - 1  # moonlets have the last ids
mass = 4.0 / 3.0 * np.pi * radius**3 * material
hill = (6.674e-11 * mass / (3.0 * sim.orbital_frequency**2)) ** (1.0 / 3.0)  # m
edges = [np.linspace(-0.48, 0.48, round(side / (0.25 * hill)) + 1) * side / hill for side in size]
counts = []


def count(sim):
    if sim.orbits < 0.4 * scene["time"]["end"]:
        return
    places = sim.by_id(sim.positions)[:, :2]
    apart = places[:moonlet] - places[moonlet]
    apart[:, 1] = (apart[:, 1] + 0.5 * size[1]) % size[1] - 0.5 * size[1]  # the nearest image along the orbit
    counts.append(np.histogram2d(*(apart / hill).T, edges)[0])


sim.run(every=0.05, callback=count)
density = np.mean(counts, axis=0)
density /= density.mean()

axes = plt.figure(figsize=(11, 3.5)).gca()
axes.grid(False)
colours = axes.pcolormesh(edges[1], edges[0], density, cmap="magma", vmin=0.0, vmax=2.0, rasterized=True)
axes.add_patch(plt.Circle((0.0, 0.0), radius / hill, color="0.8"))
axes.set(xlabel=r"along the orbit ($R_\mathrm{Hill}$)", ylabel=r"outward ($R_\mathrm{Hill}$)", aspect="equal")
plt.colorbar(colours, shrink=0.75, label=r"surface density $\Sigma/\langle\Sigma\rangle$")
plt.savefig(figure)
x, y = (0.5 * (edge[1:] + edge[:-1]) for edge in edges)
lobe = np.ix_((1.2 < x) & (x < 2.4), (-14.0 < y) & (y < -7.0))
print(f"Hill radius {hill:.1f} m; in the outer gap, behind the moonlet, "
      f"the density is {density[lobe].mean():.2f} of the mean")
