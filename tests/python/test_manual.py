"""The manual's pages on Python: their code runs, in order, and prints what the comments beside its prints say."""

import contextlib
import io
import os
import re
import shutil
import sys
import tempfile
import types
import unittest
import warnings
from importlib.util import find_spec
from pathlib import Path
from unittest import mock

import keeler
import stand_in

MANUAL = Path(os.environ["KEELER_SOURCE_DIR"]) / "docs" / "manual"


class Manual(unittest.TestCase):
    def run_page(self, name):
        """Runs the blocks of a page in one namespace and a temporary folder."""
        page = (MANUAL / name).read_text(encoding="utf-8")
        blocks = re.findall(r"```python\n(.*?)```", page, re.S)
        self.assertGreater(len(blocks), 1)
        names, before = {}, os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                for block in blocks:
                    printed = io.StringIO()
                    with contextlib.redirect_stdout(printed):
                        exec(compile(block, name, "exec"), names)
                    said = re.findall(r"^ *print\(.*\)  # (.+)$", block, re.M)
                    self.assertEqual(printed.getvalue().splitlines(), said, block)
            finally:
                os.chdir(before)

    @unittest.skipUnless(shutil.which("cc"), "no C compiler")
    @unittest.skipUnless(keeler._core.can_trace(), "this Keeler was built without Embree")
    @unittest.skipUnless(find_spec("pandas") and find_spec("xarray"), "no pandas or no xarray")
    def test_python(self):
        self.run_page("python.md")

    def test_python_for_rebound_users(self):
        package = types.ModuleType("rebound")
        package.Simulation = stand_in.Rebound4
        with mock.patch.dict(sys.modules, rebound=package), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # on what from_rebound leaves out, as the page says
            self.run_page("python-for-rebound-users.md")


if __name__ == "__main__":
    unittest.main()
