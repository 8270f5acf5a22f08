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
            "write_file": lambda: start.plot().save(5),
        }
        for name, call in calls.items():
            with self.subTest(name):
                self.refused(keeler.UsageError, f"{name.strip()} cannot take ", call)

    def test_names_that_are_no_utf8_and_names_that_cannot_be(self):
        odd = os.fsdecode(os.fsencode(self.folder) + b"/caf\xe9.h5")
        self.sim.save(odd)
        self.assertEqual(keeler.load(odd).state_hash, self.sim.state_hash)
        self.refused(keeler.IoError, "caf?", lambda: keeler.load(odd + "x"))
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
        for name, content in (("summary.json", b"{"), ("summary.json", b"\xff"), ("scene.toml", b"\xff")):
            (self.folder / "run" / name).write_bytes(content)
            of = "summary" if name == "summary.json" else "scene"
            self.refused(keeler.IoError, name, lambda of=of: getattr(keeler.read(self.folder / "run"), of))

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
