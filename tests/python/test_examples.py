"""examples/python: each script makes its figure, quickly, and prints numbers that a ring can have."""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

EXAMPLES = Path(os.environ["KEELER_SOURCE_DIR"]) / "examples" / "python"


@unittest.skipUnless(importlib.util.find_spec("matplotlib"), "matplotlib is not there")
class Examples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        settings = tempfile.TemporaryDirectory()  # of matplotlib: its list of fonts takes a second to make
        cls.addClassCleanup(settings.cleanup)
        cls.environment = {**os.environ, "MPLCONFIGDIR": settings.name}

    def figure(self, script, pattern, suffix=".png"):
        """Runs SCRIPT FIGURE --quick; the numbers of the first line that fits."""
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "figure" + suffix)
            ran = subprocess.run([sys.executable, "-B", EXAMPLES / script, file, "--quick"], cwd=folder, text=True,
                                 capture_output=True, check=False, env=self.environment)
            self.assertEqual(ran.returncode, 0, ran.stderr)
            import matplotlib.image

            colours = matplotlib.image.imread(file)
            self.assertGreater(min(colours.shape[:2]), 200)
            self.assertGreater(colours.std(), 0.01)  # not blank
            found = re.search(pattern, ran.stdout)
            self.assertTrue(found, ran.stdout)
            return [float(number) for number in found.groups()]

    def test_viscosity(self):
        # 1.241 +- 0.001 with 1500 particles (examples/python/README.md); here 300 over 4 orbits
        viscosity, error = self.figure("viscosity.py", r"tau 1: viscosity ([\d.]+) \+- ([\d.]+)")
        self.assertAlmostEqual(viscosity, 1.24, delta=0.12)
        self.assertTrue(0.0 < error < 0.1)

    def test_autocorrelation(self):
        # wakes of the A ring: 20 to 25 degrees (Salo 1995, Icarus 117, 287); this box is two wavelengths wide
        pitch, largest, deepest = self.figure(
            "autocorrelation.py", r"pitch ([\d.]+) degrees, xi\(0\) ([\d.]+), deepest (\S+);")
        self.assertTrue(15.0 < pitch < 32.0, pitch)
        self.assertGreater(largest, 1.0)
        self.assertTrue(-1.0 < deepest < -0.1, deepest)

    def test_own_start(self):
        # 382 particles in the diffusion equation: 5 % of noise, and 10 % while the ringlet finds its balance
        start, end, ratio = self.figure("own_start.py", r"variance (\d+) m2 to (\d+) m2, ([\d.]+) of")
        self.assertAlmostEqual(start, 20.0**2 / 12.0, delta=5.0)
        self.assertGreater(end, 3.0 * start)
        self.assertAlmostEqual(ratio, 1.0, delta=0.2)

    @unittest.skipUnless(shutil.which("cc"), "no C compiler")
    def test_restitution(self):
        # 1.24 and 3.23 r Omega after 20 orbits (README.md), and the own law between them, at 0.39
        hard, soft, mean, own = self.figure(
            "restitution.py",
            r"(?s)epsilon 0.2: c_x ([\d.]+).*epsilon 0.6: c_x ([\d.]+).*mean epsilon ([\d.]+), c_x ([\d.]+)")
        self.assertAlmostEqual(hard, 1.24, delta=0.12)
        self.assertAlmostEqual(soft, 3.2, delta=0.4)
        self.assertAlmostEqual(mean, 0.39, delta=0.04)
        self.assertTrue(hard < own < soft)

    def test_moonlet(self):
        hill, density = self.figure("moonlet.py", r"Hill radius ([\d.]+) m; .* the density is ([\d.]+) of")
        # R (4 pi G rho/(9 Omega^2))^(1/3) of 20 m and 200 kg/m^3 at Omega = 1.3175e-4 rad/s
        self.assertAlmostEqual(hill, 20.5, delta=0.1)
        self.assertLess(density, 0.5)  # a gap

    def test_movie(self):
        particles, frames, contrast = self.figure(
            "movie.py", r"(\d+) particles, (\d+) frames: wake contrast ([\d.]+)", ".gif")
        self.assertEqual((particles, frames), (573, 4))
        self.assertGreater(contrast, 0.2)

    def test_gas_drag(self):
        # (h/tau)^2/12 at St 0.03, and e^(-t/tau) at St 3
        error, rate, bound, radius = self.figure(
            "gas_drag.py", r"relative error ([\d.]+)\n.* falls at ([\d.]+) of 3 tau G M, bound at the end ([\d.]+), radius ([\d.]+) R_0")
        self.assertLess(error, 2e-3)
        self.assertAlmostEqual(rate, 0.93, delta=0.05)  # a lattice of 88 pebbles is bound less than a uniform sphere
        self.assertGreater(bound, 0.95)
        self.assertLess(radius, 0.5)

    def test_tesseral(self):
        patch, whole, largest = self.figure(
            "tesseral.py", r"patch: growth rates within ([\d.e-]+) g .*\n.* within ([\d.]+) g of the formula, largest ([\d.]+) g")
        self.assertLess(patch, 1e-3)
        self.assertLess(whole, 0.06)  # the formula is of first order in the anomaly: 0.96 g at mu = 0.01, 0.98 at 0.005
        self.assertAlmostEqual(largest, 0.98, delta=0.02)

    @unittest.skipUnless(shutil.which("cc"), "no C compiler")
    def test_radiation(self):
        self.assertLess(self.figure("radiation.py", r"kappa: within ([\d.e-]+) of")[0], 1e-5)


if __name__ == "__main__":
    unittest.main()
