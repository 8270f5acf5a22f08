#!/usr/bin/env python3
"""Measures what forces of one's own from Python cost: instructions per particle and step, by valgrind's callgrind.

    PYTHONPATH=build/default/python scripts/python_force_cost.py [PARTICLES]

The same drag is [gas], a function of Python, a compiled one, and one that says which array it reads; a ring of 1 m spheres at optical depth 0.3, without
self-gravity and with fft. Each number is the difference of runs of 6 and 2 steps. Needs valgrind and cc.
"""

import ctypes
import re
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = """
#include <math.h>
#include <stdint.h>
void drag(int64_t count, const double *x, const double *v, const double *c, const double *m, const double *r,
          const uint64_t *ids, const double *kick, const double *keys, double *a) {
  double rate = -expm1(-kick[1] * keys[0]) / kick[1];
  for (int64_t k = 0; k < 3 * count; ++k)
    a[k] = -rate * c[k];
}
"""


def steps(folder, gravity, kind, count):
    """Makes the steps; in a process of its own."""
    import keeler
    import numpy as np

    def drag(kick, accelerations):
        rate = np.expm1(-kick.interval * kick.keys["rate"]) / kick.interval
        np.multiply(kick.velocities_beyond_shear, rate, out=accelerations)

    keeler.set_threads(1)
    if kind in ("python", "compiled", "reads"):
        function = drag if kind == "python" else ctypes.CDLL(f"{folder}/drag.so").drag
        arrays = {"reads": ["velocities_beyond_shear"]} if kind == "reads" else {}
        keeler.add_force("own", function, {"rate": keeler.Key(1e-4, "1/s")}, **arrays)
    tables = {"none": {}, "[gas]": {"gas": {"stopping_time": 0.2}}}.get(kind, {"own": {}})
    if gravity != "no":
        tables["gravity"] = {"solver": gravity, "kick_every": 1}
    sim = keeler.Simulation(Path(folder, "scene.toml"), start=f"{folder}/start.hdf", **tables)
    sim.step(4 + count)


def instructions(*arguments):
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", sys.executable, "-W", "ignore", __file__, "steps"]
    said = subprocess.run([*command, *map(str, arguments)], capture_output=True, text=True, check=True).stderr
    return int(re.search(r"Collected : (\d+)", said)[1])


def main(particles):
    import keeler

    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "drag.c").write_text(SOURCE, encoding="utf-8")
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", f"{folder}/drag.so", f"{folder}/drag.c", "-lm"], check=True)
        side = (particles * 3.14159265 / 0.3) ** 0.5
        scene = {"planet": {"preset": "saturn-a-ring"}, "box": {"size": [side, side]},
                 "particles": {"count": particles, "density": 450.0, "sizes": {"law": "equal", "radius": 1.0}},
                 "collisions": {"restitution": {"law": "constant", "value": 0.5}}, "time": {"step": 2e-3, "end": 1.0}}
        sim = keeler.Simulation(scene).run(0.5)
        sim.snapshot().save(f"{folder}/start.hdf")
        Path(folder, "scene.toml").write_text(sim.scene, encoding="utf-8")
        print(f"{'self-gravity':14} {'force':10} instructions per particle and step")
        for gravity in ("no", "fft"):
            for kind in ("none", "[gas]", "python", "compiled", "reads"):
                more, fewer = (instructions(folder, gravity, kind, count) for count in (6, 2))
                print(f"{gravity:14} {kind:10} {(more - fewer) / 4 / particles:.0f}", flush=True)


if __name__ == "__main__":
    if sys.argv[1:2] == ["steps"]:
        steps(*sys.argv[2:5], int(sys.argv[5]))
    else:
        main(int(sys.argv[1]) if len(sys.argv) > 1 else 100000)
