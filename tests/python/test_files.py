"""What Python writes and reads, against the program: states, snapshots, series, sweeps, pictures."""

import json
import pickle
import os
import resource
import signal
import subprocess
import sys
import time
import tempfile
import unittest
import warnings
from pathlib import Path

import numpy as np

import keeler
from scenes import RING, ring


def program(*arguments):
    done = subprocess.run([keeler.program(), *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(f"keeler {arguments}: {done.stderr}")
    return done.stdout


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def scene_file(self, sim):
        file = self.folder / "scene.toml"
        file.write_text(sim.scene)
        return file


class AsTheProgram(InAFolder):
    SCENES = {
        "collisions": ring(),
        "gravity by tree": ring(gravity={"solver": "tree", "kick_every": 2}),
        "gravity by mesh": ring(gravity={"solver": "fft"}),
        "friction": ring(collisions={"friction": {"tangential_restitution": 0.5}}),
        "automatic step": ring(gravity={"solver": "tree"}, time={"step": "auto", "end": 0.125}),
    }

    def test_the_same_bits_and_the_same_numbers(self):
        for name, scene in self.SCENES.items():
            with self.subTest(name):
                sim = keeler.Simulation(scene)
                run = self.folder / name
                program("run", self.scene_file(sim), "-o", run)
                sim.run()
                self.assertEqual(sim.state_hash, keeler.read(run).summary["state_hash"])
                last = keeler.read(run).snapshots[-1]
                for field in ("positions", "radii", "masses", "ids"):
                    np.testing.assert_array_equal(getattr(last, field), getattr(sim.snapshot(), field))
                np.testing.assert_allclose(last.velocities, sim.snapshot().velocities, rtol=1e-15)
                said = json.loads(program("analyze", run / "snap_000001.hdf", "--json"))
                mine = sim.analyze()
                self.assertEqual(list(mine), list(said))
                for key in ("particle_count", "optical_depth", "toomre_q", "wake_contrast", "largest_overlap"):
                    self.assertAlmostEqual(mine[key], said[key], places=12)

    def test_a_saved_state_goes_on_here_and_there(self):
        sim = keeler.Simulation(ring(gravity={"solver": "tree", "kick_every": 2})).run(0.1)
        run = self.folder / "run"
        run.mkdir()
        sim.save(run / "checkpoint_000000.h5")
        loaded, resumed = keeler.load(run / "checkpoint_000000.h5"), keeler.resume(run)
        self.assertEqual(loaded.state_hash, sim.state_hash)
        program("resume", run)
        end = sim.run().state_hash
        self.assertEqual(loaded.run().state_hash, end)
        self.assertEqual(resumed.run().state_hash, end)
        self.assertEqual(keeler.read(run).summary["state_hash"], end)

    def test_resume_tells_of_an_edited_scene(self):
        run = keeler.run(RING, self.folder / "run")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            keeler.resume(run.folder)
        edited = run.scene.replace("end = 0.2", "end = 0.6")
        (run.folder / "scene.toml").write_text(edited)
        with self.assertWarnsRegex(UserWarning, "was edited, .* --until 0.6") as caught:
            self.assertAlmostEqual(keeler.resume(run.folder).orbits, 0.2)
        self.assertEqual(caught.filename, __file__)
        self.assertEqual(run.scene, edited)
        newest = max(run.folder.glob("checkpoint_*.h5"))
        (run.folder / "checkpoint_999999.h5").write_bytes(newest.read_bytes()[:-10])
        with self.assertWarnsRegex(UserWarning, "checkpoint_999999.h5"):
            keeler.resume(run.folder)

    def test_a_run_read(self):
        run = self.folder / "run"
        sim = keeler.Simulation(RING, output={"series_every": 0.02, "snapshot_every": 0.1})
        program("run", self.scene_file(sim), "-o", run)
        read = keeler.read(run)
        self.assertEqual(len(read.series["time_orbits"]), 11)
        np.testing.assert_allclose(read.series["time_orbits"], np.arange(11) * 0.02, atol=1e-12)
        self.assertEqual([snapshot.orbits for snapshot in read.snapshots], [0.0, 0.1, 0.2])
        self.assertEqual(len(read.snapshots[1:]), 2)
        self.assertEqual(read.scene, sim.scene)
        said = json.loads(program("analyze", run, "--since", 0.1, "--json"))
        self.assertEqual(read.analyze(since=0.1), said)
        with self.assertRaises(keeler.UsageError):
            read.analyze(since=5.0)
        with self.assertRaises(keeler.IoError):
            read.moonlets
        with self.assertRaisesRegex(keeler.IoError, "holds no run"):
            keeler.read(self.folder)
        with self.assertRaises(keeler.IoError):
            keeler.read(self.folder / "nothing")

    def test_a_run_with_a_folder(self):
        run = keeler.run(RING, self.folder / "run", time={"end": 0.1}, output={"series_every": 0.01})
        self.assertEqual(run.summary["state_hash"], keeler.Simulation(RING).run(0.1).state_hash)
        self.assertIsNotNone(run.analyze(since=0.0)["total_viscosity_m2_s"])
        self.assertEqual(run.summary.quantity("wall_s").unit, "s")
        numbers = run.analyze(since=0.0)
        self.assertEqual(numbers.error("total_viscosity_m2_s"), numbers["total_viscosity_error_m2_s"])
        in_radii = numbers["total_viscosity_r2_omega"] / numbers["total_viscosity_m2_s"]
        self.assertEqual(
            numbers.error("total_viscosity_r2_omega"), numbers["total_viscosity_error_m2_s"] * in_radii
        )
        self.assertIsNone(numbers.error("toomre_q"))
        self.assertEqual(numbers.quantity("total_viscosity_r2_omega").unit, "r² Ω")
        with self.assertRaisesRegex(keeler.UsageError, "no number 'toomreq'"):
            numbers.quantity("toomreq")
        plain = {name for name in keeler.quantities() if "." not in name and "spin" not in name}
        self.assertEqual(plain - set(numbers), set())  # spins are of scenes with friction
        with self.assertRaisesRegex(keeler.UsageError, "is not empty"):
            keeler.run(RING, self.folder / "run")
        again = keeler.run(RING, self.folder / "run", force=True, time={"end": 0.05})
        self.assertAlmostEqual(again.summary["time_orbits"], 0.05)

    def test_ctrl_c_leaves_a_checkpoint(self):
        code = ("import keeler, sys; keeler.run(sys.argv[1], sys.argv[2], time={'end': 500.0},"
                " output={'series_every': 0.01})")
        scene = self.scene_file(keeler.Simulation(ring(box={"size": [200.0, 200.0]})))
        run = self.folder / "run"
        with subprocess.Popen([sys.executable, "-c", code, scene, run], stderr=subprocess.DEVNULL) as process:
            series = run / "series.csv"
            for _ in range(2400):  # until it has a row after its start's
                if process.poll() is not None or (series.exists() and series.read_text().count("\n") > 2):
                    break
                time.sleep(0.05)
            process.send_signal(signal.SIGINT)
        self.assertEqual(process.returncode, -signal.SIGINT)
        self.assertGreater(keeler.resume(run).orbits, 0.0)

    def test_a_sweep(self):
        grid = self.folder / "grid.toml"
        self.scene_file(keeler.Simulation(RING))
        grid.write_text('scene = "scene.toml"\nseeds = [1, 2]\n'
                        '[[axis]]\nkey = "collisions.restitution.value"\nvalues = [0.3, 0.6]\n')
        tables = keeler.sweep(grid, self.folder / "sweep")
        self.assertEqual([row["seed"] for row in tables["runs"]], [1.0, 2.0, 1.0, 2.0])
        self.assertEqual([row["finished_runs"] for row in tables["points"]], [2.0, 2.0])
        grid.write_text("scene = 3\n")
        with self.assertRaises(keeler.UsageError):
            keeler.sweep(grid, self.folder / "other")


class Starts(InAFolder):
    def test_generate_and_tile(self):
        start = keeler.generate(RING)
        self.assertEqual(len(start), len(keeler.Simulation(RING)))
        tiled = keeler.tile(start, 2, 3)
        self.assertEqual((len(tiled), tiled.box), (6 * len(start), (120.0, 180.0)))
        start.save(self.folder / "start.hdf")
        program("tile", self.folder / "start.hdf", 2, 3, "-o", self.folder / "tiled.hdf")
        np.testing.assert_array_equal(tiled.positions, keeler.read(self.folder / "tiled.hdf").positions)
        tiled.save(self.folder / "by_hand.hdf")
        self.assertIn(str(self.folder / "by_hand.hdf"), keeler.read(self.folder / "by_hand.hdf").scene)
        copied = pickle.loads(pickle.dumps(tiled))
        self.assertEqual(copied.scene, tiled.scene)
        copied.save(self.folder / "copied.hdf")
        self.assertIn(str(self.folder / "copied.hdf"), keeler.read(self.folder / "copied.hdf").scene)
        sim = keeler.Simulation(RING, start=tiled)
        self.assertEqual(len(sim), len(tiled))
        self.assertEqual(sim.state_hash, keeler.Simulation(tiled.scene, start=tiled).state_hash)

    def test_arrays_of_ones_own(self):
        places = np.array([[-10.0, 0.0, 0.0], [10.0, 5.0, 1.0]])
        sim = keeler.from_arrays(RING, places, 1.5)
        np.testing.assert_allclose(sim.by_id(sim.positions), places, atol=1e-12)
        circular = np.column_stack([[0, 0], -1.5 * sim.orbital_frequency * places[:, 0]])
        np.testing.assert_allclose(sim.by_id(sim.velocities)[:, :2], circular, rtol=2e-2, atol=1e-9)
        sim.run(0.1)
        spin = [[0.0, 0.0, 1e-4], [1e-5, 0.0, 0.0]]
        rough = ring(collisions={"friction": {"tangential_restitution": 0.5}})
        np.testing.assert_allclose(keeler.from_arrays(rough, places, 1.5, spins=spin).spins, spin, atol=1e-19)
        with self.assertRaises(keeler.UsageError):
            keeler.from_arrays(RING, places, 1.5, spins=spin)
        overlapping = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]
        with self.assertRaises(keeler.InvariantError):
            keeler.from_arrays(RING, overlapping, 1.0)
        apart = keeler.from_arrays(RING, overlapping, 1.0, relax=True).positions
        self.assertGreaterEqual(np.linalg.norm(apart[0] - apart[1]), 2.0)
        for wrong in (
            dict(positions=places, radii=-1.0), dict(positions=places[0], radii=1.0),
                      dict(positions=places, radii=[1.0]), dict(positions=places * np.nan, radii=1.0),
                      dict(positions=1e6 * places, radii=1.0), dict(positions=np.zeros((0, 3)), radii=1.0)):
            with self.assertRaises(keeler.UsageError) as caught:
                keeler.from_arrays(RING, **wrong)
            self.assertNotIn("\n", str(caught.exception))

    def test_starts_far_from_any_ring_are_warned_of(self):
        scene = ring(box={"size": [200.0, 200.0]})
        sim = keeler.Simulation(scene)
        places, velocities = sim.by_id(sim.positions), sim.by_id(sim.velocities)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            keeler.from_arrays(scene, places, 1.0, velocities)
        no_shear = velocities + np.outer(1.5 * sim.orbital_frequency * places[:, 0], [0.0, 1.0, 0.0])
        for words, arrays in [
            ("lack the shear", (places, 1.0, no_shear)),
            ("are positions and the box in m", (1e-3 * places, 1e-3, 1e-3 * velocities)),
        ]:
            for make in (keeler.from_arrays, keeler.start_from_arrays):
                with self.assertWarnsRegex(UserWarning, words) as caught:
                    make(scene, *arrays)
                self.assertEqual(caught.filename, __file__)

    def test_masks_are_not_lost(self):
        places = np.array([[-10.0, 0.0, 0.0], [10.0, 5.0, 1.0]])
        masked = np.ma.array(places, mask=[[False] * 3, [False, True, False]])
        one_radius = np.ma.array([1.5, 1e20], mask=[False, True])
        for wrong in (
            dict(positions=masked, radii=1.5), dict(positions=list(masked), radii=1.5),
            dict(positions=places, radii=one_radius), dict(positions=places, radii=1.5, velocities=masked),
            dict(positions=places, radii=1.5, masses=one_radius),
        ):
            with self.assertRaisesRegex(keeler.UsageError, "masked"):
                keeler.from_arrays(RING, **wrong)
        whole = keeler.from_arrays(RING, np.ma.array(places), np.ma.array([1.5, 1.5]))
        np.testing.assert_allclose(whole.by_id(whole.positions), places, atol=1e-12)
        np.testing.assert_array_equal(whole.by_id(np.ma.array(whole.ids, mask=whole.ids == 1)).mask, [False, True])
        with self.assertRaisesRegex(keeler.UsageError, "box.size has 1 masked"):
            keeler.Simulation(RING, box={"size": np.ma.array([60.0, 60.0], mask=[True, False])})

    def test_what_convert_wrote_is_taken_whole(self):
        sim = keeler.Simulation(RING).run(0.15)
        with tempfile.TemporaryDirectory() as folder:
            saved, converted = f"{folder}/snap.hdf", f"{folder}/snap.npz"
            sim.snapshot().save(saved)
            subprocess.run([os.environ["KEELER_PROGRAM"], "convert", saved, "--to", "npz", "-o", converted], check=True, capture_output=True)
            arrays = dict(np.load(converted))
        self.assertGreater(arrays["shear_offset"], 0.0)
        start = keeler.start_from_arrays(RING, **arrays)
        np.testing.assert_array_equal(start.positions, sim.snapshot().positions)
        order = np.random.default_rng(1).permutation(len(start))
        for name in ("positions", "velocities", "radii", "masses", "ids"):
            arrays[name] = arrays[name][order]
        np.testing.assert_array_equal(keeler.start_from_arrays(RING, **arrays).positions, start.positions)
        with self.assertRaisesRegex(keeler.InvariantError, "that pair meets across an edge of the box: is the shear offset"):
            keeler.start_from_arrays(RING, **{**arrays, "shear_offset": 0.0})

    def test_arrays_that_hold_something_else(self):
        places = np.array([[-10.0, 0.0, 0.0], [10.0, 5.0, 1.0]])

        class InKilometres(np.ndarray):
            unit = "km"

        structured = np.zeros(2, dtype=[("x", float), ("y", float), ("z", float)])
        for words, wrong in (
            ("ids are 2 whole numbers", dict(positions=places, radii=1.5, ids=[1, 1])),
            ("ids are 2 whole numbers", dict(positions=places, radii=1.5, ids=[1, 2, 3])),
            ("box is", dict(positions=places, radii=1.5, box=[60.0, -1.0])),
            ("set box.size = ", dict(positions=places, radii=1.5, box=[60.0, 61.0])),
            ("velocities are for Omega", dict(positions=places, radii=1.5, orbital_frequency=1e-4)),
            ("^unknown key|^speeds", dict(positions=places, radii=1.5, speeds=1.0)),
            ("positions has the type", dict(positions=structured, radii=1.5)),
            ("positions has the type", dict(positions=places.astype(str), radii=1.5)),
            ("positions has the type", dict(positions=places + 1j, radii=1.5)),
            ("positions has entries that are no", dict(positions=np.array([[0.0, {}, 0.0]]), radii=1.5)),
            ("radii has entries that are no", dict(positions=places, radii=np.array([{}, 1.0]))),
            ("velocities has ", dict(positions=places, radii=1.5, velocities=[[0.0], [0.0, 1.0]])),
            ("masses has entries that are no", dict(positions=places, radii=1.5, masses=[10**400, 1])),
            ("positions has the unit 'km'; give numbers in SI, here m", dict(positions=places.view(InKilometres), radii=1.5)),
        ):
            with self.subTest(words), self.assertRaisesRegex(keeler.UsageError, words) as caught:
                keeler.from_arrays(RING, **wrong)
            self.assertNotIn("\n", str(caught.exception))
        InKilometres.unit = "m"
        for right in (places.astype(object), places.astype("float32"), places.view(InKilometres)):
            np.testing.assert_array_equal(keeler.start_from_arrays(RING, right, 1.5).positions, places)
        sim = keeler.from_arrays(RING, places, 1.5)
        with self.assertRaisesRegex(keeler.UsageError, "radii has entries that are no"):
            with sim.edit() as state:
                state.radii = np.array([{}, 1.0])

    def test_sizes_are_bounded(self):
        start = keeler.generate(RING)
        for width in (20000, 199, -1, 1e3, 2**40, "wide", None):
            with self.assertRaisesRegex(keeler.UsageError, "width is .* from 200 to 8000"):
                start.plot(width=width)
        for copies in (0, -1, 1.5, 10**5, 2**70):
            with self.assertRaises(keeler.UsageError):
                start.tile(copies, 1)
        if "asan" in os.environ.get("LD_PRELOAD", ""):  # that sanitizer takes terabytes of addresses itself
            return
        soft, hard = resource.getrlimit(resource.RLIMIT_AS)
        self.addCleanup(resource.setrlimit, resource.RLIMIT_AS, (soft, hard))
        resource.setrlimit(resource.RLIMIT_AS, (6 * 10**9, hard))  # whatever the machine has
        with self.assertRaisesRegex(keeler.UsageError, "GB of memory"):
            keeler.tile(keeler.from_arrays(RING, [[0.0, 0.0, 0.0]], 1.0).snapshot(), 9999, 9999)
        with self.assertRaisesRegex(keeler.UsageError, "GB of memory"):
            keeler.Simulation(RING, particles={"optical_depth": 0.3}, box={"size": [1e5, 1e5]})
        with self.assertRaisesRegex(keeler.UsageError, "too short"):
            keeler.Simulation(RING, gravity={"solver": "axisymmetric", "shortest_wavelength": 1e-18})

    def test_pictures(self):
        sim = keeler.Simulation(RING)
        picture = sim.plot(self.folder / "ring.png", width=400)
        self.assertEqual((self.folder / "ring.png").read_bytes(), picture.data)
        self.assertTrue(sim._repr_png_().startswith(b"\x89PNG"))
        self.assertEqual(keeler.render(sim.snapshot(), width=400).data, picture.data)
        run = keeler.run(RING, self.folder / "run", start=sim, time={"end": 0.002})
        np.testing.assert_allclose(run.snapshots[0].positions, sim.snapshot().positions, rtol=0.0, atol=1e-12)
        self.assertEqual(keeler.render(run, width=400).data, keeler.render(run.snapshots[-1], width=400).data)

    def test_faults_of_files(self):
        (self.folder / "damaged.hdf").write_bytes(b"nothing")
        with self.assertRaises(keeler.IoError):
            keeler.read(self.folder / "damaged.hdf")
        with self.assertRaises(OSError):
            keeler.load(self.folder / "none.h5")
        with self.assertRaises(keeler.IoError):
            keeler.resume(self.folder)
        with self.assertRaises(keeler.IoError):
            keeler.Simulation(RING).save(self.folder / "no" / "folder.h5")


if __name__ == "__main__":
    unittest.main()
