"""Tables of runs and sweeps as objects of pandas and xarray: the same numbers, with units and meanings."""

import importlib.util
import os
import re
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

import keeler
from scenes import ring

HAS_PANDAS, HAS_XARRAY = (importlib.util.find_spec(name) is not None for name in ("pandas", "xarray"))
FORMATS = (Path(os.environ["KEELER_SOURCE_DIR"]) / "docs" / "formats.md").read_text(encoding="utf-8")


class Tables(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.work = tempfile.TemporaryDirectory()
        folder = Path(cls.work.name)
        moonlet = [{"radius": 4.0, "density": 450.0}]
        cls.run_ = keeler.run(ring(moonlet=moonlet, gravity={}, time={"step": 5e-3, "end": 0.1}), folder / "run")
        grid = {"scene": ring(time={"step": 5e-3, "end": 0.1}), "seeds": [1, 2],
                "axis": [{"key": "particles.optical_depth", "values": [0.1, 0.2]},
                         {"key": "collisions.restitution.value", "values": [0.3, 0.5, 0.7]}]}  # fmt: skip
        cls.sweep = keeler.sweep(grid, folder / "sweep")

    @classmethod
    def tearDownClass(cls):
        cls.work.cleanup()

    def test_columns_say_what_the_manual_says(self):
        series = self.run_.series
        self.assertEqual(series.quantity("dispersion_z_m_s").unit, "m/s")
        for name in [*series, *self.run_.moonlets]:
            quantity = (series if name in series else self.run_.moonlets).quantity(name)
            row = re.search(rf"^\| `{name}` \| (.*?) \| (.*?) \|$", FORMATS, re.M)
            self.assertEqual(quantity.unit, row[1], name)
            self.assertTrue(row[2].startswith(quantity.meaning), name)
        with self.assertRaisesRegex(keeler.UsageError, "no column 'dispersion'.*time_orbits"):
            series.quantity("dispersion")

    def test_every_column_of_a_sweep_has_a_meaning(self):
        for rows in self.sweep.values():
            for name in rows[0]:
                quantity = rows.quantity(name)
                self.assertEqual(quantity.meaning == "key of the scene", "." in name, name)
                self.assertNotIn("at this instant", quantity.meaning)
        self.assertEqual(self.sweep["points"].quantity("total_viscosity_error_r2_omega").unit, "r² Ω")

    @unittest.skipUnless(HAS_PANDAS, "no pandas")
    def test_pandas(self):
        series, frame = self.run_.series, self.run_.series.to_pandas()
        self.assertEqual(list(frame.columns), list(series))
        for name, column in series.items():
            np.testing.assert_array_equal(frame[name], column)
        self.assertEqual(frame.attrs["units"]["scale_height_m"], "m")
        self.assertIn("radial velocity dispersion", frame.attrs["meanings"]["dispersion_x_m_s"])
        rows, frame = self.sweep["runs"], self.sweep["runs"].to_pandas()
        self.assertEqual(len(frame), 12)
        for row, (_, other) in zip(rows, frame.iterrows()):
            for name, value in row.items():
                self.assertTrue(other[name] == value or (value is None and other[name] != other[name]), name)

    @unittest.skipUnless(HAS_XARRAY, "no xarray")
    def test_xarray(self):
        series, data = self.run_.series, self.run_.series.to_xarray()
        self.assertEqual(dict(data.sizes), {"time_orbits": len(series["time_orbits"])})
        np.testing.assert_array_equal(data["kick_work_j"], series["kick_work_j"])
        self.assertEqual(data["kick_work_j"].attrs["units"], "J")
        self.assertEqual(data["time_orbits"].attrs["long_name"], "time since the run began")
        moonlets = self.run_.moonlets
        self.assertEqual(dict(moonlets.to_xarray().sizes), {"time_orbits": len(moonlets["step"]), "id": 1})
        points, data = self.sweep["points"], self.sweep["points"].to_xarray()
        self.assertEqual(dict(data.sizes), {"particles.optical_depth": 2, "collisions.restitution.value": 3})
        self.assertEqual(dict(self.sweep["runs"].to_xarray().sizes), {**data.sizes, "seed": 2})
        for row in points:
            place = {name: row[name] for name in data.sizes}
            self.assertEqual(float(data["dispersion_x_m_s"].sel(place)), row["dispersion_x_m_s"])
        whole = type(points)(points[:-1]).to_xarray()  # a point that is missing
        self.assertEqual(int(np.isnan(whole["dispersion_x_m_s"]).sum()), 1)
        self.assertEqual(whole["dispersion_x_m_s"].attrs["units"], "m/s")

    def test_without_them(self):
        for name in ("pandas", "xarray"):
            with mock.patch.dict(sys.modules, {name: None}):
                with self.assertRaisesRegex(ImportError, f"this needs {name}, which .* lacks; .*python3-{name}"):
                    self.run_.series.to_xarray() if name == "xarray" else self.run_.series.to_pandas()


if __name__ == "__main__":
    unittest.main()
