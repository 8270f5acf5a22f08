"""A simulation in memory: its arrays, its course, changes, contacts, laws, errors."""

import ctypes
import gc
import os
import signal
import subprocess
import tempfile
import threading
import time
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


class Scenes(unittest.TestCase):
    def test_a_file_a_text_and_a_dictionary_are_one_scene(self):
        sim = keeler.Simulation(RING)
        self.assertEqual(keeler.Simulation(sim.scene).state_hash, sim.state_hash)

    def test_overrides_by_table_and_by_key(self):
        by_table = keeler.Simulation(RING, particles={"seed": 7}, time={"step": 1e-3})
        by_key = keeler.Simulation(RING, **{"particles.seed": 7, "time.step": 1e-3})
        self.assertEqual(by_table.state_hash, by_key.state_hash)
        self.assertNotEqual(by_table.state_hash, keeler.Simulation(RING).state_hash)

    def test_a_former_name_of_a_key_is_read_with_a_remark(self):
        now = keeler.Simulation(RING, collisions={"elastic_below_speed": 0.02})
        before = keeler.Simulation(RING, collisions={"elastic_below": 0.02})
        self.assertEqual((now.state_hash, now.scene), (before.state_hash, before.scene))
        self.assertIn("'collisions.elastic_below' is now called 'collisions.elastic_below_speed'", before.remarks[0])

    def test_contacts_at_rest_are_chosen_by_the_particles_wherever_they_come_from(self):
        for r_h, word in ((0.65, "bounced"), (0.93, "carried")):
            dense = ring(
                box={"size": [25.0, 25.0]},
                particles={"optical_depth": 2.0, "density": 742.9 * r_h**3, "velocity_dispersion": 8.0,
                           "sizes": {"law": "equal", "radius": 1.0}},
                gravity={"solver": "direct"},
                time={"step": 5e-3, "end": 0.01},
            )
            fresh = keeler.Simulation(dense)
            start = fresh.snapshot()
            by_arrays = keeler.from_arrays(dense, start.positions, start.radii, start.velocities, start.masses)
            for sim in (fresh, keeler.Simulation(dense, start=start), by_arrays):
                self.assertIn(f'resting_contacts = "{word}"', sim.scene)

    def test_numbers_of_numpy_are_numbers(self):
        size = np.array([60.0, 60.0])
        sim = keeler.Simulation(RING, box={"size": size}, particles={"seed": np.int64(1)}, time={"step": np.float64(2e-3)})
        self.assertEqual(sim.state_hash, keeler.Simulation(RING).state_hash)

    def test_what_no_scene_can_be_is_refused_in_one_line(self):
        for scene, words in [
            ("no-such.toml", "cannot read the scene 'no-such.toml'"),
            (3, "a scene cannot be 3"),
            (ring(time={"step": 1e-3, "end": float("nan")}), "give a finite number"),
            (ring(title=object()), "a scene has texts, numbers, lists and tables"),
            (ring(time={"stepp": 1e-3}), "stepp"),
        ]:
            with self.assertRaises(keeler.UsageError) as caught:
                keeler.Simulation(scene)
            self.assertIn(words, str(caught.exception))
            self.assertNotIn("\n", str(caught.exception))
        with self.assertRaisesRegex(keeler.UsageError, "^time.ende"):
            keeler.Simulation(RING, time={"ende": 1.0})


class Arrays(unittest.TestCase):
    def setUp(self):
        self.sim = keeler.Simulation(ring(gravity={"solver": "tree", "kick_every": 2}))

    def test_shapes_and_units(self):
        sim = self.sim
        n = len(sim)
        for array, shape in [
            (sim.positions, (n, 3)), (sim.velocities, (n, 3)), (sim.elements, (n, 6)), (sim.radii, (n,)),
            (sim.masses, (n,)), (sim.ids, (n,)),
        ]:
            self.assertEqual(array.shape, shape)
            self.assertFalse(array.flags.writeable)
        np.testing.assert_allclose(sim.masses, 450.0 * 4.0 / 3.0 * np.pi * sim.radii**3, rtol=1e-14)
        # the mean motion is the shear, -(3/2) Omega x and a little
        slope = np.polyfit(sim.positions[:, 0], sim.velocities[:, 1], 1)[0] / sim.orbital_frequency
        self.assertAlmostEqual(slope, -1.5, delta=0.02)

    def test_positions_follow_from_the_elements(self):
        sim = self.sim
        x, y, ec, es, i_s, ic = sim.elements.T
        kappa = nu = None
        for line in sim.scene.splitlines():
            if "epicyclic_ratio" in line:
                kappa = float(line.split("=")[1])
            if "vertical_ratio" in line:
                nu = float(line.split("=")[1])
        t = 2.0 * np.pi * (sim.orbits - sim.epoch)
        ect, est = ec * np.cos(kappa * t) - es * np.sin(kappa * t), es * np.cos(kappa * t) + ec * np.sin(kappa * t)
        shear = 0.5 * (4.0 - kappa**2)
        place = np.column_stack([x - ect, y - shear * x * t + 2.0 / kappa * est, i_s * np.cos(nu * t) + ic * np.sin(nu * t)])
        np.testing.assert_allclose(sim.positions, place, atol=1e-11)

    def test_a_kept_array_stays_as_it_was(self):
        sim = self.sim
        views = [sim.elements, sim.radii, sim.ids, sim.positions]
        copies = [np.array(view) for view in views]
        sim.run(0.2)
        for view, copy in zip(views, copies):
            np.testing.assert_array_equal(view, copy)
        self.assertFalse(np.array_equal(sim.elements, copies[0]))
        elements, copy = sim.elements, np.array(sim.elements)
        del sim, self.sim
        gc.collect()
        np.testing.assert_array_equal(elements, copy)

    def test_views_do_not_change_the_course(self):
        other = keeler.Simulation(ring(gravity={"solver": "tree", "kick_every": 2}))
        kept = []
        self.sim.run(0.2, every=0.02, callback=lambda sim: kept.append((sim.elements, sim.masses)))
        self.assertEqual(self.sim.state_hash, other.run(0.2).state_hash)
        self.assertEqual(len(kept), 10)

    def test_images_stand_where_the_shear_offset_says(self):
        sim = self.sim.run(0.13)
        (length, width), offset = sim.box, sim.shear_offset
        self.assertGreater(min(offset, width - offset), 1.0)  # its sign can be seen
        first, second = np.split(sim.snapshot().tile(2, 1).positions, 2)  # the copies, each in the order of the ids
        apart = second - first
        np.testing.assert_allclose(np.abs(apart[:, 0]), length, atol=1e-9)
        shift = (apart[:, 1] + np.sign(apart[:, 0]) * offset) / width
        np.testing.assert_allclose(shift, np.round(shift), atol=1e-9)
        wrong = (apart[:, 1] - np.sign(apart[:, 0]) * offset) / width
        self.assertGreater(np.abs(wrong - np.round(wrong)).min(), 1e-3)

    def test_rows_by_id(self):
        sim = self.sim.run(0.2)
        self.assertFalse(np.array_equal(sim.ids, np.arange(len(sim))))
        np.testing.assert_array_equal(sim.by_id(sim.ids), np.arange(len(sim)))
        np.testing.assert_array_equal(sim.by_id(sim.positions), sim.snapshot().positions)
        with self.assertRaises(keeler.UsageError):
            sim.by_id(np.zeros(3))


class Course(unittest.TestCase):
    def test_callbacks_come_when_asked_and_the_end_is_the_scene_s(self):
        sim, times = keeler.Simulation(RING), []
        sim.run(every=0.05, callback=lambda sim: times.append(sim.orbits))
        np.testing.assert_allclose(times, [0.05, 0.1, 0.15, 0.2], atol=1e-12)

    def test_pieces_make_the_same_bits(self):
        whole, pieces = keeler.Simulation(RING).run(0.2), keeler.Simulation(RING)
        for _ in range(4):
            pieces.run(pieces.orbits + 0.05)
        self.assertEqual(whole.state_hash, pieces.state_hash)
        self.assertEqual(whole.collisions_so_far, pieces.collisions_so_far)

    def test_what_a_callback_raises_ends_the_run(self):
        def enough(sim):
            raise StopIteration

        sim = keeler.Simulation(RING)
        with self.assertRaises(StopIteration):
            sim.run(0.2, every=0.1, callback=enough)
        self.assertAlmostEqual(sim.orbits, 0.1)
        self.assertEqual(sim.run(0.2).state_hash, keeler.Simulation(RING).run(0.2).state_hash)

    def test_an_automatic_step(self):
        scene = ring(gravity={"solver": "tree"}, time={"step": "auto", "end": 0.125})
        self.assertAlmostEqual(keeler.Simulation(scene).run().orbits, 0.125)

    def test_bad_times(self):
        sim = keeler.Simulation(RING).run(0.1)
        for until in (0.05, float("nan"), -1.0, 1e30, "soon"):
            with self.assertRaises(keeler.UsageError):
                sim.run(until)
        for wrong in ({"every": 0.1}, {"callback": print}, {"every": "often", "callback": print}):
            with self.assertRaises(keeler.UsageError):
                sim.run(0.2, **wrong)
        for wrong in (-1, 1.5):
            with self.assertRaises(keeler.UsageError):
                sim.step(wrong)
        sim.step(np.int64(1))
        with self.assertRaisesRegex(keeler.UsageError, "orbit 0.2"):
            sim.run(0.3).run()

    def test_other_signals_are_heeded_while_it_runs(self):
        class TooLong(Exception):
            pass

        def stop(*_):
            raise TooLong

        before = signal.signal(signal.SIGALRM, stop)
        self.addCleanup(signal.signal, signal.SIGALRM, before)
        sim = keeler.Simulation(ring(box={"size": [200.0, 200.0]}, time={"step": 5e-4, "end": 500.0}))
        begin = time.monotonic()
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        with self.assertRaises(TooLong):
            sim.run()
        self.assertLess(time.monotonic() - begin, 10.0)
        sim.step()

    def interrupted(self, presses, side=300.0, **tables):
        sim = keeler.Simulation(ring(box={"size": [side, side]}, time={"step": 5e-4, "end": 500.0}, **tables))

        # The second at once, while the steps at hand are still on their way, and both before the run can have ended.
        def press():
            time.sleep(0.2)
            for _ in range(presses):
                os.kill(os.getpid(), signal.SIGINT)
                time.sleep(0.02)

        thread = threading.Thread(target=press)
        thread.start()
        begin = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            sim.run()
        thread.join()
        self.assertLess(time.monotonic() - begin, 10.0)
        return sim

    def test_ctrl_c_ends_a_run_between_steps_and_it_can_go_on(self):
        before = signal.getsignal(signal.SIGINT)
        sim = self.interrupted(presses=1)
        self.assertGreater(sim.orbits, 0.0)
        self.assertIs(signal.getsignal(signal.SIGINT), before)
        end = sim.orbits + 0.01
        again = keeler.Simulation(ring(box={"size": [300.0, 300.0]}, time={"step": 5e-4, "end": 500.0})).run(end)
        self.assertEqual(sim.run(end).state_hash, again.state_hash)

    def test_a_second_ctrl_c_gives_up_the_steps_at_hand_and_the_state_is_that_of_before(self):
        kicks = {"gravity": {"solver": "tree", "kick_every": 1000}}  # many seconds from one to the next in so large a box
        scene = ring(box={"size": [900.0, 900.0]}, time={"step": 5e-4, "end": 500.0}, **kicks)
        sim = self.interrupted(presses=2, side=900.0, **kicks)
        self.assertEqual((sim.orbits, sim.state_hash), (0.0, keeler.Simulation(scene).state_hash))
        self.assertGreater(len(sim.snapshot()), 1000)

    def test_two_simulations_in_two_threads(self):
        sims = [keeler.Simulation(RING, particles={"seed": seed}) for seed in (1, 2)]
        threads = [threading.Thread(target=sim.run, args=(0.2,)) for sim in sims]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for seed, sim in zip((1, 2), sims):
            self.assertEqual(sim.state_hash, keeler.Simulation(RING, particles={"seed": seed}).run(0.2).state_hash)

    def test_one_simulation_in_two_threads_says_no(self):
        sim = keeler.Simulation(ring(box={"size": [300.0, 300.0]}))
        thread = threading.Thread(target=sim.run, args=(0.2,))
        thread.start()
        refused = 0
        while thread.is_alive():
            try:
                sim.elements
            except keeler.RunError as error:
                self.assertIn("another thread", str(error))
                refused += 1
        thread.join()
        self.assertGreater(refused, 0)

    def test_threads_change_no_bits(self):
        hashes = set()
        for threads in (1, 2, 3):
            keeler.set_threads(threads)
            hashes.add(keeler.Simulation(RING).run(0.1).state_hash)
        self.assertEqual(len(hashes), 1)
        for wrong in (100000, 0, "2", 1.5):
            with self.assertRaises(keeler.UsageError):
                keeler.set_threads(wrong)


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


class Errors(unittest.TestCase):
    def test_four_kinds_of_one_base(self):
        for kind, code, python in [
            (keeler.UsageError, 2, ValueError), (keeler.InvariantError, 3, ArithmeticError),
            (keeler.IoError, 4, OSError), (keeler.RunError, 1, RuntimeError),
        ]:
            self.assertTrue(issubclass(kind, keeler.Error) and issubclass(kind, python))
            self.assertEqual(kind.exit_code, code)


if __name__ == "__main__":
    unittest.main()
