"""Other processes, copies, memory: what is not inherited says so, nothing leaks, nothing is printed."""

import copy
import gc
import multiprocessing
import os
import pickle
import resource
import select
import signal
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import keeler
from scenes import RING, ring


def run(seed):
    return keeler.Simulation(RING, particles={"seed": seed}).run(0.05).state_hash


def refused(seed):
    try:
        run(seed)
    except keeler.RunError as error:
        return str(error)
    return "it ran"


def looked_at(what):
    """What a fork says to a look at large states that it inherited."""
    try:
        what()
    except keeler.RunError as error:
        return str(error)
    return "it looked"


def of_commands_with(word):
    """The processes whose command line has it."""
    found = []
    for process in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{process}/cmdline", "rb") as file:
                if os.fsencode(word) in file.read():
                    found.append(process)
        except OSError:
            pass
    return found


def resident_mb():
    with open("/proc/self/statm", encoding="ascii") as statm:
        return int(statm.read().split()[1]) * resource.getpagesize() / 1e6


class Processes(unittest.TestCase):
    def test_a_fork_says_no_once_keeler_has_computed(self):
        run(1)
        with multiprocessing.get_context("fork").Pool(1) as pool:
            self.assertIn("forked", pool.map(refused, [1])[0])

    def test_each_look_at_an_inherited_state_says_no(self):
        friction = {"restitution": {"law": "constant", "value": 0.5}, "friction": {"tangential_restitution": 0.5}}
        sim = keeler.Simulation(ring(box={"size": [250.0, 250.0]}, collisions=friction)).run(0.004)
        snapshot = sim.snapshot()
        looks = {
            "positions": lambda: sim.positions, "spins": lambda: sim.spins, "hash": lambda: sim.state_hash,
            "snapshot": sim.snapshot, "velocities": lambda: snapshot.velocities, "analyze": snapshot.analyze,
            "plot": snapshot.plot, "tile": lambda: snapshot.tile(2, 1), "run": sim.step,
        }
        sim._motion = None
        for name, look in looks.items():
            read, write = os.pipe()
            child = os.fork()
            if child == 0:
                os.write(write, looked_at(look).encode())
                os._exit(0)
            os.close(write)
            with self.subTest(name), os.fdopen(read) as said:
                ready = select.select([said], [], [], 20.0)[0]
                if not ready:
                    os.kill(child, signal.SIGKILL)
                os.waitpid(child, 0)
                self.assertTrue(ready, "it hangs")
                self.assertIn("forked", said.read())

    def test_spawned_processes_compute(self):
        with multiprocessing.get_context("spawn").Pool(2) as pool:
            self.assertEqual(pool.map(run, [1, 2]), [run(1), run(2)])

    def test_a_fork_before_anything_was_computed_computes(self):
        code = ("import multiprocessing, test_processes as t\n"
                "with multiprocessing.get_context('fork').Pool(2) as pool: print(len(set(pool.map(t.run, [1, 2]))))")
        said = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True, check=True,
                              cwd=os.path.dirname(os.path.abspath(__file__)), timeout=120)
        self.assertEqual((said.stdout, said.stderr), ("2\n", ""))

    def test_pickles_and_copies_go_on_to_the_bit(self):
        sim = keeler.Simulation(ring(gravity={"solver": "tree"})).run(0.05)
        others = [pickle.loads(pickle.dumps(sim)), copy.copy(sim), copy.deepcopy(sim)]
        sim.run(0.1)
        for other in others:
            self.assertEqual(other.run(0.1).state_hash, sim.state_hash)

    def test_the_interpreter_ends_while_daemon_threads_compute(self):
        program = """if True:
            import atexit, sys, threading, time
            sys.path.insert(0, sys.argv[1])
            late = []
            atexit.register(lambda: print(len(late[0].step())))  # after Keeler's own: the main thread may compute
            import keeler
            from scenes import RING, ring
            late.append(keeler.Simulation(RING))
            large = ring(box={"size": [300.0, 300.0]}, time={"step": 5e-4, "end": 500.0})
            sims = [keeler.Simulation(large) for _ in range(2)]
            work = [sims[0].run, lambda: [sims[1].step() for _ in range(10**6)],
                    lambda: [keeler.generate(large) for _ in range(10**6)]]
            for each in work:
                threading.Thread(target=each, daemon=True).start()
            time.sleep(0.3)
        """
        here = os.path.dirname(os.path.abspath(__file__))
        for _ in range(5):
            ended = subprocess.run(
                [sys.executable, "-c", program, here], capture_output=True, text=True, timeout=60, check=False
            )
            self.assertEqual((ended.returncode, ended.stderr), (0, ""))
            self.assertGreater(int(ended.stdout), 100)

    def test_runs_of_the_program_end_with_the_interpreter(self):
        """A daemon thread waits for one; its temporary folder goes too."""
        program = """if True:
            import sys, threading, time
            from pathlib import Path
            import keeler
            sys.path.insert(0, sys.argv[1])
            from scenes import ring
            large = ring(box={"size": [300.0, 300.0]}, time={"step": 5e-4, "end": 500.0})
            calls = {"run": lambda folder: keeler.run(large, folder),
                     "sweep": lambda folder: keeler.sweep({"scene": large, "seeds": [1]}, folder)}
            folder = Path(sys.argv[2]) / sys.argv[3]
            threading.Thread(target=calls[sys.argv[3]], args=[folder], daemon=True).start()
            while not list(folder.glob("**/series.csv")):
                time.sleep(0.02)
        """
        here = os.path.dirname(os.path.abspath(__file__))
        with tempfile.TemporaryDirectory() as place:
            temporary = os.path.join(place, "temporary")
            os.mkdir(temporary)
            for kind in ("run", "sweep"):
                ended = subprocess.run(
                    [sys.executable, "-c", program, here, place, kind], capture_output=True, text=True, timeout=60,
                    check=False, env={**os.environ, "TMPDIR": temporary},
                )
                self.assertEqual((ended.returncode, ended.stderr), (0, ""))
                self.assertEqual(of_commands_with(place), [])
                self.assertEqual(os.listdir(temporary), [])

    def test_nothing_is_printed_unasked(self):
        code = ("import keeler, scenes\n"
                "sim = keeler.Simulation(scenes.RING).run(); sim.analyze(); sim.plot()\n"
                "keeler.generate(scenes.RING).tile(2, 2)")
        said = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True, check=True,
                              cwd=os.path.dirname(os.path.abspath(__file__)), timeout=120)
        self.assertEqual((said.stdout, said.stderr), ("", ""))

    def test_progress_when_asked(self):
        code = "import keeler, scenes; keeler.Simulation(scenes.RING).run(progress=True)"
        said = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True, check=True,
                              cwd=os.path.dirname(os.path.abspath(__file__)), timeout=120)
        self.assertIn("100 %  orbit 0.2", said.stderr)
        self.assertEqual(said.stdout, "")


class Memory(unittest.TestCase):
    def test_ten_thousand_simulations_made_and_dropped(self):
        few = ring(box={"size": [12.0, 12.0]})
        scene = keeler.Simulation(few).scene
        start = keeler.generate(few)

        def make(count):
            for _ in range(count):
                sim = keeler.Simulation(scene, start=start)
                kept = [sim.elements, sim.ids, sim.positions]
                sim.step()
                del sim
                del kept
            gc.collect()

        make(1000)
        before = resident_mb()
        make(int(os.environ.get("KEELER_SIMULATIONS", "10000")))
        self.assertLess(resident_mb() - before, 8.0)  # less than 1 kB each

    def test_references_are_given_back(self):
        sim = keeler.Simulation(RING)
        before = sys.getrefcount(sim), sys.getrefcount(sim._core)
        for _ in range(100):
            sim.elements, sim.masses, sim.snapshot(), sim.analyze()
            with sim.collisions() as contacts:
                sim.step()
                contacts()
            del contacts
            with self.assertRaises(keeler.UsageError):
                sim.run(-1.0)
        self.assertEqual((sys.getrefcount(sim), sys.getrefcount(sim._core)), before)

    def test_a_view_outlives_its_simulation(self):
        sim = keeler.Simulation(RING)
        elements, wanted = sim.elements, np.array(sim.elements)
        del sim
        gc.collect()
        keeler.Simulation(RING, particles={"seed": 5}).run(0.05)
        np.testing.assert_array_equal(elements, wanted)


if __name__ == "__main__":
    unittest.main()
