"""Photometry in Python: the numbers of the program, laws of one's own, errors."""

import math
import unittest

import keeler
from scenes import RING


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

    def test_an_error_is_met(self):
        found = keeler.photometry(self.snapshot, 20, 0, error=0.02)[0]
        self.assertLessEqual(found.error("reflectance"), 0.02 * found["reflectance"])

    def test_invalid_arguments(self):
        for words, named in (
            ("elevations of 0.1", {"elevation": 0.0}),
            ("give angles", {"elevation": "high"}),
            ("the phase angle is from", {"elevation": 20, "phase": 170}),
            ("no scattering law 'moon'", {"elevation": 20, "law": "moon"}),
            ("give the name of a law", {"elevation": 20, "law": 3}),
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
