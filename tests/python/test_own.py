"""Physics of one's own from Python: forces, size laws, starts and numbers, in scenes, runs, checkpoints and restarts."""

import ctypes
import gc
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import traceback
import unittest
from pathlib import Path

import keeler
import numpy as np
from scenes import RING, ring

RATE = {"rate": keeler.Key(1e-5, "1/s", "gamma of the drag -gamma c", low=0.0)}


def drag(kick, accelerations):
    accelerations[:] = -kick.keys["rate"] * kick.velocities_beyond_shear


def outward(kick, accelerations):
    accelerations[:, 0] = 1e-9


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)


class Forces(Folder):
    def test_a_constant_force_is_the_built_in_one_to_the_bit_and_its_work_is_booked(self):
        keeler.add_force("outward", outward)
        own = keeler.Simulation(RING, outward={}).run(0.2)
        built_in = keeler.Simulation(RING, constant_acceleration={"radial": 1e-9}).run(0.2)
        self.assertTrue(np.array_equal(own.by_id(own.elements), built_in.by_id(built_in.elements)))
        self.assertNotEqual(own.work_by_force["outward"], 0.0)
        self.assertEqual(own.work_by_force["outward"], built_in.work_by_force["constant_acceleration"])
        self.assertEqual(keeler.Simulation(RING).work_by_force, {})

    def test_what_a_kick_shows_is_the_state_at_that_kick(self):
        kicks = []
        keeler.add_force("looking", lambda kick, accelerations: kicks.append((
            kick.orbits, kick.positions, kick.velocities, kick.velocities_beyond_shear, kick.masses, kick.radii, kick.ids,
            kick.box, kick.shear_offset, kick.interval, kick.keys, len(kick), kick.orbital_frequency)))
        sim = keeler.Simulation(RING, looking={}).run(0.1)
        orbits, x, v, c, m, r, ids, box, offset, interval, keys, count, omega = kicks[-1]
        self.assertEqual(len(kicks), 51)  # one of the start, then one a step
        self.assertAlmostEqual(orbits, 0.1)
        order, now = np.argsort(ids), np.argsort(sim.ids)
        self.assertTrue(np.array_equal(x[order], sim.positions[now]))  # a kick of nothing changes no bit
        self.assertTrue(np.array_equal(v[order], sim.velocities[now]))
        kappa = float(re.search(r"epicyclic_ratio = (\S+)", sim.scene)[1])
        shear = (4.0 - kappa**2) / 2.0
        np.testing.assert_allclose(c, v + [0.0, shear * omega, 0.0] * x[:, [0]], rtol=1e-9, atol=1e-15)
        self.assertTrue(np.array_equal(m[order], sim.masses[now]) and np.array_equal(r[order], sim.radii[now]))
        self.assertEqual((box, offset, keys, count), (sim.box, sim.shear_offset, {}, len(sim)))
        self.assertAlmostEqual(interval, 2e-3 * 2.0 * np.pi / omega)
        for array in (x, v, c, m, r, ids):
            self.assertFalse(array.flags.writeable)

    def test_arrays_that_are_kept_never_change_and_others_cost_no_memory(self):
        kept, addresses = [], set()

        def keeps(kick, accelerations):
            if not kept:
                kept.extend([kick.positions, kick.positions.copy(), accelerations])
            addresses.add(kick.velocities.ctypes.data)

        keeler.add_force("keeps", keeps)
        sim = keeler.Simulation(RING, keeps={}).run(0.1)
        self.assertTrue(np.array_equal(kept[0], kept[1]))
        self.assertLessEqual(len(addresses), 2)
        kept[2][:] = np.nan  # the first kick's, which is over
        sim.run(0.11)
        del sim
        gc.collect()
        self.assertTrue(np.array_equal(kept[0], kept[1]))

    def test_a_kick_that_is_over_says_so(self):
        kicks = []
        keeler.add_force("late", lambda kick, accelerations: kicks.append((kick, kick.radii)))
        keeler.Simulation(RING, late={})
        self.assertEqual(len(kicks[0][0].radii), 344)  # asked for in time
        for name in ("positions", "orbits", "ids", "box"):
            with self.assertRaisesRegex(keeler.UsageError, "this kick is over"):
                getattr(kicks[0][0], name)

    def test_keys_are_checked_hashed_and_stored(self):
        keeler.add_force("drag", drag, RATE)
        hashes = [keeler.Simulation(RING, drag=table).state_hash for table in
                  ({}, {"rate": 1e-5}, {"rate": 2e-5}, {"version": 2})]
        self.assertEqual(hashes[0], hashes[1])
        self.assertEqual(len(set(hashes)), 3)
        self.assertIn("\n[drag]\nrate = 1e-05\nversion = 1\n", keeler.Simulation(RING, drag={}).scene)
        for table, message in (({"rat": 1.0}, 'unknown key drag.rat .* did you mean "rate"'),
                               ({"rate": -1.0}, "drag.rate is -1.0, but must be a number from 0 up .gamma of the drag"),
                               ({"rate": "much"}, "drag.rate")):
            with self.assertRaisesRegex(keeler.UsageError, message):
                keeler.Simulation(RING, drag=table)
        keeler.add_force("needy", drag, {"rate": keeler.Key()})
        with self.assertRaisesRegex(keeler.UsageError, "rate is missing"):
            keeler.Simulation(RING, needy={})

    def test_a_restart_is_the_same_to_the_bit_beside_self_gravity_and_after_an_edit(self):
        keeler.add_force("drag", drag, RATE)
        scene = ring(gravity={"solver": "fft", "kick_every": 2}, drag={"rate": 3e-5})
        sim = keeler.Simulation(scene).run(0.1)
        with sim.edit() as state:
            state.velocities[:, 2] *= 1.5
        sim.save("half.h5")
        whole = sim.run(0.2).state_hash
        self.assertEqual(keeler.load("half.h5").run(0.2).state_hash, whole)
        keeler.set_threads(3)
        self.addCleanup(keeler.set_threads, 1)
        self.assertEqual(keeler.load("half.h5").run(0.2).state_hash, whole)

    def test_a_process_without_the_function_refuses_the_checkpoint_and_the_program_does_too(self):
        keeler.add_force("drag", drag, RATE)
        Path("run").mkdir()
        keeler.Simulation(RING, drag={}).run(0.1).save("run/checkpoint_000000.h5")
        code = "import keeler\ntry:\n  keeler.load('run/checkpoint_000000.h5')\nexcept keeler.Error as error:\n  print(error)"
        said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True,
                              env={**os.environ, "PYTHONPATH": str(Path(keeler.__file__).parent.parent)}).stdout
        self.assertIn("has drag, which this program does not know", said)
        resumed = subprocess.run([keeler.program(), "resume", "run"], capture_output=True, text=True, check=False)
        self.assertEqual(resumed.returncode, 2)
        self.assertIn("has drag, which this program does not know", resumed.stderr)

    def test_a_name_that_is_given_again_is_the_new_function_for_new_simulations(self):
        keeler.add_force("changing", outward)
        old = keeler.Simulation(RING, changing={})
        keeler.add_force("changing", drag, RATE)
        new = keeler.Simulation(RING, changing={"rate": 2e-5})
        kept = old.elements  # so that the simulation goes on with a copy, whose force is made again
        self.assertEqual(old.run(0.1).state_hash, old.state_hash)
        self.assertFalse(np.array_equal(kept, old.elements))
        keeler.add_force("same", outward)
        self.assertEqual(old.work_by_force["changing"], keeler.Simulation(RING, same={}).run(0.1).work_by_force["same"])
        self.assertLess(new.run(0.1).work_by_force["changing"], 0.0)

    def test_what_a_function_raises_ends_the_run_which_can_go_on(self):
        calls, how = [0], []

        def sometimes(kick, accelerations):
            calls[0] += 1
            if calls[0] == 20:
                how[0](sim)
            accelerations[:, 2] = 1e-9

        def fails(_):
            raise LookupError("no gas here")

        def kills(_):
            os.kill(os.getpid(), signal.SIGINT)

        keeler.add_force("sometimes", sometimes)
        straight = keeler.Simulation(RING, sometimes={})
        calls[0] = 100
        straight.run(0.2)
        for how[:], error, message in (([fails], LookupError, "no gas here"), ([kills], KeyboardInterrupt, ""),
                                       ([lambda sim: sim.positions], keeler.RunError, "is computing"),
                                       ([lambda sim: sim.run(1.0)], keeler.RunError, "is computing")):
            calls[0] = 100
            sim = keeler.Simulation(RING, sometimes={}).run(0.05)
            calls[0] = 0
            with self.assertRaisesRegex(error, message):
                try:
                    sim.run(0.2)
                except LookupError as raised:  # with the lines of the function
                    lines = traceback.extract_tb(raised.__traceback__)
                    self.assertEqual([line.name for line in lines[-2:]], ["sometimes", "fails"])
                    raise
            self.assertEqual(sim.run(0.2).state_hash, straight.state_hash)

    def test_another_simulation_can_run_within_a_force(self):
        inner = []

        def nested(kick, accelerations):
            if not inner:
                inner.append(0)
                inner[0] = keeler.Simulation(RING).run(0.02).state_hash

        keeler.add_force("nested", nested)
        keeler.Simulation(RING, nested={}).run(0.01)
        self.assertEqual(inner[0], keeler.Simulation(RING).run(0.02).state_hash)

    def test_what_a_function_writes_wrongly_is_refused(self):
        def spoils(kick, accelerations):
            accelerations[kick.ids == 7] = np.inf

        def returns(kick, accelerations):
            return -kick.velocities

        for function, message in ((spoils, "the force 'wrong' gives the particle 7 an acceleration that is not a finite"),
                                  (returns, r"the force 'wrong' returns a value, .* accelerations\[:\] = ")):
            keeler.add_force("wrong", function)
            with self.assertRaisesRegex(keeler.UsageError, message):
                keeler.Simulation(RING, wrong={})

        def changes(kick, accelerations):
            kick.positions[0] = 0.0

        keeler.add_force("wrong", changes)
        with self.assertRaisesRegex(ValueError, "read-only"):
            keeler.Simulation(RING, wrong={})

    def test_names_and_keys_that_cannot_be_are_refused(self):
        for arguments, message in ((("gas", drag), "there is a force 'gas' already"),
                                   (("box", drag), "scenes and runs use that name"),
                                   (("My drag", drag), "small letters"),
                                   ((7, drag), "name is 7; give a text"),
                                   (("d", 7), "7 is no function"),
                                   (("d", drag, [1]), "give a dictionary of names"),
                                   (("d", drag, {"rate": "x"}), "the key 'rate' has no numbers"),
                                   (("d", drag, {"rate": keeler.Key(1.0, low=2.0)}), "default 1.0, which is not from 2.0"),
                                   (("d", drag, {"version": 1.0}), "a key 'version'")):
            with self.assertRaisesRegex(keeler.UsageError, message):
                keeler.add_force(*arguments)


SOURCE = """
#include <math.h>
#include <stdint.h>
#define ARGUMENTS int64_t count, const double *x, const double *v, const double *c, const double *m, const double *r, \\
                  const uint64_t *ids, const double *kick, const double *keys, double *a
void drag(ARGUMENTS) { for (int64_t k = 0; k < 3 * count; ++k) a[k] = -keys[0] * c[k]; }
void all(ARGUMENTS) {
  for (int64_t k = 0; k < count; ++k) {
    a[3 * k] = 1e-9 * (x[3 * k] / kick[3] + v[3 * k + 1] / (kick[2] * kick[4]) + kick[0] + kick[5] / kick[4]);
    a[3 * k + 1] = 1e-9 * (m[k] * 1e-4 + r[k] + ids[k] * 1e-3);
    a[3 * k + 2] = keys[1] / kick[1];
  }
}
void spoils(ARGUMENTS) { for (int64_t k = 0; k < count; ++k) if (ids[k] == 5) a[3 * k + 1] = NAN; }
"""


def everything(kick, accelerations):
    x, y = kick.box
    accelerations[:, 0] = 1e-9 * (kick.positions[:, 0] / x + kick.velocities[:, 1] / (kick.orbital_frequency * y)
                                  + kick.orbits + kick.shear_offset / y)
    accelerations[:, 1] = 1e-9 * (kick.masses * 1e-4 + kick.radii + kick.ids * 1e-3)
    accelerations[:, 2] = kick.keys["b"] / kick.interval


@unittest.skipUnless(shutil.which("cc"), "no C compiler")
class CompiledForces(Folder):
    def setUp(self):
        super().setUp()
        Path("f.c").write_text(SOURCE, encoding="utf-8")
        subprocess.run(["cc", "-O2", "-ffp-contract=off", "-shared", "-fPIC", "-o", "f.so", "f.c", "-lm"], check=True)
        self.library = ctypes.CDLL("./f.so")

    def elements(self, function, keys, **table):
        keeler.add_force("either", function, keys)
        sim = keeler.Simulation(RING, either=table).run(0.05)
        return sim.by_id(sim.elements)

    def test_a_compiled_force_gets_the_arrays_that_it_reads(self):
        kind = ctypes.CFUNCTYPE(None, ctypes.c_int64, *[ctypes.c_void_p] * 9)
        given = []

        @kind
        def looks(count, *arrays):
            given.append([array is not None for array in arrays[:5]])

        keeler.add_force("looks", looks, reads=["masses", "velocities"])
        keeler.set_threads(1)
        keeler.Simulation(RING, looks={}).step()
        self.assertEqual(given[0], [False, True, False, True, False])
        for wrong in (["mass"], "masses", [3]):
            with self.assertRaisesRegex(keeler.UsageError, "is no array|reads is|an array"):
                keeler.add_force("looks", looks, reads=wrong)

    def test_a_compiled_force_is_that_of_python(self):
        self.assertTrue(np.array_equal(self.elements(self.library.drag, RATE, rate=3e-5),
                                       self.elements(drag, RATE, rate=3e-5)))
        keys = {"a": 2.0, "b": keeler.Key(1e-6, "m/s")}
        address = ctypes.cast(self.library.all, ctypes.c_void_p).value
        self.assertTrue(np.array_equal(self.elements(address, keys, b=1e-5), self.elements(everything, keys, b=1e-5)))

    def test_threads_change_no_bit_and_numbers_that_are_none_are_refused(self):
        self.addCleanup(keeler.set_threads, 1)
        one = self.elements(self.library.drag, RATE, rate=3e-5)
        keeler.set_threads(3)
        self.assertTrue(np.array_equal(one, self.elements(self.library.drag, RATE, rate=3e-5)))
        keeler.add_force("either", self.library.spoils)
        with self.assertRaisesRegex(keeler.UsageError, "gives the particle 5 an acceleration that is not a finite"):
            keeler.Simulation(RING, either={})


class Others(Folder):
    def test_a_size_law(self):
        keeler.add_size_law("triangle", lambda u, keys: 0.5 + keys["width"] * np.sqrt(u), {"width": keeler.Key(1.0, "m", low=0.1)})
        sim = keeler.Simulation(RING, particles={"sizes": {"law": "triangle", "width": 0.8}})
        self.assertTrue(0.5 < sim.radii.min() < 0.6 and 1.28 < sim.radii.max() < 1.3)
        self.assertAlmostEqual(sim.radii.mean(), 0.5 + 0.8 * 2.0 / 3.0, delta=1e-3)
        depth = np.sum(np.pi * sim.radii**2) / 3600.0
        self.assertAlmostEqual(depth, 0.3, delta=2e-3)  # the law's mean square, 0.5^2 + 2/3 0.8 + 0.8^2/2
        for function, message in ((lambda u, keys: 2.0 - u, "the size law 'wrong' gives the radius .* rise with the"),
                                  (lambda u, keys: u, "the radius 0 m at the quantile 0 "),
                                  (lambda u, keys: u[:3] + 1.0, "the size law 'wrong' returns has the shape .3,.")):
            keeler.add_size_law("wrong", function)
            with self.assertRaisesRegex(keeler.UsageError, message):
                keeler.Simulation(RING, particles={"sizes": {"law": "wrong"}})

    def test_a_start(self):
        asked = []

        def line(request):
            asked.append(request)
            places = np.zeros((len(request.radii), 3))
            places[:, 0] = request.keys["x"]
            places[:, 1] = np.linspace(-0.45, 0.45, len(places)) * request.box[1]
            return places, -1.5 * request.orbital_frequency * places[:, [0]] * [0.0, 1.0, 0.0]

        keeler.add_start("line", line, {"x": 2.0})
        particles = {"count": 10, "density": 450.0, "sizes": {"law": "equal", "radius": 1.0}}
        scene = ring(particles={**particles, "start": {"law": "line", "x": 3.0}}, planet={"orbital_frequency": 2e-4})
        sim = keeler.Simulation(scene)
        self.assertTrue(np.allclose(sim.by_id(sim.positions)[:, 0], 3.0))
        self.assertTrue(np.allclose(sim.by_id(sim.velocities), [0.0, -1.5 * 2e-4 * 3.0, 0.0]))
        self.assertEqual((asked[0].box, asked[0].orbital_frequency, asked[0].seed), ((60.0, 60.0), 2e-4, 1))
        self.assertEqual((asked[0].epicyclic_ratio, asked[0].vertical_ratio), (1.0, 1.0))
        for placed, message in ((3, "the start 'line' returns no pair"), (([1.0], [1.0]), "positions of the start 'line'")):
            keeler.add_start("line", lambda request, placed=placed: placed, {"x": 2.0})
            with self.assertRaisesRegex(keeler.UsageError, message):
                keeler.Simulation(scene)

    def test_a_quantity_is_in_what_analyze_returns(self):
        keeler.add_quantity("largest_height_m", "m", lambda snapshot: np.abs(snapshot.positions[:, 2]).max(), "largest |z|")
        sim = keeler.Simulation(RING).run(0.1)
        numbers = sim.analyze()
        self.assertAlmostEqual(numbers["largest_height_m"], np.abs(sim.positions[:, 2]).max(), places=12)
        self.assertEqual(numbers.quantity("largest_height_m")[1:3], ("m", "largest |z|"))
        self.assertIn("largest_height_m", keeler.quantities())
        with self.assertRaisesRegex(keeler.UsageError, "there is a quantity 'toomre_q'"):
            keeler.add_quantity("toomre_q", "", len)

    def test_a_run_with_own_physics_runs_here_with_all_files_and_goes_on(self):
        keeler.add_force("drag", drag, RATE)
        run = keeler.run(RING, "run", drag={"rate": 2e-5}, output={"snapshot_every": 0.1})
        self.assertEqual(run.summary["state_hash"], keeler.Simulation(RING, drag={"rate": 2e-5}).run(0.2).state_hash)
        self.assertEqual(len(run.snapshots), 3)
        self.assertLess(run.series["kick_work_j"][-1], 0.0)
        self.assertEqual(run.resume(0.3).summary["state_hash"],
                         keeler.Simulation(RING, drag={"rate": 2e-5}).run(0.3).state_hash)
        with self.assertRaisesRegex(keeler.UsageError, "'run' is not empty"):
            keeler.run(RING, "run", drag={})
        with self.assertRaisesRegex(keeler.UsageError, "unknown table drag"):  # the runs of a sweep are the program's
            keeler.sweep({"scene": {**RING, "drag": {"rate": 1e-5}}, "seeds": [1],
                          "axis": [{"key": "particles.optical_depth", "values": [0.2]}]}, "sweep")

    def test_ctrl_c_stops_a_run_of_this_process_with_a_checkpoint(self):
        calls = [0]

        def stops(kick, accelerations):
            calls[0] += 1
            if calls[0] == 30:
                os.kill(os.getpid(), signal.SIGINT)

        keeler.add_force("stops", stops)
        with self.assertRaises(KeyboardInterrupt):
            keeler.run(RING, "run", stops={})
        run = keeler.read("run").resume()
        calls[0] = 100
        self.assertEqual(run.summary["state_hash"], keeler.Simulation(RING, stops={}).run(0.2).state_hash)

    def test_an_own_start_and_a_column_in_a_run(self):
        code = """import keeler, numpy as np
from scenes import RING
keeler.add_series_column("mean_height_m", "m", lambda snapshot: np.abs(snapshot.positions[:, 2]).mean(), "mean of |z|")
start = keeler.generate(RING)
run = keeler.run(RING, "run", start=start)
print(abs(run.series["mean_height_m"][0] - np.abs(start.positions[:, 2]).mean()) < 1e-12)
"""
        environment = {**os.environ, "PYTHONPATH": f"{Path(__file__).parent}:{Path(keeler.__file__).parent.parent}"}
        ran = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True, check=False, env=environment)
        self.assertEqual((ran.stdout, ran.stderr), ("True\n", ""))


if __name__ == "__main__":
    unittest.main()
