"""Collisions of a simulation in memory: recorded contacts, restitution laws of one's own."""

import ctypes
import os
import subprocess
import tempfile
import unittest

import numpy as np

import keeler
from scenes import RING, ring


LAW = """
double half(double speed, double low, double high) { return 0.5; }
double twice(double speed, double low, double high) { return 2.0; }
double mood = 0.5;
double moody(double speed, double low, double high) { return mood; }
"""


class Contacts(unittest.TestCase):
    def test_they_are_those_that_the_tally_counts(self):
        sim = keeler.Simulation(RING).run(0.05)
        before = sim.collisions_so_far
        with sim.collisions() as contacts:
            view = sim.elements  # recording goes on when the state is left to a view
            sim.run(0.1)
            first = contacts()
            sim.run(0.15)
            rows = np.concatenate([first, contacts()])
        after = sim.collisions_so_far
        counted = sum(after[name] - before[name] for name in ("collisions", "slow_contacts"))
        self.assertGreater(counted, 50)
        self.assertEqual(len(rows), counted)
        self.assertTrue(np.all(np.diff(rows["time_orbits"]) >= 0.0))
        self.assertTrue(np.all((rows["time_orbits"] >= 0.05) & (rows["time_orbits"] < 0.15)))
        self.assertTrue(np.all(rows["low_id"] < rows["high_id"]))
        fast = rows["normal_speed_m_s"] > np.median(rows["normal_speed_m_s"])
        # mu (1 - e^2) v_n^2 / 2 with half of the mass of a particle
        lost = 0.5 * 0.5 * sim.masses[0] * 0.75 * rows["normal_speed_m_s"] ** 2
        np.testing.assert_allclose(rows["energy_lost_j"][fast], lost[fast], rtol=1e-9)
        self.assertEqual(len(view), len(sim))

    def test_the_last_rows_come_after_the_block(self):
        sim = keeler.Simulation(RING)
        with sim.collisions() as contacts:
            sim.run(0.1)
            with self.assertRaises(keeler.UsageError), sim.collisions():
                pass
            sim.run(0.15)
        counted = sum(sim.collisions_so_far[name] for name in ("collisions", "slow_contacts"))
        self.assertEqual((len(contacts()), len(contacts())), (counted, 0))
        with self.assertRaises(keeler.UsageError), sim.collisions(float("nan")):
            pass

    def test_none_slower_than_asked(self):
        sim = keeler.Simulation(RING)
        with sim.collisions(minimum_speed=1e-3) as contacts:
            rows = (sim.run(0.2), contacts())[1]
        self.assertGreater(len(rows), 0)
        self.assertGreaterEqual(rows["normal_speed_m_s"].min(), 1e-3)


class Laws(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        source, library = (os.path.join(cls.folder.name, name) for name in ("law.c", "law.so"))
        with open(source, "w", encoding="utf-8") as file:
            file.write(LAW)
        subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", library, source], check=True)
        cls.functions = ctypes.CDLL(library)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_a_function_by_its_name_in_scene_hash_and_checkpoint(self):
        own = ring(collisions={"restitution": {"law": "own", "name": "half"}})
        with self.assertRaisesRegex(keeler.UsageError, "'half' is a function of the program"):
            keeler.Simulation(own)
        keeler.add_restitution_law("half", self.functions.half)
        sim, constant = keeler.Simulation(own).run(0.1), keeler.Simulation(RING).run(0.1)
        np.testing.assert_array_equal(sim.elements, constant.elements)
        self.assertNotEqual(sim.state_hash, constant.state_hash)  # the name is in it
        self.assertGreater(sim.collisions_so_far["collisions"], 50)
        os.mkdir(os.path.join(self.folder.name, "run"))
        file = os.path.join(self.folder.name, "run", "checkpoint_000000.h5")
        sim.save(file)
        self.assertEqual(keeler.load(file).run(0.2).state_hash, sim.run(0.2).state_hash)
        refused = subprocess.run(
            [keeler.program(), "resume", os.path.dirname(file)], capture_output=True, text=True, check=False
        )
        self.assertEqual(refused.returncode, 2)
        self.assertIn("'half'", refused.stderr)

    def test_a_law_that_gives_none_in_a_run_is_refused_and_the_state_is_that_of_before(self):
        keeler.add_restitution_law("moody", self.functions.moody)
        mood = ctypes.c_double.in_dll(self.functions, "mood")
        scene = ring(collisions={"restitution": {"law": "own", "name": "moody"}})
        wanted = keeler.Simulation(scene).run(0.04).run(0.06).state_hash
        for threads in (1, 2):
            keeler.set_threads(threads)
            for wrong in (float("nan"), -0.5, 5.0, float("inf"), 1.0000001):
                sim = keeler.Simulation(scene).run(0.04)
                before, positions = sim.state_hash, sim.positions
                mood.value = wrong
                with self.assertRaisesRegex(keeler.UsageError, "'moody' gives .*from 0 to 1"):
                    sim.run(0.06)
                mood.value = 0.5
                self.assertEqual(sim.state_hash, before)
                np.testing.assert_array_equal(sim.positions, positions)
                self.assertEqual(sim.run(0.06).state_hash, wanted)
        keeler.set_threads(1)

    def test_what_is_no_coefficient_is_refused(self):
        with self.assertRaisesRegex(keeler.UsageError, "coefficients are from 0 to 1"):
            keeler.add_restitution_law("double", self.functions.twice)
        keeler.add_restitution_law("once", self.functions.half)
        with self.assertRaisesRegex(keeler.UsageError, "already"):
            keeler.add_restitution_law("once", self.functions.half)
        for wrong in (lambda speed, low, high: 0.5, 0, -5, True, None, "half", b"half", 2**70):
            with self.assertRaisesRegex(keeler.UsageError, "no compiled function"):
                keeler.add_restitution_law("python", wrong)


if __name__ == "__main__":
    unittest.main()
