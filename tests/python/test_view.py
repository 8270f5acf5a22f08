"""keeler view and Simulation.view(): a watched run has the bits of one that nobody watches, and its buttons do what they say."""

import json
import os
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

import h5py
import numpy as np

import keeler
from views import KEELER, SCENE, Viewed, ask, in_folder


def watch(view, frames):
    """Asks for frames of all fields and for the plots until the run has ended. It is slow until six states have been seen."""
    have = {}
    view.get("limit?steps_per_second=20", "POST")
    while True:
        if len({frame["orbits"] for frame, _ in frames}) >= 6:
            view.get("limit?steps_per_second=0", "POST")
        for colour in ("height", "size", "speed", "spin", "cluster", "density"):
            head, data = view.frame(colour, have.get(colour, 0))
            if head["stage"] == "finished":
                return
            if "frame" in head:
                have[colour] = head["number"]
                frames.append((head["frame"], data))
        view.get("plots")


class Bits(unittest.TestCase):
    def test_a_watched_run_has_the_bits_of_another(self):
        folder = in_folder(self)
        done = subprocess.run([KEELER, "run", folder / "scene.toml", "-o", folder / "alone", "--json"], capture_output=True, text=True)
        frames = []
        with Viewed(folder / "scene.toml", "-o", folder / "watched") as view:
            watch(view, frames)
        self.assertEqual(view.process.returncode, 0, view.err)
        summary = json.loads((folder / "watched/summary.json").read_text())
        self.assertEqual(summary["state_hash"], json.loads(done.stdout)["state_hash"])
        self.assertEqual((folder / "watched/series.csv").read_text(), (folder / "alone/series.csv").read_text())
        self.assertEqual({frame["field"] for frame, _ in frames}, {"height", "size", "speed", "spin", "cluster", "density"})
        self.assertGreater(len({frame["orbits"] for frame, _ in frames}), 5)

    def test_a_paused_and_stopped_run_goes_on_to_the_same_bits(self):
        folder = in_folder(self)
        whole = keeler.Simulation(folder / "scene.toml").run().state_hash
        with Viewed(folder / "scene.toml", "-o", folder / "run") as view:
            view.wait_for(lambda state: state["orbits"] > 0.1)
            view.get("pause", "POST")
            time.sleep(0.2)
            before = view.state()["orbits"]
            for k in range(1, 4):
                view.get("step", "POST")
                state = view.wait_for(lambda state: state["orbits"] > before + 0.002 * (k - 0.5))
                self.assertAlmostEqual(state["orbits"], before + 0.002 * k)
            head = view.shown("cluster")  # another colour, of a run that stands
            self.assertAlmostEqual(head["frame"]["orbits"], before + 0.006)
            view.get("limit?steps_per_second=20", "POST")
            view.get("resume", "POST")
            begin, slow = time.monotonic(), view.state()["orbits"]
            time.sleep(1.0)
            steps, elapsed = (view.state()["orbits"] - slow) / 0.002, time.monotonic() - begin
            self.assertLessEqual(steps, 20 * elapsed + 2)  # on any machine; a slow one makes fewer
            self.assertGreaterEqual(steps, 3)
            view.get("stop", "POST")
            view.process.wait(30)
        self.assertEqual(view.process.returncode, 75, view.err)
        self.assertIn(f'continue with "keeler view {folder / "run"} --resume"', view.err)
        with Viewed(folder / "run", "--resume") as view:
            view.wait_for(lambda state: state["stage"] == "finished")
        self.assertEqual(json.loads((folder / "run/summary.json").read_text())["state_hash"], whole)

    def test_ctrl_c(self):
        """A pause does not keep a signal waiting. Without -o nothing is left."""
        folder = in_folder(self)
        places = {**os.environ, "TMPDIR": str(folder)}
        with Viewed(folder / "scene.toml", env=places) as view:
            view.wait_for(lambda state: state["stage"] == "running")
            view.get("pause", "POST")
            self.assertTrue(list(folder.glob("keeler-run-*/scene.toml")))
        self.assertEqual(view.process.returncode, 0, view.err)
        self.assertEqual([path.name for path in folder.iterdir()], ["scene.toml"])


class Files(unittest.TestCase):
    def test_snapshots(self):
        """The places of a frame are those of the file; a folder shows all its snapshots and its series."""
        folder = in_folder(self)
        run = keeler.run(folder / "scene.toml", folder / "run")
        with Viewed(folder / "run") as view:
            state = view.state()
            self.assertEqual((state["stage"], state["control"], len(state["snapshots"])), ("files", False, 6))
            newest, data = view.frame("spin")
            with h5py.File(folder / "run/snap_000005.hdf") as file:
                places, radii = file["PartType1/Coordinates"][:], file["PartType1/Radius"][:]
            numbers = np.frombuffer(data[: 8 * len(radii)], "<u2").reshape(-1, 4)
            about = newest["frame"]
            found = np.array(about["low_m"]) + numbers[:, :3] * np.array(about["unit_m"][:3])
            self.assertLessEqual(np.max(np.abs(found - places) / about["unit_m"][:3]), 0.6)
            self.assertLessEqual(np.max(np.abs(numbers[:, 3] * about["unit_m"][3] - radii) / about["unit_m"][3]), 0.6)
            body = view.get("past?k=0&colour=speed")
            first = json.loads(body[4 : 4 + int.from_bytes(body[:4], "little")])
            self.assertEqual(first["frame"]["orbits"], 0.0)
            plots = json.loads(view.get("plots"))["plots"]
            self.assertIn("Scale height", [plot["title"] for plot in plots])
        with Viewed(folder / "run/snap_000002.hdf") as view:
            self.assertAlmostEqual(view.frame()[0]["frame"]["orbits"], run.snapshots[2].orbits)

    def test_refusals(self):
        folder = in_folder(self)
        (folder / "empty").mkdir()
        (folder / "full").mkdir()
        keeler.Simulation(folder / "scene.toml").save(folder / "full/checkpoint.h5")
        for arguments, message in (
            ([folder / "absent.toml"], "absent.toml"),
            ([folder / "empty"], "log.jsonl is missing"),
            ([folder / "empty", "-o", folder / "x"], "--output is for a scene"),
            ([folder / "scene.toml", "--resume"], "--resume continues a run"),
            ([folder / "scene.toml", "--port", "99999"], "is not a port from 1 to 65535"),
            ([folder / "scene.toml", "-o", ""], "is empty"),
            ([folder / "scene.toml", "-o", folder / "full"], "is not empty"),
            ([folder / "full/checkpoint.h5"], "is not a Keeler snapshot but a checkpoint"),
        ):
            done = subprocess.run([KEELER, "view", *map(str, arguments)], capture_output=True, text=True, timeout=60)
            self.assertIn(done.returncode, (2, 4), done)
            self.assertIn(message, done.stderr)
            self.assertEqual((done.stderr.count("\n"), done.stdout), (1, ""))  # no address

    def test_open(self):
        """The browser gets the address by a file that nobody else reads."""
        folder = in_folder(self)
        (folder / "xdg-open").write_text('#!/bin/sh\nstat -c %a "$(dirname "$1")" >"$0.mode"; cp "$1" "$0.page"\n')
        (folder / "xdg-open").chmod(0o755)
        with Viewed(folder / "scene.toml", "--open", env={**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"}) as view:
            end = time.monotonic() + 10
            while not (folder / "xdg-open.page").exists() and time.monotonic() < end:
                time.sleep(0.05)
            time.sleep(0.2)
            self.assertIn(f"url={view.address}", (folder / "xdg-open.page").read_text())
            self.assertEqual((folder / "xdg-open.mode").read_text(), "700\n")


class InPython(unittest.TestCase):
    def test_bits_and_buttons(self):
        alone = keeler.Simulation(SCENE).run()
        sim = keeler.Simulation(SCENE)
        with sim.view() as view:
            self.assertEqual(sim.view().address, view.address)
            self.assertEqual(ask(view, "state")["stage"], "idle")
            self.assertEqual(ask(view, "frame?colour=speed")["frame"]["orbits"], 0.0)
            sim.step(3)
            self.assertAlmostEqual(ask(view, "frame?colour=density")["frame"]["orbits"], 0.006)
            seen, ends = set(), threading.Event()

            def look():
                while not ends.is_set():
                    head = ask(view, "frame?colour=speed")
                    ask(view, "plots")
                    seen.add(head.get("frame", {}).get("orbits"))

            thread = threading.Thread(target=look)
            thread.start()
            sim.run()
            while len(seen) <= 4 and sim.orbits < 20.0:  # where the machine is slow to show it
                sim.run(sim.orbits + 0.1)
            ends.set()
            thread.join()
            self.assertGreater(len(seen), 4)
            self.assertGreater(len(ask(view, "plots")["plots"]), 5)
            with sim.edit() as state:
                state.velocities[:, 2] += 1e-6
            number = ask(view, "frame?colour=speed")["number"]
            self.assertGreater(ask(view, f"frame?colour=height&have={number}")["number"], number)
        self.assertEqual(keeler.Simulation(SCENE).run().state_hash, alone.state_hash)
        watched = keeler.Simulation(SCENE)
        watched.view()
        self.assertEqual(watched.run().state_hash, alone.state_hash)
        with self.assertRaises(ConnectionError):
            ask(view, "state")

    def test_pause_and_stop(self):
        sim = keeler.Simulation(SCENE)
        with sim.view() as view:
            ask(view, "pause", "POST")
            timer = threading.Timer(0.5, ask, (view, "stop", "POST"))
            timer.start()
            with self.assertRaisesRegex(KeyboardInterrupt, "stopped from the view"):
                sim.run()
            self.assertEqual(sim.orbits, 0.0)
            timer.join()
            timer = threading.Timer(0.3, view.close)  # a closed page keeps nothing waiting
            timer.start()
            sim.step()
            self.assertAlmostEqual(sim.orbits, 0.002)
            timer.join()

    def test_errors(self):
        sim = keeler.Simulation(SCENE)
        for arguments in ({"port": -1}, {"port": "x"}, {"port": 70000}):
            with self.assertRaises(keeler.UsageError):
                sim.view(**arguments)
        with self.assertRaises(keeler.UsageError):
            sim.widget(height=0)
        with sim.view() as view, self.assertRaisesRegex(keeler.RunError, "no view at port"):
            keeler.Simulation(SCENE).view(port=int(view.address.split(":")[2].split("/")[0]))
        with sim.view() as view:
            port = int(view.address.split(":")[2].split("/")[0])
            self.assertEqual(sim.view(port=port).address, view.address)
            with self.assertRaisesRegex(keeler.UsageError, f"open at the port {port}, not {port - 1}; close"):
                sim.view(port=port - 1)

    def test_the_interpreter_ends_and_forks(self):
        """Also with an open page, and while another thread computes."""
        text = """
import os, threading, keeler
sim = keeler.Simulation({scene!r})
view = sim.view()
sim.step()
child = os.fork()
if child == 0:
    sim.view
    view.close()
    raise SystemExit(0)
assert os.waitpid(child, 0)[1] == 0
threading.Thread(target=sim.run, args=(1000,), daemon=True).start()
print(view.address)
"""
        for _ in range(3):
            done = subprocess.run(["/usr/bin/python3", "-c", text.format(scene=SCENE)], capture_output=True, text=True, timeout=60)
            self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
