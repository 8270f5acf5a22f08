"""No memory in the middle of a change: each allocation of C++ fails in turn, and the state is that of before."""

import ctypes
import os
import subprocess
import sys
import unittest

import numpy as np

LIBRARY = os.environ["KEELER_FAILING_MEMORY"]
if LIBRARY not in os.environ.get("LD_PRELOAD", ""):  # these tests again, with the library before all others
    environment = {**os.environ, "LD_PRELOAD": LIBRARY, "PYTHONWARNINGS": "error"}
    sys.exit(subprocess.run([sys.executable, *sys.argv], env=environment, check=False).returncode)

import keeler  # noqa: E402
from scenes import ring  # noqa: E402

failing = ctypes.CDLL(LIBRARY)
failing.fail_allocations.argtypes = [ctypes.c_long, ctypes.c_long]
failing.allocations.restype = ctypes.c_long
FOREVER = 2**62

FRICTION = {"restitution": {"law": "constant", "value": 0.5}, "friction": {"tangential_restitution": 0.5}}
SMALL = {"size": [40.0, 40.0]}
SCENES = {
    "no gravity": ring(box=SMALL, collisions=FRICTION),
    "tree": ring(box=SMALL, gravity={"solver": "tree", "resting_contacts": "carried"}),
    "mesh": ring(box=SMALL, gravity={"solver": "fft", "kick_every": 2}),
    "radial": ring(box=SMALL, gravity={"solver": "axisymmetric", "shortest_wavelength": 5.0}),
}


def attempt(change, sim, first, last):
    """Whether change(sim) came through although these allocations in it failed, and how many it made."""
    failing.fail_allocations(first, last)
    try:
        change(sim)
        return True, failing.allocations()
    except MemoryError:
        return False, failing.allocations()
    finally:
        failing.fail_allocations(0, 0)


class EachAllocationFails(unittest.TestCase):
    def tearDown(self):
        keeler.set_threads(1)

    def all_in_turn(self, make, change, lasting=False, every=1):
        """The first, the second, … allocation of change(make()) fails, for good or once, until one is not reached. Where
        that shows, the state and the arrays that are held are those of before; then, or where it does not, the change leads
        to the state that it leads to with memory."""
        undisturbed = make()
        change(undisturbed)
        wanted, failed, at, sim = undisturbed.state_hash, 0, 1, None
        while True:
            if sim is None:
                sim = make()
                before, held = sim.state_hash, sim.elements
                copy = np.array(held)
            done, made = attempt(change, sim, at, FOREVER if lasting else at)
            if done:
                self.assertEqual(sim.state_hash, wanted, f"allocation {at}")
                if made < at:
                    return failed
                sim = None
            else:
                failed += 1
                self.assertEqual(sim.state_hash, before, f"allocation {at}")
                np.testing.assert_array_equal(held, copy)
                if failed % 16 == 0:
                    change(sim)
                    self.assertEqual(sim.state_hash, wanted, f"after allocation {at}")
                    np.testing.assert_array_equal(held, copy)
                    sim = None
            at += every

    def test_in_a_step(self):
        for name, scene in SCENES.items():
            start = keeler.Simulation(scene).run(0.02).snapshot()
            for threads in (1, 2):
                keeler.set_threads(threads)
                with self.subTest(scene=name, threads=threads):
                    failed = self.all_in_turn(
                        lambda start=start, scene=scene: keeler.Simulation(scene, start), lambda sim: sim.step(2), every=2
                    )
                    self.assertGreater(failed, 10)

    def test_in_a_step_from_then_on(self):
        make = lambda: keeler.Simulation(SCENES["tree"])  # noqa: E731
        self.assertGreater(self.all_in_turn(make, lambda sim: sim.step(), lasting=True, every=5), 10)

    def test_in_an_edit(self):
        def change(sim):
            with sim.edit() as state:
                state.velocities[3, 2] += 1e-5

        for name, scene in SCENES.items():
            with self.subTest(scene=name):
                make = lambda scene=scene: keeler.Simulation(scene)  # noqa: E731
                self.assertGreater(self.all_in_turn(make, change), 10)

    def test_contacts_are_those_of_the_steps_that_were_done(self):
        def rows_of(sim, at):
            with sim.collisions() as contacts:
                sim.step(20)
                if at:
                    self.assertFalse(attempt(lambda its: its.step(20), sim, at, at)[0])
                sim.step(20)
                return contacts()

        wanted = rows_of(keeler.Simulation(SCENES["no gravity"]), 0)
        self.assertGreater(len(wanted), 10)
        for at in (1, 5, 20, 40, 60):
            np.testing.assert_array_equal(rows_of(keeler.Simulation(SCENES["no gravity"]), at), wanted)


if __name__ == "__main__":
    unittest.main()
