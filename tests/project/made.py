#!/usr/bin/env python3
"""made.py SOURCE_DIR: what scripts/remake reads, fills in and refuses."""

import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(sys.argv.pop(1)) / "scripts"))

import made_pages  # noqa: E402
import made_parts  # noqa: E402
import made_values  # noqa: E402

PAGE = "Two of <!--made:pair.apart-->2.3<!--/--> m and <!--made:other.mass-->7<!--/--> kg.\n\n## A table\n\n<!--made:pair.table-->\n| a |\n<!--/-->\n\n## End\n"


class Marks(unittest.TestCase):
    def test_filled(self):
        new = made_pages.filled(PAGE, "pair", {"apart": lambda former: former + "1", "table": lambda former: former.upper()})
        self.assertEqual(new, PAGE.replace("2.3<", "2.31<").replace("| a |", "| A |"))
        self.assertEqual([mark[1:] for mark in made_pages.marks({"page": new})],
                         [("pair", "apart", "2.31"), ("other", "mass", "7"), ("pair", "table", "\n| A |\n")])

    def test_section(self):
        self.assertIn("| a |", made_pages.section(PAGE, "A table"))
        self.assertNotIn("End", made_pages.section(PAGE, "A table"))
        self.assertIsNone(made_pages.section(PAGE, "No table"))

    def test_faults(self):
        self.assertEqual(list(made_pages.faults_of_marks("page", PAGE)), [])
        for wrong in ("of <!--made:pair.apart-->2.3 m\n", "of 2.3<!--/--> m\n", "of <!-- made:pair.apart -->2.3<!--/--> m\n",
                      "<!--made:pair.apart-->2.3<!--/--> m apart\n", "    keeler <!--made:pair.apart-->2.3<!--/-->\n",
                      "```\na <!--made:pair.apart-->2.3<!--/-->\n```\n"):
            self.assertNotEqual(list(made_pages.faults_of_marks("page", wrong)), [], wrong)

    def test_lines(self):
        former = "```text\nsteps        2400\n…\nToomre Q     2.1\n```"
        self.assertEqual(made_pages.lines_like(former, "steps        2500\nother   3\nToomre Q     2.2\n"),
                         "```text\nsteps        2500\n…\nToomre Q     2.2\n```\n")
        with self.assertRaisesRegex(ValueError, "Toomre Q"):
            made_pages.lines_like(former, "steps        2500\n")


class Values(unittest.TestCase):
    def test_outputs(self):
        results = {"json": made_values.parsed('{"a": {"b": [1, -2.5]}}'), "csv": made_values.parsed("time_orbits,x\n0,3\n1,5\n2,4\n"),
                   "grid": made_values.parsed("particles.density,x\n300,3\n600,5\n"), "text": made_values.parsed("settled after 9.5 orbits\n")}
        for template, text in (("{json.a.b[1]:.1f} m", "−2.5 m"), ("{row_at(csv, 1.2).x:.0f}", "5"), ("{csv.x[-1] / csv.x[0]:.2f}", "1.33"),
                               ("{find('after ([0-9.]+)', text):g}", "9.5"), ("{listed(csv.x, '.0f')}", "3, 5 and 4"), ("{maxima(csv, 'x')[0][0]:g}", "1"),
                               ("{max(between(csv, 'x', 1.5, 2)):g}", "4"), ("{grid.x[1]:g}", "5")):
            self.assertEqual(made_values.printed(template, results), text)
        with self.assertRaisesRegex(AttributeError, "no member 'c'; there are a"):
            made_values.printed("{json.c}", results)


class Parts(unittest.TestCase):
    def test_contents(self):
        with tempfile.TemporaryDirectory() as folder:
            made_parts.SOURCE = Path(folder)
            (Path(folder) / "figure.png").write_bytes(b"1")
            entry = {"seconds": 1, "rests": ["group", "docs/x"], "steps": {"run": "true"}, "values": {"apart": ""}, "text": {"table": "run"},
                     "files": ["figure.png"]}
            part = made_parts.Part("pair", entry, {"group": ["core"]})
            self.assertEqual(part.rests, ["core", "docs/x"])
            made = part.contents({"page": PAGE})
            self.assertEqual(set(made), {"page", "figure.png"})
            self.assertEqual(made, part.contents({"page": PAGE.replace(">7<", ">8<")}))
            self.assertNotEqual(made, part.contents({"page": PAGE.replace("2.3", "2.4")}))
            self.assertNotEqual(made, part.contents({"page": PAGE.replace("| a |", "| b |")}))
            (Path(folder) / "figure.png").write_bytes(b"2")
            self.assertNotEqual(made, part.contents({"page": PAGE}))
        with self.assertRaisesRegex(made_parts.Stop, "'second'"):
            made_parts.Part("pair", entry | {"second": 1}, {})


if __name__ == "__main__":
    unittest.main()
