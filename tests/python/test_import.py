"""`import keeler` without what it needs: one line that says what is missing and what to do."""

import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import keeler

PACKAGE = Path(keeler.__file__).parent


class Import(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name) / "keeler"
        self.folder.mkdir()
        for source in PACKAGE.glob("*.py"):
            shutil.copy(source, self.folder)

    def said(self, before="pass"):
        """The last line of an import from a folder that holds the Python files alone."""
        code = f"import sys; sys.path.insert(0, {str(self.folder.parent)!r}); {before}; import keeler"
        done = subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True, check=False)
        self.assertNotEqual(done.returncode, 0)
        return done.stderr.splitlines()[-1]

    def test_the_compiled_part_is_not_built(self):
        line = self.said()
        self.assertIn(f"the compiled part of keeler is not built in {self.folder}", line)
        self.assertIn("cmake --build build/default --target keeler_python", line)

    def test_the_compiled_part_is_for_another_python(self):
        (self.folder / "_core.cpython-20-none.so").touch()
        self.assertIn(f"for another Python than {sys.executable}: _core.cpython-20-none.so", self.said())

    def test_numpy_is_missing(self):
        self.assertIn(f"keeler needs numpy, and {sys.executable} has none", self.said("sys.modules['numpy'] = None"))


if __name__ == "__main__":
    unittest.main()
