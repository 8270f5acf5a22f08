"""An invariant breaks in a step: the state can be looked at and saved, and does not go on."""

import tempfile
import unittest
from pathlib import Path

import numpy as np

import keeler
from scenes import ring

# A closed row of elastic spheres without gaps: what hits it runs around it for ever in no time. A fourth is elsewhere.
ROW = {
    "planet": {"orbital_frequency": 2e-4},
    "box": {"size": [20.0, 6.0]},
    "particles": {"density": 500.0},
    "collisions": {"restitution": {"law": "constant", "value": 1.0}},
    "time": {"step": 1e-3, "end": 0.01},
}
PLACES = np.array([[0.0, -3.0, 0.0], [0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [7.0, 0.0, 0.0]])
VELOCITIES = np.array([[0.0, 2e-4, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1e-4, -1.5 * 2e-4 * 7.0, 0.0]])


class AnEventStorm(unittest.TestCase):
    def setUp(self):
        start = keeler.start_from_arrays(ROW, PLACES, 1.0, VELOCITIES)
        self.sim = keeler.Simulation(ROW, start=start, particles={"count": 4})
        self.before = self.sim.positions
        with self.assertRaisesRegex(keeler.InvariantError, "an event storm"):
            self.sim.run()

    def test_its_arrays_can_be_read(self):
        sim = self.sim
        self.assertEqual(len(sim), 4)
        self.assertTrue(0.0 <= sim.orbits <= 1e-3)
        for array in (sim.positions, sim.velocities, sim.elements, sim.radii, sim.masses):
            self.assertTrue(np.all(np.isfinite(array)))
        # of the fourth particle the orbit is known: nobody hit it
        moved = sim.positions[sim.ids == 3][0] - PLACES[3]
        seconds = sim.orbits * 2.0 * np.pi / 2e-4
        np.testing.assert_allclose(moved, seconds * VELOCITIES[3], atol=1e-3 * max(seconds, 1e-6))
        self.assertEqual(sim.collisions_so_far["steps"], 0)

    def test_it_can_be_saved_and_looked_at_as_a_snapshot(self):
        snapshot = self.sim.snapshot()
        np.testing.assert_array_equal(snapshot.positions, self.sim.by_id(self.sim.positions))
        np.testing.assert_array_equal(snapshot.velocities, self.sim.by_id(self.sim.velocities))
        self.assertEqual((snapshot.orbits, snapshot.shear_offset), (self.sim.orbits, self.sim.shear_offset))
        self.assertIn("optical_depth", self.sim.analyze())
        self.assertTrue(self.sim.plot(width=400).data.startswith(b"\x89PNG"))
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "broken.hdf"
            snapshot.save(file)
            np.testing.assert_array_equal(keeler.read(file).positions, snapshot.positions)

    def test_it_does_not_go_on(self):
        def edit():
            with self.sim.edit():
                pass

        def record():
            with self.sim.collisions():
                pass

        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "checkpoint_000000.h5"
            for refused in (self.sim.step, self.sim.run, edit, record, lambda: self.sim.save(file), lambda: self.sim.state_hash):
                with self.assertRaisesRegex(keeler.RunError, "cannot go on .*an event storm.*snapshot"):
                    refused()
            self.assertFalse(file.exists())

    def test_arrays_from_before_stay(self):
        np.testing.assert_array_equal(self.before[:, 2], 0.0)
        elements = self.sim.elements
        kept = np.array(elements)
        del self.sim
        np.testing.assert_array_equal(elements, kept)


class ASoundState(unittest.TestCase):
    def test_the_snapshot_is_that_of_the_arrays(self):
        sim = keeler.Simulation(ring()).run(0.02)
        snapshot = sim.snapshot()
        np.testing.assert_array_equal(snapshot.positions, sim.by_id(sim.positions))
        self.assertEqual((snapshot.orbits, snapshot.shear_offset), (sim.orbits, sim.shear_offset))


if __name__ == "__main__":
    unittest.main()
