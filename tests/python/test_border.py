"""What crosses the border between Python and the compiled part: wrong arguments, odd names, pipes, no text of a library."""

import os
import stat
import tempfile
import threading
import unittest
from pathlib import Path

import keeler
from scenes import ring

LIBRARIES = ("pybind", "std::", "incompatible", "json.exception", "filesystem error", "H5", "basic_string", "keeler._core", "bad_alloc")


class Border(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.sim = keeler.Simulation(ring())
        cls.start = keeler.generate(ring())

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def refused(self, kind, words, call):
        with self.assertRaises(kind) as raised:
            call()
        said = str(raised.exception)
        self.assertIn(words, said)
        self.assertNotIn("\n", said)
        for library in LIBRARIES:
            self.assertNotIn(library, said)

    def test_arguments_of_another_type_are_refused_in_one_line(self):
        sim, start = self.sim, self.start
        calls = {
            "save": lambda: sim.save(5),
            "save ": lambda: start.save(None),
            "load": lambda: keeler.load(5),
            "resume": lambda: keeler.resume(None),
            "analyze": lambda: keeler.Run.analyze(type("Other", (), {"folder": 5})(), "x"),
            "from_arrays": lambda: keeler.from_arrays(ring(), [[0.0, 0.0, 0.0]], 1.0, relax="perhaps"),
            "add_restitution_law": lambda: keeler.add_restitution_law(5, 4096),
            "save  ": lambda: start.plot(width=200).save(5),
        }
        for name, call in calls.items():
            with self.subTest(name):
                self.refused(keeler.UsageError, f"{name.strip()} cannot take ", call)

    def test_what_is_no_path_is_refused_before_any_work(self):
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(self.folder)
        grid = {"scene": ring(), "seeds": [1]}
        calls = {
            "run": lambda path: keeler.run(ring(), path),
            "sweep": lambda path: keeler.sweep(grid, path),
            "sweep ": lambda path: keeler.sweep(path, "sweep"),
            "sweep  ": lambda path: keeler.sweep({**grid, "scene": path or 5}, "sweep"),
            "Run": keeler.Run,
            "read": keeler.read,
            "read ": keeler.render,
            "read  ": lambda path: keeler.tile(path, 2, 2),
            "read   ": lambda path: keeler.Simulation(ring(), start=path or 5),
            "read    ": lambda path: keeler.run(ring(), "run", start=path or 5),
            "load": keeler.load,
            "resume": keeler.resume,
            "save": self.sim.save,
            "save ": self.start.save,
            "save  ": keeler.Picture(b"").save,
            "plot": lambda path: self.start.plot(path or 5),
        }
        for name, call in calls.items():
            for path in (None, 5, [], b"bytes", "", "a\0b", "\ud800"):
                with self.subTest(name, path=path):
                    self.refused(keeler.UsageError, f"{name.strip()} cannot take ", lambda: call(path))
        self.assertEqual(os.listdir(), [])
        for scene in (None, 5, [], b"bytes", "", "a\0b", "\ud800"):
            with self.subTest("scene", scene=scene):
                self.refused(keeler.UsageError, "a scene cannot ", lambda: keeler.generate(scene))

    def test_texts_and_numbers_that_no_scene_can_have(self):
        for words, call in (
            ("title has half of a character", lambda: keeler.generate(ring(), title="\udc80")),
            ("title has half of a character", lambda: keeler.generate(ring(title="\udc80"))),
            ("the scene has half of a character", lambda: keeler.generate('title = "\udc80"\n')),
            ("has half of a character", lambda: keeler.generate(ring(), **{"ti\udc80": 1})),
            ("has half of a character", lambda: keeler.sweep({"scene": ring(), "title": "\udc80"}, self.folder / "sweep")),
            ("particles.seed is a number of more than 300", lambda: keeler.generate(ring(), particles={"seed": 10**5000})),
            ("time in orbits", lambda: self.sim.run(10**5000)),
            ("minimum_speed is 'fast'", lambda: self.sim.collisions("fast").__enter__()),
        ):
            with self.subTest(words):
                self.refused(keeler.UsageError, words, call)
        with self.assertRaisesRegex(keeler.UsageError, "cannot read the scene '/dev/zero': it is too large"):
            keeler.generate("/dev/zero")

    def test_names_that_are_no_utf8_and_names_that_cannot_be(self):
        odd = os.fsdecode(os.fsencode(self.folder) + b"/caf\xe9.h5")
        self.sim.save(odd)
        self.assertEqual(keeler.load(odd).state_hash, self.sim.state_hash)
        self.refused(keeler.IoError, "caf?", lambda: keeler.load(odd + "x"))
        scene = Path(odd).with_suffix(".toml")
        scene.write_text(self.sim.scene)
        self.assertEqual(keeler.Simulation(scene).state_hash, self.sim.state_hash)
        keeler.run(scene, self.folder / "run")
        keeler.from_arrays(str(scene), [[0, 0, 0]], 1.0)
        scene.write_text("[box]\nsize = 1\n")
        self.refused(keeler.UsageError, "caf?.toml:2:8", lambda: keeler.Simulation(scene))
        self.refused(keeler.Error, "n" * 50, lambda: self.sim.save(self.folder / ("n" * 300)))

    def test_a_working_folder_that_is_gone(self):
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        gone = self.folder / "gone"
        gone.mkdir()
        os.chdir(gone)
        gone.rmdir()
        self.refused(keeler.IoError, "No such file or directory", lambda: self.sim.save("state.h5"))

    def test_what_a_run_left_and_others_changed(self):
        keeler.run(ring(), self.folder / "run")
        broken = [b"{", b"\xff", b"[" * 100000, b'{"a":' + b"1" * 10000 + b"}", b"[]", b"NaN", b'{"a": NaN}', b""]
        for name, content in [("scene.toml", b"\xff"), *(("summary.json", content) for content in broken)]:
            (self.folder / "run" / name).write_bytes(content)
            of = "summary" if name == "summary.json" else "scene"
            self.refused(keeler.IoError, name, lambda of=of: getattr(keeler.read(self.folder / "run"), of))

    def test_tables_of_a_sweep_that_others_changed(self):
        table = self.folder / "sweep.csv"
        for content in (b"", b"\xff", b"a,b\n1\n", b"a,b\n1,2,3\n", b"a\n" + b"x" * 200000 + b"\n"):
            table.write_bytes(content)
            with self.subTest(content[:10]):
                self.refused(keeler.IoError, "sweep.csv", lambda: keeler.runs._rows(table))
        table.write_text('run,value,steady\r\n"a",0.5,true\r\nb,,false\r\n')
        rows = [{"run": "a", "value": 0.5, "steady": True}, {"run": "b", "value": None, "steady": False}]
        self.assertEqual(keeler.runs._rows(table), rows)

    def test_pipes_are_written_to_where_the_format_allows_it(self):
        pipe, got = self.folder / "pipe", []
        os.mkfifo(pipe)
        reader = threading.Thread(target=lambda: got.append(pipe.read_bytes()), daemon=True)
        reader.start()
        picture = self.start.plot(pipe, width=400)
        reader.join(20.0)
        self.assertEqual(got, [picture.data])
        self.refused(keeler.UsageError, "cannot take HDF5", lambda: self.start.save(pipe))
        self.refused(keeler.UsageError, "cannot take HDF5", lambda: self.sim.save(pipe))
        self.assertTrue(stat.S_ISFIFO(pipe.stat().st_mode))

    def test_planted_links_are_not_followed_and_permissions_stay(self):
        victim = self.folder / "victim"
        victim.write_text("of another")
        file = self.folder / "state.h5"
        Path(f"{file}.tmp").symlink_to(victim)
        for write in (self.sim.save, self.start.save):
            write(file)
            file.chmod(0o600)
        picture = self.folder / "picture.png"
        picture.symlink_to(victim)
        self.start.plot(picture, width=400)
        self.assertEqual(stat.S_IMODE(file.stat().st_mode), 0o600)
        self.assertEqual(victim.read_text(), "of another")


if __name__ == "__main__":
    unittest.main()
