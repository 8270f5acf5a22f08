"""Photometry and occultations in Python: the numbers of the program, laws of one's own, errors."""

import json
import math
import os
import subprocess
import tempfile
import unittest

import keeler
from scenes import RING


def command(*words):
    """What the program says with --json."""
    return json.loads(subprocess.run([os.environ["KEELER_PROGRAM"], *words, "--json"], capture_output=True, check=True).stdout)


@unittest.skipUnless(keeler._core.can_trace(), "this Keeler was built without Embree")
class Light(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.snapshot = keeler.generate(RING)

    def test_sights_are_those_asked_for(self):
        found = keeler.photometry(self.snapshot, [20, -20], [0, 50], sun_elevation=15, phase=[60, 90], rays=100)
        self.assertEqual(len(found), 8)
        self.assertEqual([round(n["phase_degrees"]) for n in found], [60, 60, 90, 90] * 2)
        first = found[0]
        self.assertEqual(first["rays"], 8192)
        self.assertLess(0.0, first.error("reflectance"))
        self.assertAlmostEqual(first["reflectance"], first["single_scattering"] + first["multiple_scattering"], 12)
        self.assertIn("I/F", first.quantity("single_scattering").meaning)

    def test_a_simulation_is_its_snapshot(self):
        sim = keeler.Simulation(RING)
        self.assertEqual(
            keeler.photometry(sim, 30, 0, rays=1)[0]["reflectance"],
            keeler.photometry(sim.snapshot(), 30, 0, rays=1)[0]["reflectance"],
        )

    def test_a_function_is_a_phase_function_on_any_scale(self):
        named = keeler.photometry(self.snapshot, 20, 0, law="power_law=2", rays=1)[0]["reflectance"]
        own = keeler.photometry(self.snapshot, 20, 0, law=lambda a: 7.0 * (math.pi - a) ** 2, rays=1)[0]["reflectance"]
        self.assertAlmostEqual(named, own, 9)

    def test_a_surface_of_ones_own(self):
        named = keeler.photometry(self.snapshot, 20, 0, law="lambert", rays=1)[0]
        own = keeler.photometry(self.snapshot, 20, 0, law=keeler.SurfaceLaw(lambda mu0, mu, alpha: 7.0 * mu0), rays=1)[0]
        self.assertAlmostEqual(named["single_scattering"], own["single_scattering"], 9)
        self.assertAlmostEqual(named["reflectance"], own["reflectance"], delta=4 * named.error("reflectance"))
        for wrong in (lambda mu0, mu, alpha: -1.0, lambda mu0, mu, alpha: "much"):
            with self.assertRaisesRegex(keeler.UsageError, "surface"):
                keeler.photometry(self.snapshot, 20, 0, law=keeler.SurfaceLaw(wrong))
        with self.assertRaisesRegex(keeler.UsageError, "give a function of mu0"):
            keeler.SurfaceLaw(3)

    def test_the_asymmetry_is_that_of_the_command(self):
        found = keeler.photometry(self.snapshot, [20, 50], rays=1)
        self.assertEqual((len(found), len(found.asymmetries)), (36, 2))
        with tempfile.TemporaryDirectory() as folder:
            self.snapshot.save(f"{folder}/snap.hdf")
            said = command("photometry", f"{folder}/snap.hdf", "--elevation", "20,50", "--rays", "1")
        self.assertEqual(dict(found.asymmetries[1]), said["azimuthal_asymmetry"][1])
        self.assertEqual(dict(found[20]), said["sights"][20])
        self.assertIn("(max - min)/(max + min)", found.asymmetries[0].quantity("asymmetry").meaning)
        self.assertGreater(found.asymmetries[0].error("asymmetry"), 0.0)
        self.assertEqual(keeler.photometry(self.snapshot, 20, 0, rays=1).asymmetries, [])

    def test_an_occultation_has_the_numbers_of_the_command(self):
        options = {"length": 8.0, "width": 5.0, "track": 30.0, "tracks": 10, "samples": 8, "rays": 16, "section": "ellipse"}
        found = keeler.occultation(self.snapshot, [10, 40], [0, 60, 120], **options)
        with tempfile.TemporaryDirectory() as folder:
            self.snapshot.save(f"{folder}/snap.hdf")
            words = [word for name, value in options.items() for word in (f"--{name}", str(value))]
            said = command("occultation", f"{folder}/snap.hdf", "--elevation", "10,40", "--azimuth", "0,60,120", *words)
        self.assertEqual([dict(line) for line in found], said["lines_of_sight"])
        self.assertEqual(dict(found.wake_model), said["wake_model"])
        self.assertEqual(len(found[0]["autocovariance"]), 5)
        self.assertGreater(found[0].error("transmission"), 0.0)
        self.assertIsNone(keeler.occultation(self.snapshot, 30, 0, tracks=2, samples=2).wake_model)
        for words, wrong in (("section is 'round'", {"section": "round"}), ("tracks is 1", {"tracks": 1}),
                             ("length is 0", {"length": 0}), ("elevations of 0.1", {"elevation": 0})):
            with self.subTest(words), self.assertRaisesRegex(keeler.UsageError, words):
                keeler.occultation(self.snapshot, **{"elevation": 20, **wrong})

    def test_an_error_is_met(self):
        found = keeler.photometry(self.snapshot, 20, 0, error=0.02)[0]
        self.assertLessEqual(found.error("reflectance"), 0.02 * found["reflectance"])

    def test_invalid_arguments(self):
        for words, named in (
            ("elevations of 0.1", {"elevation": 0.0}),
            ("give angles", {"elevation": "high"}),
            ("the phase angle is from", {"elevation": 20, "phase": 170}),
            ("no scattering law 'moon'", {"elevation": 20, "law": "moon"}),
            ("give the name of a law, a function", {"elevation": 20, "law": 3}),
            ("the phase function is -1", {"elevation": 20, "law": lambda a: -1}),
            ("albedo is 2", {"elevation": 20, "albedo": 2}),
            ("rays is 0", {"elevation": 20, "rays": 0}),
        ):
            with self.subTest(words), self.assertRaisesRegex(keeler.UsageError, words):
                keeler.photometry(self.snapshot, **named)
        with self.assertRaises(ZeroDivisionError):
            keeler.photometry(self.snapshot, 20, law=lambda a: 1 / 0)


if __name__ == "__main__":
    unittest.main()
