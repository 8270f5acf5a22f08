"""A simulation in memory: its scene, its arrays, its course, errors."""

import gc
import os
import signal
import threading
import time
import unittest

import numpy as np

import keeler
from scenes import RING, ring


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

    def test_an_example_is_a_scene_by_its_name(self):
        scene = keeler.Simulation("a-ring-wakes", box={"size_in_wavelengths": [1, 1]}).scene
        self.assertIn('title = "A-ring wakes"', scene)
        with self.assertRaisesRegex(keeler.UsageError, "did you mean 'a-ring-wakes'"):
            keeler.Simulation("a-ring-wake")

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
