"""The manual's pages on Python: their code runs, in order, and prints what the comments beside its prints say."""

import contextlib
import io
import os
import re
import shutil
import tempfile
import unittest
from pathlib import Path

MANUAL = Path(os.environ["KEELER_SOURCE_DIR"]) / "docs" / "manual"


class Manual(unittest.TestCase):
    def run_page(self, name):
        """Runs the blocks of a page in one namespace and a temporary folder; those of other packages are left out."""
        page = (MANUAL / name).read_text(encoding="utf-8")
        blocks = [block for block in re.findall(r"```python\n(.*?)```", page, re.S) if "rebound" not in block]
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
    def test_python(self):
        self.run_page("python.md")

    def test_python_for_rebound_users(self):
        self.run_page("python-for-rebound-users.md")


if __name__ == "__main__":
    unittest.main()
