"""Snapshots that others changed: values that stand elsewhere or nowhere, and torn or flipped bytes are refused by one line,
soon, and nothing of them is taken."""

import os
import random
import subprocess
import unittest
from pathlib import Path

import h5py
import keeler as ring
import numpy as np
from foreign import KEELER, SANITIZED, SCENE, Foreign, keeler


class ForeignBytes(Foreign):
    def test_a_file_that_is_open_for_writing(self):
        """h5py holds a lock meanwhile; the file on the disk may be half of it."""
        self.change(lambda file, part: None)
        table = self.folder / "table.h5"
        with h5py.File(self.file, "r+") as file, h5py.File(table, "w") as particles:
            for name in "xyz":
                particles[name] = [0.0]
            particles["r"] = [1.0]
            file.flush()
            self.refused(4, "another program has it open for writing")
            done = keeler("generate", self.scene, "--from-table", table, "-o", self.folder / "none.hdf")
            self.assertEqual(done.returncode, 4)
            self.assertIn(b"another program has it open for writing", done.stderr)
        with h5py.File(self.file, "r"):  # to read beside a reader is no harm
            self.assertEqual(keeler("analyze", self.file).returncode, 0)

    def test_a_file_of_gadgets_own(self):
        """Each way in says what the file lacks and what can be done, and none sends it to the other."""
        gadget = self.folder / "gadget.hdf5"
        with h5py.File(gadget, "w") as file:
            file.create_group("Header").attrs["NumPart_ThisFile"] = [0, 1, 0, 0, 0, 0]
            for name, values in (("Coordinates", [[0.0, 0.0, 0.0]]), ("Masses", [1.0]), ("ParticleIDs", [1])):
                file[f"PartType1/{name}"] = values
        done = keeler("run", self.scene, "--from", gadget, "-o", self.folder / "run")
        self.assertEqual(done.returncode, 4)
        self.assertIn(b"it lacks /Code, /RingBox, /Parameters. To start from its particles, write their x, y, z", done.stderr)
        done = keeler("generate", self.scene, "--from-table", gadget, "-o", self.folder / "none.hdf")
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"it states no units; add UnitLength_in_cm", done.stderr)
        self.assertNotIn(b"--from", done.stderr)
        self.replace("Radius", lambda part, count: None)
        self.refused(4, "it lacks /PartType1/Radius")

    def test_no_particles(self):
        def how(file, part):
            del file["VTKHDF"]
            for name in list(part):
                shape, kind = (0,) + part[name].shape[1:], part[name].dtype
                del part[name]
                part.create_dataset(name, shape=shape, dtype=kind)
            for name in ("NumPart_ThisFile", "NumPart_Total"):
                file["Header"].attrs[name] = [0] * 6

        self.change(how)
        self.refused(2, "holds no particles")

    def test_values_that_stand_elsewhere(self):
        other = self.folder / "other"
        np.ones(1000).tofile(other)

        def virtual(part, count):
            layout = h5py.VirtualLayout(shape=(count,), dtype="f8")
            layout[:] = h5py.VirtualSource(str(self.whole), "PartType1/Radius", shape=(count,))
            part.create_virtual_dataset("Radius", layout)

        def link(part, _):
            part["Radius"] = h5py.ExternalLink(str(self.whole), "/PartType1/Radius")

        def storage(part, count):
            part.create_dataset("Radius", (count,), "f8", external=[(str(other), 0, 8 * count)])

        for make, words in ((virtual, "its values are stored in another file"), (storage, "its values are stored in another file"),
                            (link, "a link into another file")):
            with self.subTest(make.__name__):
                self.replace("Radius", make)
                self.refused(4, words)

    def test_more_than_the_file_can_hold(self):
        def how(file, part):
            del file["VTKHDF"]
            for name in list(part):
                shape, kind = (1 << 40,) + part[name].shape[1:], part[name].dtype
                del part[name]
                part.create_dataset(name, shape=shape, dtype=kind, chunks=(1024,) + shape[1:])

        self.change(how)
        self.refused(4, "it claims")

    def test_torn_and_flipped_bytes(self):
        """Without the seal, as another program leaves a file. What HDF5 does not notice may be taken where it is possible."""
        draw = random.Random(20)
        content = self.whole.read_bytes()[:-64]
        refused, files = 0, 200 // 6 if SANITIZED else 200
        for _ in range(files):
            torn = bytearray(content)
            for _ in range(draw.choice((1, 1, 2, 8))):
                torn[draw.randrange(len(torn))] = draw.randrange(256)
            if draw.random() < 0.2:
                torn = torn[: draw.randrange(len(torn))]
            self.file.write_bytes(torn)
            done = keeler("analyze", self.file)
            lines = done.stderr.decode().splitlines()
            if done.returncode != 0:
                refused += 1
                self.assertIn(done.returncode, (2, 3, 4), lines)
                self.assertEqual(len(lines), 1, lines[:3])
        self.assertGreater(refused, files // 4)

    def test_files_that_break_hdf5(self):
        """Found by the fuzzer: the library crashes on them in a child process, and that is all."""
        files = sorted((Path(os.environ["KEELER_SOURCE_DIR"]) / "tests/fuzz/corpus/foreign").glob("breaks-*"))
        self.assertGreater(len(files), 3)
        for file in files:
            with self.subTest(file.name):
                done = keeler("info", file)
                self.assertEqual((done.returncode, done.stderr.count(b"\n")), (4, 1), done.stderr)
                # as its memory lies
                self.assertRegex(done.stderr, b"the library breaks on it|its structures are damaged")
                with self.assertRaises(ring.IoError):
                    ring.read(file)

    def test_words_of_others_in_messages(self):
        long = self.folder / "long.toml"
        long.write_text(SCENE.replace('"constant"', '"' + "x" * 1_000_000 + '"'))
        done = keeler("check", long)
        self.assertEqual(done.returncode, 2)
        self.assertLess(len(done.stderr), 2100)
        done = subprocess.run([KEELER.encode(), b"check", str(self.scene).encode(), b"--set",
                               b'particles.density="\xff\x1b[31m"'], capture_output=True, timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertIn(b'"??[31m"', done.stderr)


if __name__ == "__main__":
    unittest.main()
