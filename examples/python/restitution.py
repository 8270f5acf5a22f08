"""The velocity dispersion of a ring against its restitution, for constant coefficients and for a law of one's own.

The more elastic impacts are, the faster particles must be until collisions take up what the shear's viscosity feeds in;
in thin rings there is no balance above a coefficient of 0.63 (Goldreich & Tremaine 1978). The own law is C, compiled
here: epsilon = exp(-v/v_c). What counts of it is its mean by energy, <epsilon^2 v^2>/<v^2> over impacts.
"""

import ctypes
import subprocess
import tempfile
from pathlib import Path

import keeler
import numpy as np
from common import RING, arguments, plt

figure, quick = arguments(__doc__, "restitution.png")
end = 6.0 if quick else 20.0  # orbits, half of them to find the balance
LAW = "#include <math.h>\ndouble law(double speed, double low, double high) { return exp(-speed / CRITICAL); }\n"


def balance(restitution):
    """c_x in r Omega with its scatter, and the speeds of impacts in m/s."""
    sim = keeler.Simulation(RING, collisions={"restitution": restitution}).run(0.5 * end)
    found = []
    with sim.collisions() as contacts:
        sim.run(end, every=0.5, callback=lambda sim: found.append(sim.analyze()["dispersion_r_omega"][0]))
        return np.mean(found), np.std(found), contacts()["normal_speed_m_s"]


constant = [0.2, 0.6] if quick else [0.05, 0.2, 0.35, 0.5, 0.6, 0.65]
found = np.array([balance({"law": "constant", "value": value})[:2] for value in constant])
plt.errorbar(constant, found[:, 0], yerr=found[:, 1], fmt="o-", ms=4, lw=1, label=r"$\epsilon$ constant")
for value, (c, error) in zip(constant, found):
    print(f"epsilon {value:g}: c_x {c:.2f} +- {error:.2f} r Omega")

with tempfile.TemporaryDirectory() as folder:
    for critical in [5e-4] if quick else [1e-4, 2e-4, 5e-4, 1e-3, 2e-3]:  # m/s; r Omega is 0.13 mm/s
        source, library = Path(folder, f"{critical}.c"), Path(folder, f"{critical}.so")
        source.write_text(LAW)
        command = ["cc", "-O2", "-shared", "-fPIC", f"-DCRITICAL={critical}", "-o", library, source, "-lm"]
        subprocess.run(command, check=True)
        keeler.add_restitution_law(f"exponential {critical}", ctypes.CDLL(str(library)).law)
        c, error, v = balance({"law": "own", "name": f"exponential {critical}"})
        mean = np.sqrt(np.average(np.exp(-2.0 * v / critical), weights=v**2))
        label = r"$\epsilon = \exp(-v/v_c)$, with $v_c$" if critical == 5e-4 else None
        plt.errorbar(mean, c, yerr=error, fmt="s", color="C1", label=label)
        plt.annotate(f"{critical * 1e3:g} mm/s", (mean, c), (7, -12), textcoords="offset points", size=9, color="C1")
        print(f"own law, v_c {critical * 1e3:g} mm/s: mean epsilon {mean:.2f}, c_x {c:.2f} +- {error:.2f} r Omega")
plt.xlabel(r"coefficient of restitution $\epsilon$ (own law: mean by energy)")
plt.ylabel(r"radial velocity dispersion $c_x$ ($r\,\Omega$)")
plt.ylim(bottom=0)
plt.legend(loc="upper left")
plt.savefig(figure)
