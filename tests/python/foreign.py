"""What tests of snapshots that others changed share."""

import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py

KEELER = os.environ["KEELER_PROGRAM"]
SANITIZED = "asan" in os.environ.get("LD_PRELOAD", "")  # each start of the program takes ten times as long

SCENE = """
planet.preset = "saturn-a-ring"
box.size = [30.0, 30.0]
particles = { optical_depth = 0.3, density = 450.0, sizes = { law = "equal", radius = 1.0 } }
collisions = { restitution = { law = "constant", value = 0.5 } }
time = { step = 2e-3, end = 0.004 }
"""


def keeler(*arguments):
    return subprocess.run([KEELER, *map(str, arguments)], capture_output=True, timeout=60)


class Foreign(unittest.TestCase):
    """A snapshot to change, and the commands that must refuse it."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        cls.scene, cls.whole, cls.file = (cls.folder / name for name in ("scene.toml", "whole.hdf", "changed.hdf"))
        cls.scene.write_text(SCENE)
        assert keeler("generate", cls.scene, "-o", cls.whole).returncode == 0

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def refused(self, code, words):
        """By all that read snapshots of others."""
        commands = (("run", self.scene, "--from", self.file, "-o", self.folder / "run"), ("analyze", self.file),
                    ("render", self.file, "-o", self.folder / "picture.png"))
        for command in commands[:1] if SANITIZED else commands:  # the reading is the same
            done = keeler(*command)
            lines = [line for line in done.stderr.decode().splitlines() if "replaces it" not in line]
            self.assertEqual((done.returncode, len(lines)), (code, 1), (command[0], lines[:3]))
            self.assertIn(words, lines[0])
            self.assertIn("changed.hdf", lines[0])
        self.assertFalse((self.folder / "picture.png").exists())
        self.assertFalse((self.folder / "run").exists())

    def change(self, how):
        shutil.copy(self.whole, self.file)
        with h5py.File(self.file, "r+") as file:
            how(file, file["PartType1"])

    def replace(self, name, make):
        """The dataset, and the second name that ParaView knows it by."""

        def how(file, part):
            count = part[name].shape[0]
            del file["VTKHDF"]
            del part[name]
            make(part, count)

        self.change(how)
