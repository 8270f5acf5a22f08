"""Radiation pressure on small grains: a compiled force of one's own, which keeps its direction among the stars.

In Hill's frame a push F of fixed direction turns backwards once an orbit, F (cos t, -sin t) with Omega = 1. Hill's equations
with it have an exact solution. With w = e exp(-i phi) the epicycle obeys

    dw/dt = -i kappa w + (2/kappa^2) a_y - (i/kappa) a_x,

so a grain on a circular orbit gets e(t) = |A (exp(i t) - exp(-i kappa t)) + B (exp(-i t) - exp(-i kappa t))| with
A = F (2 - kappa)/(2 kappa^2 (1 + kappa)) and B = F (2 + kappa)/(2 kappa^2 (1 - kappa)). Without precession, kappa = 1, e grows
as 3/2 F t; the planet's oblateness turns the ellipse away, and e comes and goes with the period 2 pi/(Omega - kappa).
"""

import ctypes
import subprocess
import tempfile
from pathlib import Path

import keeler
import numpy as np
from common import arguments, plt

figure, quick = arguments(__doc__, "radiation.png")
orbits = 30.0 if quick else 120.0
SOURCE = """
#include <math.h>
#include <stdint.h>

void radiation(int64_t count, const double *positions, const double *velocities, const double *beyond_shear,
               const double *masses, const double *radii, const uint64_t *ids, const double *kick, const double *keys,
               double *accelerations) {
  double orbits = kick[0], angle = 6.283185307179586 * (orbits - floor(orbits));
  for (int64_t k = 0; k < count; ++k) {
    double push = keys[0] / radii[k]; /* m/s^2: as 1/radius for grains of one material */
    accelerations[3 * k] = push * cos(angle);
    accelerations[3 * k + 1] = -push * sin(angle);
  }
}
"""
with tempfile.TemporaryDirectory() as folder:
    source, library = Path(folder, "radiation.c"), Path(folder, "radiation.so")
    source.write_text(SOURCE)
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", library, source, "-lm"], check=True)
    radiation = ctypes.CDLL(str(library)).radiation
keeler.add_force("radiation", radiation, {"strength": keeler.Key(None, "m^2/s^2", "acceleration of a grain times its radius")})

radii = np.array([2e-5, 3e-5, 5e-5])  # m
omega, flux = 2.4e-4, 15.0  # rad/s; W/m^2, of the Sun at Saturn
strength = 0.75 * flux / 299792458.0 / 900.0  # acceleration 3 S/(4 c rho r) of a grain that absorbs
figure_axes = plt.figure(figsize=(7.5, 4.5)).gca()
worst = 0.0
for kappa, style in ((1.0, "--"), (0.99, "-")):
    scene = {"planet": {"orbital_frequency": omega, "epicyclic_ratio": kappa}, "box": {"size": [4e3, 4e3]},
             "particles": {"density": 900.0, "sizes": {"law": "equal", "radius": radii[0]}},
             "radiation": {"strength": strength}, "time": {"step": 5e-3, "end": orbits}}
    places = [[0.0, y, 0.0] for y in (-1e3, 0.0, 1e3)]
    sim = keeler.from_arrays(scene, places, radii)
    found = []
    sim.run(every=0.5, callback=lambda sim: found.append([sim.orbits, *np.hypot(*sim.by_id(sim.elements)[:, 2:4].T)]))
    found = np.array(found)
    push, t = strength / radii / omega**2, 2.0 * np.pi * found[:, :1]
    against = 0.5 * push / kappa**2 * (2.0 - kappa) / (1.0 + kappa) * (np.exp(1j * t) - np.exp(-1j * kappa * t))
    if kappa == 1.0:
        along = -1.5j * push * t * np.exp(-1j * t)
    else:
        along = 0.5 * push / kappa**2 * (2.0 + kappa) / (1.0 - kappa) * (np.exp(-1j * t) - np.exp(-1j * kappa * t))
    exact = np.abs(against + along)
    worst = max(worst, (np.abs(found[:, 1:] - exact).max(axis=0) / exact.max(axis=0)).max())
    for k, radius in enumerate(radii):
        label = rf"$\kappa = {kappa:g}\,\Omega$" if k == 0 else None
        figure_axes.plot(found[:, 0], exact[:, k] / 1e3, f"C{k}{style}", lw=1, label=label)
        figure_axes.plot(found[::8, 0], found[::8, 1 + k] / 1e3, f"C{k}o", ms=3,
                         label=f"{radius * 1e6:g} µm" if kappa < 1.0 else None)
print(f"eccentricities of {len(radii)} sizes and two kappa: within {worst:.1e} of the exact solution")
figure_axes.set(xlabel="orbits", ylabel=r"$a e$ (km)")
figure_axes.legend()
plt.savefig(figure)
