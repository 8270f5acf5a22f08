"""The 1/3 resonance of a body with a mass anomaly, in a patch: eccentricities grow as the averaged equations say.

A ring's particle goes round once while the body turns three times: so it is with the rings of Quaoar and Chariklo (Sicardy
et al. 2019, Nature Astronomy 3, 146; Salo Salo & Sicardy 2024, EPSC2024-536 Sicardy 2026, A&A 708, A9). A mass anomaly mu on the equator has, beyond the
dipole that the centre of mass takes up, the tesseral potential -A(r) cos(theta - Omega_B t). Over Kepler orbits its term
of second order in e is (README.md)

    B e^2 cos(3 lambda - Omega_B t - 2 varpi),   B = 9/8 A - 3/4 a A' + 1/8 a^2 A'',   g = 2 B/(n a^2):

dE/dt = i g E* exp(i sigma) with E = e exp(i varpi), so e grows as exp(g t) in the resonance, and as exp(sqrt(g^2 -
Delta^2/4) t) at the distance Delta = d sigma/dt - 2 d varpi/dt from it. In the patch the same term is a force that is
linear in the epicycle. Dots: particles of a patch with this force of one's own. Crosses: whole orbits about a body and
its anomaly, integrated with the full attraction of both.
"""

import keeler
import numpy as np
from common import arguments, plt

figure, quick = arguments(__doc__, "tesseral.png")
MU, SURFACE = 0.005, 0.32  # the anomaly, and the body's radius in units of the orbit's
OMEGA = 2.5e-4  # of the patch, rad/s: Chariklo's ring


# --- the coefficient, in units of the orbit's n and a
def harmonic(m, a, of=lambda power: 1.0):
    """Sum over l of the cos(m psi) part of mu R^l/a^(l+1) P_l(cos psi), l from 2, each times of(l + 1)."""
    psi = np.arange(0.0, 2.0 * np.pi, np.pi / 64.0)
    total = 0.0
    for l in range(2, 40):
        p = np.polynomial.legendre.Legendre.basis(l)(np.cos(psi))
        total += MU * SURFACE**l / a ** (l + 1) * np.mean(p * np.cos(m * psi)) * (2.0 if m else 1.0) * of(l + 1)
    return total


def growth(a):
    """g in units of n."""
    return 2.0 * a * harmonic(1, a, lambda p: 9.0 / 8.0 + 0.75 * p + p * (p + 1) / 8.0)


def frequencies(a):
    """n and kappa of a circular orbit about the mean of the potential over longitude; G M is 1."""
    n2 = 1.0 / a**3 + harmonic(0, a, lambda p: p) / a**2
    kappa2 = 1.0 / a**3 + harmonic(0, a, lambda p: p * (2.0 - p)) / a**2
    return np.sqrt(n2), np.sqrt(kappa2)


g = growth(1.0)

# --- the patch: particles of many Delta, which never meet
offsets = np.linspace(-3.0, 3.0, 13 if quick else 31)  # Delta over g


def tesseral(kick, accelerations):
    c = kick.velocities_beyond_shear / kick.orbital_frequency
    w = 2.0 * c[:, 1] - 1j * c[:, 0]  # e exp(-i phi), m; kappa is Omega here
    delta = kick.keys["g"] * (kick.keys["offset"] + kick.keys["spread"] * kick.ids)
    turned = w.conj() * np.exp(1j * (delta - 2.0) * 2.0 * np.pi * kick.orbits)
    rate = 1j * kick.keys["g"] * turned * kick.orbital_frequency**2
    accelerations[:, 0], accelerations[:, 1] = -rate.imag, 0.5 * rate.real


keeler.add_force("tesseral", tesseral, {
    "g": keeler.Key(None, "Omega", "growth rate of eccentricities in the resonance", low=0.0),
    "offset": keeler.Key(0.0, "g", "distance from the resonance, of the particle 0"),
    "spread": keeler.Key(0.0, "g", "how much farther each particle of the next id is")})


def rates(after, time):
    """Growth rates of maps that preserve areas: `after` is what becomes of e vectors 1 and i."""
    trace = 0.5 * np.abs(after[0].real + after[1].imag)
    return np.arccosh(np.maximum(trace, 1.0)) / time


orbits, columns = 2.0 / g / (2.0 * np.pi), []
for eccentricity in (1.0, 1.0j):  # m, as vectors
    count = len(offsets)
    scene = {"planet": {"orbital_frequency": OMEGA}, "box": {"size": [4e3, 4e3]},
             "particles": {"density": 900.0, "sizes": {"law": "equal", "radius": 1.0}},
             "tesseral": {"g": g, "offset": offsets[0], "spread": offsets[1] - offsets[0]},
             "time": {"step": 5e-3, "end": orbits}}
    places = np.stack([np.zeros(count), np.linspace(-1.9e3, 1.9e3, count), np.zeros(count)], axis=1)
    w = np.full(count, eccentricity)
    speeds = OMEGA * np.stack([-w.imag, 0.5 * w.real, np.zeros(count)], axis=1)
    places[:, 0] -= w.real
    speeds[:, 1] -= 1.5 * OMEGA * places[:, 0]
    sim = keeler.from_arrays(scene, places, 1.0, speeds).run(orbits)
    c = (sim.by_id(sim.velocities) + 1.5 * OMEGA * sim.by_id(sim.positions)[:, [0]] * [0.0, 1.0, 0.0]) / OMEGA
    w = 2.0 * c[:, 1] - 1j * c[:, 0]
    time = 2.0 * np.pi * sim.orbits
    # E = w* exp(...) in the frame that turns with sigma/2: lambda is the time, sigma = (1 + delta) time
    columns.append((w * np.exp(1j * time)) * np.exp(-0.5j * offsets * g * time))
found = rates(columns, time)
law = g * np.sqrt(np.maximum(0.0, 1.0 - offsets**2 / 4.0))
inside = np.abs(offsets) < 1.9
error = np.abs(found - law)[inside].max() / g
print(f"g {g:.3e} n; patch: growth rates within {error:.1e} g of the formula")

# --- whole orbits about both masses, each beside two of slightly other eccentricity
n_1, kappa_1 = frequencies(1.0)
turning = n_1 + 2.0 * kappa_1  # Omega_B: 3 lambda - Omega_B t - 2 varpi rests at a = 1
begun = 1.0 + np.linspace(-2.0, 2.0, 7 if quick else 21) * g / -4.5  # d(n + 2 kappa - Omega_B)/da is -4.5
n, kappa = np.array([frequencies(a) for a in begun]).T
# On the orbit that the direct pull forces, x = x_m cos 2mt and dy/dt = -(2 x_m + A_m/2) cos 2mt: no free e grows there.
pulls = np.array([harmonic(m, 1.0) for m in range(1, 9)])
slopes = np.array([harmonic(m, 1.0, lambda power: -power) for m in range(1, 9)])
x_m = (pulls - slopes) / (4.0 * np.arange(1, 9) ** 2 - 1.0)
first = begun + x_m.sum()
small = 1e-6
# a circular orbit, and the two beside it with e vectors small and i small
z = np.stack([first + 0.0j, first - small, first - 2.0j * small])
v = 1.0j * n * (first - np.sum(2.0 * x_m + 0.5 * pulls)) + small * n * np.array([[0.0], [1.0j], [1.0]])


def attraction(z, time):
    body = np.exp(1.0j * turning * time)
    from_body, from_anomaly = z + MU * SURFACE * body, z - (1.0 - MU) * SURFACE * body
    return -(1.0 - MU) * from_body / np.abs(from_body) ** 3 - MU * from_anomaly / np.abs(from_anomaly) ** 3


h, longitudes = 0.05, [np.zeros(len(begun))]
outer = 1.0 / (2.0 - 2.0 ** (1.0 / 3.0))
parts = (outer, 1.0 - 2.0 * outer, outer)  # symplectic, of fourth order (Yoshida 1990): no drift of the energy
steps = round(1.0 / g / h)
for step in range(steps):
    t, before = step * h, z[0]
    for part in parts:
        z = z + 0.5 * part * h * v
        v = v + part * h * attraction(z, t + 0.5 * part * h)
        z = z + 0.5 * part * h * v
        t += part * h
    longitudes.append(longitudes[-1] + np.angle(z[0] / before))
time = steps * h
mean_n = np.polyfit(h * np.arange(steps + 1), np.array(longitudes), 1)[0]
delta = mean_n * (1.0 + 2.0 * kappa / n) - turning
axes = np.exp(-1.0j * longitudes[-1])
apart, moving = (z[1:] - z[0]) * axes, (v[1:] - v[0]) * axes
c_x, c_y = moving.real + n * apart.imag, moving.imag + 0.5 * n * apart.real
vectors = (2.0 * c_y - 1.0j * c_x) / n / small / axes * np.exp(-0.5j * (3.0 * longitudes[-1] - turning * time))
whole = rates(vectors, time)
law_here = g * np.sqrt(np.maximum(0.0, 1.0 - (delta / g) ** 2 / 4.0))
inside = np.abs(delta / g) < 1.5
whole_error = np.abs(whole - law_here)[inside].max() / g
print(f"whole orbits: growth rates within {whole_error:.4f} g of the formula, largest {whole.max() / g:.3f} g")

# --- the figure
fine = np.linspace(-3.0, 3.0, 601)
axes = plt.figure(figsize=(7, 4.5)).gca()
axes.plot(fine, np.sqrt(np.maximum(0.0, 1.0 - fine**2 / 4.0)), "C0", lw=1, label=r"$\sqrt{g^2 - \Delta^2/4}$")
axes.plot(offsets, found / g, "C0o", ms=4, label="patch with the averaged force")
axes.plot(delta / g, whole / g, "C3x", ms=7, label="whole orbits, body and anomaly")
axes.set(xlabel=r"distance from the resonance, $\Delta/g$", ylabel=r"growth rate of $e$ over $g$")
axes.set_ylim(-0.05, 1.35)
axes.legend(loc="upper center")
plt.savefig(figure)
