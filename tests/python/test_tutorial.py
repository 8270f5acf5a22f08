"""The tutorial: a reader who does what it says, in one folder and in its order, gets what it says. The questions and answers
of the manual go on from its run."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import keeler

DOCS = Path(os.environ["KEELER_SOURCE_DIR"]) / "docs"


class Tutorial(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.environment = dict(os.environ, PATH=f"{Path(keeler.program()).parent}:{os.environ['PATH']}")

    def do(self, *arguments):
        done = subprocess.run(
            arguments, cwd=self.folder, env=self.environment, capture_output=True, text=True, check=False
        )
        self.assertEqual(done.returncode, 0, f"{arguments}: {done.stderr}")
        return done.stdout

    def follow(self, kind, block):
        if kind == "sh":
            return self.do("bash", "-e", "-c", block.replace("tuned.toml --orbits 1", "tuned.toml --orbits 0.3"))  # it takes a third of the time
        if kind == "python":
            return self.do(sys.executable, "-c", block)
        if kind == "toml":
            (self.folder / re.match(r"# (\S+)\n", block)[1]).write_text(block, encoding="utf-8")
        return None

    def test_all(self):
        page = (DOCS / "tutorial.md").read_text(encoding="utf-8")
        blocks = re.findall(r"```(\w+)\n(.*?)```", page[page.index("## Your first patch") :], re.S)
        self.assertGreater(len(blocks), 8)
        printed = ""
        for kind, block in blocks:
            if kind == "text":  # what the command before it prints: its words, whose numbers hang on the compiler
                for line in block.splitlines():
                    if line == "…":  # left out
                        continue
                    self.assertIn(re.split(r"  +", line)[0], printed)
            else:
                printed = self.follow(kind, block) or ""
        for name in re.findall(r"`([a-z-]+/?[a-z-]*\.(?:png|csv|hdf))`", page):
            self.assertTrue((self.folder / name).exists() or list(self.folder.glob(f"*/{name}")), name)
        questions = (DOCS / "manual" / "faq.md").read_text(encoding="utf-8")
        for kind, block in re.findall(r"```(\w+)\n(.*?)```", questions, re.S):
            self.follow(kind, block)


if __name__ == "__main__":
    unittest.main()
