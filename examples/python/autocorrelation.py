"""The autocorrelation of self-gravity wakes: how long, how wide and how inclined they are, the mean of many instants.

xi(d) = <sigma(r) sigma(r + d)>/<sigma>^2 - 1, with sigma the surface density. The box is periodic in the sheared
coordinate y + s x/L_x, where s is the shear offset of that instant: there the mean over r is a product of Fourier
transforms. Particles count as points, so xi(0) also holds each particle with itself.
"""

import keeler
import numpy as np
from common import RING, arguments, plt

figure, quick = arguments(__doc__, "autocorrelation.png")
cell = 1.5  # m
d = np.arange(-28, 29) * cell if quick else np.arange(-50, 51) * cell  # up to half of the box
dx, dy = np.meshgrid(d, d, indexing="ij")
maps = []


def correlate(sim):
    if sim.orbits < 1.5:  # no wakes yet
        return
    state = sim.snapshot()
    (length, width), offset = state.box, state.shear_offset
    x, y = state.positions[:, 0], state.positions[:, 1]
    u, v = x / length, (y + offset * x / length) / width  # periodic, period 1
    shape = round(length / cell), round(width / cell)
    mass = np.histogram2d(u % 1.0, v % 1.0, shape, [[0, 1], [0, 1]], weights=state.masses)[0]
    xi = np.fft.ifft2(np.abs(np.fft.fft2(mass / mass.mean() - 1.0)) ** 2).real / mass.size
    i, j = dx / length * shape[0], (dy + offset * dx / length) / width * shape[1]  # separations in cells
    maps.append(xi[np.rint(i).astype(int) % shape[0], np.rint(j).astype(int) % shape[1]])


sim = keeler.Simulation(RING, box={"size": [90.0, 90.0] if quick else [184.0, 184.0]}, particles={"density": 450.0},
                        gravity={"solver": "fft", "kick_every": 2}, time={"step": 2.5e-3})
sim.run(2.0 if quick else 6.0, every=0.25, callback=correlate)
xi = np.mean(maps, axis=0)

# the pitch: the long axis of the middle by its second moments, above 0 when trailing
near = (np.hypot(dx, dy) < 25.0) & (xi > 0.0)
xx, xy, yy = (np.sum((xi * p)[near]) for p in (dx**2, dx * dy, dy**2))
pitch = -0.5 * np.degrees(np.arctan2(2.0 * xy, yy - xx))

plt.grid(False)
colours = plt.pcolormesh(dx, dy, xi, cmap="RdBu_r", vmin=-0.6, vmax=0.6, rasterized=True)
plt.contour(dx, dy, xi, levels=[0.0, 0.5], colors="k", linewidths=[0.5, 1.0])
plt.colorbar(colours, label=r"autocorrelation $\xi$ of the surface density", extend="max")
plt.xlabel(r"$\Delta x$, outward (m)")
plt.ylabel(r"$\Delta y$, along the orbit (m)")
plt.gca().set_aspect("equal")
plt.savefig(figure)
print(f"{len(sim)} particles, {len(maps)} instants: pitch {pitch:.1f} degrees, xi(0) {xi.max():.2f}, "
      f"deepest {xi.min():.2f}; keeler analyze at the end: pitch {sim.analyze()['wake_inner_pitch_degrees']:.1f} degrees")
