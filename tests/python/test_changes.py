"""Changes of the state of a simulation in memory: edit()."""

import unittest

import numpy as np

import keeler
from scenes import ring


class Changes(unittest.TestCase):
    def setUp(self):
        self.sim = keeler.Simulation(ring(gravity={"solver": "tree"})).run(0.05)

    def test_no_change_changes_no_bits(self):
        before = self.sim.state_hash
        with self.sim.edit():
            pass
        self.assertEqual(self.sim.state_hash, before)

    def test_a_change_is_the_state(self):
        with self.sim.edit() as state:
            state.velocities[3] += [0.0, 0.0, 1e-4]
            state.masses[5] *= 2.0
            wanted, mass = np.array(state.velocities[3]), state.masses[5]
        np.testing.assert_allclose(self.sim.velocities[3], wanted, atol=1e-16)
        self.assertEqual(self.sim.masses[5], mass)
        self.sim.run(0.1)

    def test_what_cannot_be_is_refused_and_nothing_changes(self):
        before = self.sim.state_hash

        def overlap(state):
            state.positions[0] = state.positions[1]

        def not_a_number(state):
            state.velocities[2, 0] = np.nan

        def negative(state):
            state.radii[2] = -1.0

        def shape(state):
            state.radii = np.ones(2)

        def masked(state):
            state.radii = np.ma.masked_less(state.radii, 2.0)

        def other_ids(state):
            state.ids = state.ids[::-1]

        def put(name, value):
            def change(state):
                getattr(state, name)[4] = value

            return change

        for change, error in [
            (put("radii", 1e-300), keeler.InvariantError), (put("radii", 1e4), keeler.InvariantError),
            (put("radii", 40.0), keeler.InvariantError), (put("masses", 1e9), keeler.InvariantError),
            (put("masses", 1e-9), keeler.InvariantError), (put("positions", [1000.0, 0.0, 0.0]), keeler.InvariantError),
            (put("positions", [0.0, -1000.0, 0.0]), keeler.InvariantError),
            (put("positions", [0.0, 0.0, 1e8]), keeler.InvariantError),
            (put("velocities", [0.0, 1e5, 0.0]), keeler.InvariantError), (masked, keeler.UsageError),
            (other_ids, keeler.UsageError),
            (overlap, keeler.InvariantError), (not_a_number, keeler.InvariantError),
            (negative, keeler.InvariantError), (shape, keeler.UsageError),
        ]:
            with self.assertRaises(error), self.sim.edit() as state:
                change(state)
            self.assertEqual(self.sim.state_hash, before)
        with self.assertRaises(keeler.InvariantError), self.sim.edit() as state:
            state.radii[:] = 1e4
        with self.assertRaises(AttributeError), self.sim.edit() as state:
            state.position = 0.0
        with self.assertRaises(ValueError), self.sim.edit() as state:
            state.ids[:] = 0
        with self.assertRaises(KeyError), self.sim.edit() as state:
            state.masses *= 2.0
            raise KeyError
        self.assertEqual(self.sim.state_hash, before)

    def test_a_place_a_little_outside_is_one_inside(self):
        with self.sim.edit() as state:
            state.positions[:, 0] += 1.0
        self.assertLess(np.abs(self.sim.positions[:, 0]).max(), 40.0)  # its guiding centre is inside
        self.sim.run(0.1)

    def test_a_simulation_that_moves_on_within_is_refused(self):
        def moves():
            self.sim.run(0.1)

        def is_changed():
            with self.sim.edit():
                pass

        for meanwhile in (is_changed, moves):
            with self.assertRaisesRegex(keeler.UsageError, "within edit"), self.sim.edit() as state:
                state.masses *= 2.0
                meanwhile()
            self.assertLess(self.sim.masses.max(), 450.0 * 4.2)

    def test_spins(self):
        friction = {"restitution": {"law": "constant", "value": 0.5}, "friction": {"tangential_restitution": 0.5}}
        sim = keeler.Simulation(ring(collisions=friction)).run(0.05)
        with sim.edit() as state:
            state.spins[:] = [0.0, 0.0, 2.0 * sim.orbital_frequency]
        before = sim.state_hash
        with sim.edit():
            pass
        self.assertEqual(sim.state_hash, before)
        with self.assertRaisesRegex(keeler.UsageError, "smooth"), self.sim.edit() as state:
            state.spins = np.ones((len(self.sim), 3))
        np.testing.assert_allclose(sim.spins, [[0.0, 0.0, 2.0 * sim.orbital_frequency]] * len(sim), atol=1e-18)
        self.assertIsNone(self.sim.spins)


if __name__ == "__main__":
    unittest.main()
