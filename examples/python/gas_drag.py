"""Gas drag with a head wind: terminal velocities of single particles, and a cloud of pebbles that collapses.

Left: radial and azimuthal velocity of particles by their Stokes number St = Omega tau, with a force of one's own in
Python, against v_x = -2 w St/(1 + St^2), v_y = -w/(1 + St^2) (Nakagawa, Sekiya & Hayashi 1986, Icarus 67, 375, particles
of no mass; w = eta v_K is the head wind). Right: a cloud of pebbles under its own gravity, in the gas of [gas]. Drag
slows its fall to the terminal velocity, -tau G M(r)/r^2, so a uniform sphere shrinks uniformly, R^3 = R_0^3 - 3 tau G M t,
until its pebbles touch.
"""

import warnings

import keeler
import numpy as np
from common import arguments, plt

figure, quick = arguments(__doc__, "gas_drag.png")
G, OMEGA, WIND = 6.67430e-11, 2e-7, 30.0  # SI: at 1 au; eta v_K in m/s
fig, (left, right) = plt.subplots(1, 2, figsize=(11, 4.5))


def epstein(kick, accelerations):
    """Drag with a stopping time in proportion to the radius: the kick is the exact solution of dc/dt = (u - c)/tau."""
    c, tau = kick.velocities_beyond_shear, kick.keys["stopping_time"] * kick.radii
    rate = -np.expm1(-kick.interval / tau) / kick.interval
    accelerations[:] = -rate[:, None] * (c + [0.0, kick.keys["head_wind"], 0.0])


keeler.add_force("epstein", epstein, {
    "stopping_time": keeler.Key(None, "s/m", "stopping time over radius", low=0.0),
    "head_wind": keeler.Key(0.0, "m/s", "by how much the gas is slower than the particles' orbit")})

# --- single particles
stokes = np.logspace(-1.5, 0.5 if quick else 1.0, 7 if quick else 21)
count = len(stokes)
scene = {"planet": {"orbital_frequency": OMEGA}, "box": {"size": [1e6, 1e6]},
         "particles": {"density": 1000.0, "sizes": {"law": "equal", "radius": 1.0}},
         "epstein": {"stopping_time": 1.0 / OMEGA, "head_wind": WIND}, "time": {"step": 5e-4, "end": 100.0}}
places = np.stack([np.zeros(count), np.linspace(-4e5, 4e5, count), np.zeros(count)], axis=1)
exact = np.stack([-2.0 * WIND * stokes / (1.0 + stokes**2), -WIND / (1.0 + stokes**2)], axis=1)
with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # of a start unlike any ring
    sim = keeler.from_arrays(scene, places, radii=stokes)  # on circular orbits
sim.run(10.0 if quick else 30.0)
shear = np.array([0.0, 1.5 * OMEGA, 0.0])
found = (sim.by_id(sim.velocities) + sim.by_id(sim.positions)[:, [0]] * shear)[:, :2]
error = np.abs(found / exact - 1.0)
print(f"terminal velocities of St {stokes[0]:.2g} to {stokes[-1]:.3g}: largest relative error {error.max():.5f}")

smooth = np.logspace(-1.6, 1.1, 200)
left.loglog(smooth, 2.0 * smooth / (1.0 + smooth**2), "C0", lw=1, label=r"$2\,St/(1+St^2)$")
left.loglog(smooth, 1.0 / (1.0 + smooth**2), "C1", lw=1, label=r"$1/(1+St^2)$")
left.loglog(stokes, -found[:, 0] / WIND, "C0o", ms=4, label=r"$-v_x/\eta v_K$")
left.loglog(stokes, -found[:, 1] / WIND, "C1s", ms=4, label=r"$-v_y/\eta v_K$")
left.set(xlabel="Stokes number", ylabel=r"velocity over the head wind $\eta v_K$", ylim=(5e-3, 2.0))
left.legend()

# --- a cloud of pebbles
across = 5.2 if quick else 8.8  # lattice spacings in the cloud's diameter
lattice = np.stack(np.meshgrid(*3 * [np.arange(-5, 6) + 0.5], indexing="ij"), axis=-1).reshape(-1, 3)
lattice = lattice[np.linalg.norm(lattice, axis=1) < 0.5 * across]
pebbles, radius = len(lattice), 5e4  # m
inside = lattice * radius / np.cbrt(pebbles / (4.0 / 3.0 * np.pi))
inside_rate = 10.0 * np.sqrt(3.0) * OMEGA  # sqrt(G M/R^3), rad/s: the Hill radius is 4.6 R
mass, tau = inside_rate**2 * radius**3 / G, 0.08 / inside_rate  # kg, s
collapse = 1.0 / (3.0 * tau * inside_rate**2)  # t_c, s
orbit = 2.0 * np.pi / OMEGA
size = 0.2 * radius * pebbles ** (-1.0 / 3.0)  # they touch at 0.25 R_0
cloud = {"planet": {"orbital_frequency": OMEGA}, "box": {"size": [12.0 * radius, 12.0 * radius]},
         "particles": {"density": mass / pebbles / (4.0 / 3.0 * np.pi * size**3),
                       "sizes": {"law": "equal", "radius": size}},
         "collisions": {"restitution": {"law": "constant", "value": 0.1}},
         "gravity": {"solver": "tree"}, "gas": {"stopping_time": tau / orbit, "head_wind": WIND},
         "time": {"step": collapse / orbit / 400.0, "end": 1.05 * collapse / orbit}}
st = OMEGA * tau
drift = np.array([-2.0 * WIND * st / (1.0 + st**2), -WIND / (1.0 + st**2), 0.0])
fall = -inside * (tau * inside_rate**2)
velocities = drift - inside[:, [0]] * shear + fall
with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    sim = keeler.from_arrays(cloud, inside, radii=size, velocities=velocities, relax=True)
times, radii, bound = [], [], []


def nearest(sim, apart):
    """The nearest images, in the box that shears."""
    side, boxes = sim.box[0], np.round(apart[:, 0] / sim.box[0])
    y = apart[:, 1] + boxes * sim.shear_offset
    return np.stack([apart[:, 0] - boxes * side, y - side * np.round(y / side), apart[:, 2]], axis=1)


def watch(sim):
    apart, v = nearest(sim, sim.positions - sim.positions[0]), sim.velocities + sim.positions[:, [0]] * shear
    apart -= apart.mean(axis=0)
    r = np.linalg.norm(apart, axis=1)
    order = np.argsort(r)
    inner = np.empty(len(r))
    inner[order] = mass * np.arange(len(r)) / len(r)
    energy = 0.5 * np.sum((v - v.mean(axis=0)) ** 2, axis=1) - G * inner / r
    times.append(sim.orbits * orbit / collapse)
    radii.append(np.sqrt(5.0 / 3.0 * np.mean(r**2)))
    bound.append(np.mean(energy < 0.0))


watch(sim)
sim.run(every=collapse / orbit / 20.0, callback=watch)
times, radii = np.array(times), np.array(radii) / radii[0]
rate = (1.0 - np.interp(0.25, times, radii) ** 3) / 0.25
print(f"cloud of {pebbles} pebbles: R^3 falls at {rate:.3f} of 3 tau G M, bound at the end {bound[-1]:.2f}, "
      f"radius {radii[-1]:.2f} R_0")
smooth = np.linspace(0.0, 1.0, 300)
right.plot(smooth, np.cbrt(1.0 - smooth), "C0", lw=1, label=r"$R/R_0 = (1 - t/t_c)^{1/3}$")
right.plot(times, radii, "C0o", ms=4, label="radius of the cloud")
right.plot(times, bound, "C2-", label="bound fraction")
right.set(xlabel=r"time over $t_c = R_0^3/(3 \tau G M)$", ylim=(0.0, 1.05))
right.legend()
plt.savefig(figure)
