"""A movie: self-gravity wakes grow out of a smooth ring, every particle at its true size. A GIF, by Pillow.

A file that ends in .png gets the last picture instead.
"""

import keeler
from common import RING, arguments, plt
from matplotlib.animation import FuncAnimation
from matplotlib.collections import EllipseCollection

figure, quick = arguments(__doc__, "movie.gif")
END = 3.0  # orbits
frames = 4 if quick else 60
sim = keeler.Simulation(RING, box={"size": [60.0, 60.0] if quick else [150.0, 150.0]}, particles={"density": 450.0},
                        gravity={"solver": "fft", "kick_every": 2}, time={"step": 2.5e-3, "end": END})
x, y = sim.snapshot().box
canvas, axes = plt.subplots(figsize=(5.4, 5.4))
axes.set(xlim=(-x / 2, x / 2), ylim=(-y / 2, y / 2), aspect="equal", xlabel="outward (m)", ylabel="along the orbit (m)")
axes.set_facecolor("black")
axes.grid(False)
spheres = EllipseCollection(2 * sim.radii, 2 * sim.radii, 0.0, units="x", facecolor="wheat", edgecolor="0.3", lw=0.2,
                            offsets=sim.positions[:, :2], offset_transform=axes.transData)
axes.add_collection(spheres)


def draw(frame):
    sim.run(frame * END / (frames - 1))
    spheres.set_offsets(sim.positions[:, :2])  # the order of particles changes, but all have one size
    axes.set_title(f"{sim.orbits:.2f} orbits")


if figure.suffix == ".png":
    draw(frames - 1)
    plt.savefig(figure)
else:
    FuncAnimation(canvas, draw, frames, init_func=lambda: None).save(figure, writer="pillow", fps=12, dpi=80)
print(f"{len(sim)} particles, {frames} frames: wake contrast {sim.analyze()['wake_contrast']:.2f}")
