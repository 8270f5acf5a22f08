"""keeler report: what its page holds against the run's files, and what a browser makes of it, from a file, without a
network. The screenshots stand beside the tests that ran, to be looked at."""

import base64
import csv
import json
import os
import re
import subprocess
import struct
import tempfile
import unittest
import xml.etree.ElementTree
from pathlib import Path

import h5py
import numpy as np

from pages import RING, lit

KEELER = os.environ["KEELER_PROGRAM"]
SCREENSHOTS = Path(os.environ["KEELER_SCREENSHOTS"])
SNAPSHOTS, SHOWN = 6, 3  # that the run writes, that the view has

SCENE = RING + "output = { snapshot_every = 0.2, series_every = 0.002, stress_every = 0.02 }\n"


def keeler(*arguments):
    return subprocess.run([KEELER, *map(str, arguments)], capture_output=True, text=True, timeout=250)


def numbers(digits, dtype):
    return np.frombuffer(base64.b64decode(digits), dtype=dtype)


class Report(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.results = Path(cls.folder.name) / "run"
        scene = Path(cls.folder.name) / "scene.toml"
        scene.write_text(SCENE)
        for arguments in (("run", scene, "-o", cls.results), ("report", cls.results, "--snapshots", SHOWN)):
            done = keeler(*arguments)
            assert done.returncode == 0, done.stderr
        cls.page = (cls.results / "report.html").read_text()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def data(self, name):
        return json.loads(re.search(f'id="{name}-data">(.*?)</script>', self.page, re.S).group(1))

    def test_one_file(self):
        """Nothing is fetched: neither from a network nor from beside the page."""
        markup = re.sub(r"<(script|style)\b.*?</\1>", "", self.page, flags=re.S)
        for link in re.findall(r'(?:src|href)="([^"]*)"', markup):
            self.assertTrue(link.startswith("data:image/png;base64,"), link[:80])
        self.assertIn("A ring of &lt;/script&gt; &amp; spins", markup)
        for title in ("The patch", "In three dimensions", "Through time", "Measured", "Accuracy and cost",
                      "The scene", "Provenance"):
            self.assertIn(f"<h2>{title}</h2>", markup)

    def test_places_and_colours(self):
        view = self.data("view")
        files = [f"snap_{k:06d}.hdf" for k in (0, 2, 5)]  # evenly from the first to the last
        self.assertEqual([snapshot["file"] for snapshot in view["snapshots"]], files)
        fields = {field["name"]: field for field in view["fields"]}
        self.assertEqual(set(fields), {"speed", "cluster", "spin", "size"})
        unit = np.array(view["unit_m"])
        for k, shown in enumerate(view["snapshots"]):
            with h5py.File(self.results / shown["file"]) as file:
                part = file["PartType1"]
                places, radii, spins = part["Coordinates"][:], part["Radius"][:], part["Spins"][:, 2]
                omega = file["RingBox"].attrs["Omega"]
            self.assertEqual(view["count"], len(radii))
            found = np.array(view["low_m"]) + numbers(shown["places"], "<u2").reshape(3, -1).T * unit
            self.assertLessEqual(np.max(np.abs(found - places) / unit), 0.5 + 1e-6)
            np.testing.assert_array_equal(numbers(view["radii"], "<f4"), radii.astype("f4"))
            low, high = fields["spin"]["range"]["low"], fields["spin"]["range"]["high"]
            share = np.clip((spins / omega - low) / (high - low), 0.0, 1.0)
            self.assertLessEqual(np.max(np.abs(numbers(fields["spin"]["bytes"][k], "u1") - 255.0 * share)), 0.5 + 1e-6)

    def test_curves(self):
        with open(self.results / "series.csv") as file:
            rows = list(csv.DictReader(file))
        plots = self.data("series")["plots"]
        curves = {curve["name"]: np.array(curve["points"], dtype=float) for plot in plots for curve in plot["curves"]}
        time = np.array([float(row["time_orbits"]) for row in rows])
        height = np.array([float(row["scale_height_m"]) for row in rows])
        points = curves["√⟨z²⟩"]
        self.assertEqual(len(points), 200)
        edges = [k * len(rows) // 200 for k in range(201)]
        for k, (t, mean, error) in enumerate(points):
            part = slice(edges[k], edges[k + 1])
            self.assertAlmostEqual(t, time[part].mean(), places=10)
            self.assertAlmostEqual(mean, height[part].mean(), places=10)
            n = edges[k + 1] - edges[k]
            self.assertAlmostEqual(error, height[part].std(ddof=1) / np.sqrt(n), places=10)
        # The rate of a number that counts, over all of the run.
        collisions = curves["faster than v_cut"]
        self.assertAlmostEqual(np.mean(collisions[:, 1]) / (float(rows[-1]["collisions"]) / time[-1]), 1.0, delta=0.02)
        drawn = {name for name in rows[0]} - {"step", "time_orbits"}
        self.assertGreaterEqual(len(curves), len(drawn) - 2)  # two columns share nothing, the fluxes are viscosities

    def test_numbers_of_snapshots(self):
        """What `keeler analyze` tells of each snapshot of the view by itself may be an axis."""
        curves = {one["title"]: one["curves"][0]["points"] for one in self.data("series")["snapshots"]}
        told = [json.loads(keeler("analyze", self.results / f"snap_{k:06d}.hdf", "--json").stdout) for k in (0, 2, 5)]
        for name in ("scale_height_m", "filling_factor", "optical_depth", "clusters.count"):
            values = [one["clusters"]["count"] if name == "clusters.count" else one[name] for one in told]
            self.assertEqual(curves[name], [[one["time_orbits"], value, None] for one, value in zip(told, values)])
        self.assertEqual([value for _, value, _ in curves["dispersion_z_m_s"]], [one["dispersion_m_s"][2] for one in told])
        self.assertNotIn("radial_modes", curves)

    def test_units(self):
        page = self.results.parent / "units.html"
        self.assertEqual(keeler("report", self.results, "-o", page, "--units", "radius").returncode, 0)
        plots = {}
        for units, text in (("si", self.page), ("radius", page.read_text())):
            data = json.loads(re.search('id="series-data">(.*?)</script>', text, re.S).group(1))
            plots[units] = {plot["title"]: plot for plot in data["plots"]}
        last = json.loads(keeler("analyze", self.results / "snap_000005.hdf", "--json").stdout)
        speed = last["dispersion_m_s"][0] / last["dispersion_r_omega"][0]
        for title, unit, size in (("Velocity dispersion", "r Ω", speed), ("Viscosity", "r² Ω", speed * last["mean_radius_m"]),
                                  ("Scale height", "m", 1.0)):
            self.assertEqual(plots["radius"][title]["unit"], unit)
            found, si = (np.array(plots[units][title]["curves"][0]["points"], dtype=float)[:, 1] for units in ("radius", "si"))
            np.testing.assert_allclose(found * size, si, rtol=1e-12)
        self.assertIn("r² Ω</td>", page.read_text())
        self.assertNotIn("m²/s</td>", page.read_text())

    def test_series_figure(self):
        """The curves of `keeler render --series` are those of the page: places are linear in the numbers."""
        done = keeler("render", self.results, "--series", "--theme", "light")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout, f"{self.results / 'series.svg'}\n")
        drawing = xml.etree.ElementTree.parse(self.results / "series.svg").getroot()
        svg = "{http://www.w3.org/2000/svg}"
        words = drawing.find(svg + "desc").text.split("\n")
        self.assertIn("A ring of </script> & spins", words)
        lines = [np.array(re.findall(r"[ML] (\S+) (\S+)", path.get("d")), dtype=float)
                 for path in drawing.iter(svg + "path") if "stroke-width:1.8" in path.get("style", "")]
        plots = self.data("series")["plots"]
        for plot in plots:
            self.assertIn(f"{plot['title']} ({plot['unit']})" if plot["unit"] else plot["title"], words)
            for curve in plot["curves"]:
                found, points = lines.pop(0), np.array(curve["points"], dtype=float)
                self.assertTrue(any(word.startswith(curve["name"]) for word in words), curve["name"])
                # A curve has no point in the middle of a straight line.
                times = np.interp(found[:, 0], found[[0, -1], 0], points[[0, -1], 0])
                values = np.interp(times, points[:, 0], points[:, 1])
                places = np.polyval(np.polyfit(values, found[:, 1], 1), values)
                np.testing.assert_allclose(places, found[:, 1], rtol=0, atol=0.2)
        self.assertEqual(lines, [])

    def test_refusals(self):
        empty = Path(self.folder.name) / "empty"
        empty.mkdir(exist_ok=True)
        bare = Path(self.folder.name) / "bare"
        bare.mkdir(exist_ok=True)
        (bare / "log.jsonl").write_text("{}\n")
        for arguments, code, words in (
            ((empty,), 4, "log.jsonl is missing"),
            ((bare,), 4, "snap_NNNNNN.hdf is missing"),
            ((empty / "none",), 2, "not a folder"),
            ((self.results, "-o", self.results), 2, "is a folder"),
            ((self.results, "--snapshots", "0"), 2, "snapshots"),
            ((self.results, "-o", empty / "no" / "report.html"), 4, "no"),
        ):
            done = keeler("report", *arguments)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (code, 1), done.stderr)
            self.assertIn(words, done.stderr)
        self.assertEqual(list(empty.iterdir()), [])

    def test_run_without_its_end(self):
        """As a run looks that works still, or was killed."""
        summary = self.results / "summary.json"
        kept = summary.read_text()
        summary.unlink()
        try:
            page = self.results.parent / "broken.html"
            self.assertEqual(keeler("report", self.results, "-o", page, "--snapshots", 1).returncode, 0)
            self.assertIn("interrupted", page.read_text())
            self.assertIn("not known yet", page.read_text())
        finally:
            summary.write_text(kept)

    def test_browser(self):
        for program in ("/usr/bin/chromium", "/usr/bin/chromedriver"):
            self.assertTrue(Path(program).exists(), f"{program} is missing; scripts/setup test installs it")
        from selenium import webdriver
        from selenium.webdriver.chrome.service import Service
        from selenium.webdriver.common.by import By
        from selenium.webdriver.support.ui import Select, WebDriverWait

        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-gl=angle",
                         "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--window-size=1300,1000"):
            options.add_argument(argument)
        browser = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        self.addCleanup(browser.quit)

        def shot(name):
            browser.save_screenshot(str(SCREENSHOTS / f"report-{name}.png"))

        browser.get((self.results / "report.html").as_uri())
        WebDriverWait(browser, 60).until(lambda it: it.find_elements(By.CSS_SELECTOR, "#stage canvas"))
        shot("top")
        browser.execute_script("document.getElementById('view').scrollIntoView()")
        shot("view")
        fraction, first = lit(browser)
        self.assertGreater(fraction, 0.01)

        seen = {first}
        def changed(what):
            found = lit(browser)[1]
            self.assertNotIn(found, seen, what)
            seen.add(found)

        for field in ("speed", "cluster", "spin", "size"):
            Select(browser.find_element(By.ID, "field")).select_by_visible_text(field)
            changed(field)
        browser.find_element(By.CSS_SELECTOR, "[data-look=above]").click()
        changed("seen from above")
        shot("above")
        moment = browser.find_element(By.ID, "moment")
        self.assertIn("snap_000005.hdf", moment.text)
        browser.execute_script("const it = document.getElementById('time'); it.value = 0;"
                               "it.dispatchEvent(new Event('input'));")
        self.assertIn("snap_000000.hdf", moment.text)
        changed("another snapshot")
        webdriver.ActionChains(browser).drag_and_drop_by_offset(
            browser.find_element(By.CSS_SELECTOR, "#stage canvas"), 120, 60).perform()
        changed("turned by dragging")
        origin = webdriver.common.actions.wheel_input.ScrollOrigin.from_element(
            browser.find_element(By.CSS_SELECTOR, "#stage canvas"))
        webdriver.ActionChains(browser).scroll_from_origin(origin, 0, -600).perform()
        changed("closer by the wheel")
        shot("close")

        browser.execute_script("document.getElementById('series').scrollIntoView()")
        shot("series")
        charts = browser.find_elements(By.CSS_SELECTOR, ".chart")
        self.assertEqual(len(charts), len(self.data("series")["plots"]))
        for chart in charts:
            self.assertGreater(chart.size["width"], 300)
            self.assertTrue(chart.find_elements(By.TAG_NAME, "canvas"))
        up, right = (Select(browser.find_element(By.CSS_SELECTOR, f".chosen .{axis}")) for axis in ("up", "right"))
        self.assertGreater(len(up.options), len(charts) + 30)
        for y, x in (("snapshots: filling_factor", "Scale height: √⟨z²⟩, m"), ("Scale height: √⟨z²⟩, m", "time, orbits")):
            up.select_by_visible_text(y)
            right.select_by_visible_text(x)
            self.assertTrue(browser.find_elements(By.CSS_SELECTOR, ".any canvas"), (x, y))
            self.assertEqual(browser.find_element(By.CSS_SELECTOR, ".any .dygraph-xlabel").text, x)
        browser.execute_script("document.querySelector('.chosen').scrollIntoView()")
        shot("chosen")
        up.select_by_visible_text("time, orbits")
        self.assertIn("no time in common", browser.find_element(By.CSS_SELECTOR, ".any").text)
        browser.execute_script("document.getElementById('measured').scrollIntoView()")
        shot("measured")
        self.assertEqual([line for line in browser.get_log("browser") if line["level"] != "INFO"], [])


class LargeReport(unittest.TestCase):
    """More particles than the view shows: a part of them evenly by id, and a page that can be mailed."""

    SCENE = """
        planet.preset = "saturn-a-ring"
        box.size = [900.0, 900.0]
        particles = { count = 120000, density = 450.0, sizes = { law = "power", min = 0.6, max = 2.0, exponent = 3.0 } }
        time = { step = 1e-3, end = 4e-3 }
        output = { snapshot_every = 1e-3, series_every = 1e-3 }
        """

    def test_size(self):
        with tempfile.TemporaryDirectory() as folder:
            results, scene = Path(folder) / "run", Path(folder) / "scene.toml"
            scene.write_text(self.SCENE)
            for arguments in (("run", scene, "-o", results), ("report", results)):
                done = keeler(*arguments)
                self.assertEqual(done.returncode, 0, done.stderr)
            page = (results / "report.html").read_bytes()
            view = json.loads(re.search(b'id="view-data">(.*?)</script>', page, re.S).group(1))
            self.assertEqual((view["count"], view["of"], len(view["snapshots"])), (100000, 120000, 5))
            with h5py.File(results / "snap_000004.hdf") as file:
                radii = file["PartType1/Radius"][:][np.arange(100000) * 120000 // 100000]
            np.testing.assert_array_equal(numbers(view["radii"], "<f4"), radii.astype("f4"))
        # What a page may weigh: 5 MB and 1.2 MB a snapshot.
        self.assertLessEqual(len(page), 5e6 + 1.2e6 * len(view["snapshots"]))
        pictures = re.findall(rb'<img alt="the patch[^>]*base64,([^"]*)"', page)
        self.assertEqual(len(pictures), 4 + (b"in sunlight" in page))  # the last one with Embree alone
        for picture in pictures:
            self.assertLessEqual(struct.unpack(">I", base64.b64decode(picture[:64])[16:20])[0], 1200)


if __name__ == "__main__":
    unittest.main()
