"""A snapshot in the hands of h5py, yt and VTK: the state's own numbers, in metres, kilograms and seconds."""

import math
import tempfile
import unittest
from pathlib import Path

import numpy as np
import h5py

import keeler
from scenes import ring

DENSITY, RADIUS = 450.0, 1.0  # of the scene


class Readers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.file = Path(cls.folder.name) / "snap_000000.hdf"
        sim = keeler.Simulation(ring())
        sim.run(0.1)
        sim.snapshot().save(cls.file)
        cls.sim = sim
        with h5py.File(cls.file) as file:
            cls.ring = dict(file["RingBox"].attrs)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def compare(self, found, expected):
        """The same numbers for the same particles, but for the rounding of a change of units."""
        self.assertEqual(found.shape, expected.shape)
        np.testing.assert_allclose(found, expected, rtol=1e-14, atol=0.0)

    def state(self):
        sim = self.sim
        return [sim.by_id(array) for array in (sim.positions, sim.velocities, sim.masses)]

    def test_h5py(self):
        x, v, m = self.state()
        with h5py.File(self.file) as file:
            for name, unit, expected in (("Coordinates", b"m", x), ("Velocities", b"m/s", v), ("Masses", b"kg", m)):
                self.assertEqual(file["PartType1"][name].attrs["unit"], unit)
                self.compare(file["PartType1"][name][:], expected)
        # Units by physics, not by name: the mass of a sphere, and a shear of 3/2 of the orbital frequency.
        self.assertAlmostEqual(m[0] / (4.0 / 3.0 * math.pi * DENSITY * RADIUS**3), 1.0, places=12)
        slope = np.polyfit(x[:, 0], v[:, 1], 1)[0]
        self.assertAlmostEqual(slope / (-1.5 * self.ring["Omega"]), 1.0, delta=0.02)

    def test_yt(self):
        import yt

        yt.set_log_level("error")
        data = yt.load(
            str(self.file),
            bounding_box=np.array([self.ring["bounds_low"], self.ring["bounds_high"]]).T,
            unit_base={"UnitLength_in_cm": 100.0, "UnitMass_in_g": 1e3, "UnitVelocity_in_cm_per_s": 100.0},
        ).all_data()
        order = np.argsort(data["PartType1", "ParticleIDs"])
        for name, unit, expected in zip(("Coordinates", "Velocities", "Masses"), ("m", "m/s", "kg"), self.state()):
            self.compare(data["PartType1", name].to(unit).v[order], expected)

    def test_vtk(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOHDF import vtkHDFReader

        reader = vtkHDFReader()
        self.assertTrue(reader.CanReadFile(str(self.file)))
        reader.SetFileName(str(self.file))
        reader.Update()
        grid = reader.GetOutput()
        x, v, m = self.state()
        self.compare(vtk_to_numpy(grid.GetPoints().GetData()), x)
        self.compare(vtk_to_numpy(grid.GetPointData().GetArray("Velocities")), v)
        self.compare(vtk_to_numpy(grid.GetPointData().GetArray("Masses")), m)


if __name__ == "__main__":
    unittest.main()
