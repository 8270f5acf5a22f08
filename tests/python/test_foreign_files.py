"""Snapshots that others changed: what no ring has is refused by one line, soon, and nothing of them is taken."""

import unittest

import h5py
import keeler as ring
import numpy as np
from foreign import Foreign, keeler


class ForeignFiles(Foreign):
    def test_nothing_changed(self):
        self.change(lambda file, part: None)
        self.assertEqual(keeler("analyze", self.file).returncode, 0)

    def test_what_no_ring_has(self):
        def one(name, place, value):
            def how(_, part):
                part[name][place] = value

            return how

        def ring(name, value):
            def how(file, _):
                file["RingBox"].attrs[name] = value
                if name == "L_x":
                    file["Header"].attrs["BoxSize"] = value

            return how

        for how, words in (
            (one("Coordinates", (3, 0), 1e9), "a coordinate (m) of 1e9"),
            (one("Coordinates", (3, 2), 1e20), "a coordinate (m) of 1e20"),
            (one("Velocities", (3, 0), 1e5), "a speed (m/s, beyond the shear) of 1e5"),
            (one("Masses", 3, 1e18), "a density (kg/m^3, by its mass and radius) of 2.39e17"),
            (one("Radius", 3, 1e9), "a radius (m) of 1e9"),
            (one("Radius", 3, np.nan), "a radius that is not positive"),
            (ring("L_x", 1e9), "the box of"),
            (ring("shear_offset", np.nan), "a shear_offset of nan m, modulo L_y (possible is from 0 to 30)"),
            (ring("shear_offset", 1e18), "a shear_offset of 1e18"),
            (ring("shear_offset", np.inf), "a shear_offset of inf"),
            (ring("shear_offset", -1.0), "a shear_offset of -1"),
            (ring("shear_offset_at_start", np.nan), "a shear_offset_at_start of nan"),
            (ring("kappa_over_Omega", np.nan), "a kappa_over_Omega of nan"),
            (ring("kappa_over_Omega", np.inf), "a kappa_over_Omega of inf"),
            (ring("nu_over_Omega", np.nan), "a nu_over_Omega of nan"),
            (ring("nu_over_Omega", 1e9), "a nu_over_Omega of 1e9"),
            (ring("shear_over_Omega", 0.0), "a shear_over_Omega of 0, but its kappa_over_Omega gives 1.50"),
            (ring("shear_over_Omega", np.nan), "a shear_over_Omega of nan"),
        ):
            with self.subTest(words):
                self.change(how)
                self.refused(3, words.replace("1e5", "100000"))
        self.change(ring("Omega", 1.0))  # a run says that it is of another planet
        done = keeler("analyze", self.file)
        self.assertEqual(done.returncode, 3)
        self.assertIn(b"an Omega of 1 rad/s", done.stderr)

    def test_overlaps(self):
        def how(_, part):
            part["Coordinates"][1] = part["Coordinates"][0]

        self.change(how)
        for command in (("run", self.scene, "--from", self.file), ("run", self.scene, "--set", f"start.from='{self.file}'")):
            done = keeler(*command, "-o", self.folder / "run")
            self.assertEqual(done.returncode, 3)
            self.assertRegex(done.stderr.decode(), r"particles 0 and 1 of '.*changed\.hdf' overlap by")

    def test_deep_scenes(self):
        """In a snapshot, a text, a dictionary and overrides."""
        dots, whole = "a." * 15000 + "b = 1", self.scene.read_text()
        self.change(lambda file, part: file["Parameters"].attrs.__setitem__("scene", dots))
        done = keeler("analyze", self.file)
        self.assertEqual(done.returncode, 2)
        self.assertIn(b"a name of more than 16 parts", done.stderr)
        endless, deep = {}, 1
        endless["again"] = endless
        for _ in range(50):
            deep = [deep]
        for make, words in (
            (lambda: ring.generate(dots + "\n"), "a name of more than 16 parts"),
            (lambda: ring.generate(whole, **{"a." * 15000 + "b": 1}), "more than 16 parts"),
            (lambda: ring.generate(whole, box={"size": deep}), "more than 16 deep"),
            (lambda: ring.generate({"box": endless}), "too deep"),
            (lambda: ring.generate(whole, box=endless), "too deep"),
        ):
            with self.subTest(words), self.assertRaisesRegex(ring.UsageError, words):
                make()

    def test_time(self):
        for value in (np.nan, np.inf, -1.0):
            def how(file, _, value=value):
                file["RingBox"].attrs["time_orbits"] = value
                del file["Header"].attrs["Time"]

            self.change(how)
            self.refused(3, "a time_orbits of")
            with self.assertRaises(ring.InvariantError):
                ring.read(self.file)

    def test_header_that_says_something_else(self):
        """GADGET's header and the attributes of arrays: other units and parts of a whole are refused by name."""

        def header(name, value):
            return lambda file, _: file["Header"].attrs.__setitem__(name, value)

        def array(name, attribute, value):
            return lambda _, part: part[name].attrs.__setitem__(attribute, value)

        def six(name, kind, value):
            def how(file, _):
                numbers = np.array(file["Header"].attrs[name])
                numbers[kind] = value
                file["Header"].attrs[name] = numbers

            return how

        for how, words in (
            (header("UnitLength_in_cm", 1e5), "/Header is in another unit (its attribute UnitLength_in_cm is 100000), and Keeler takes SI"),
            (header("UnitMass_in_g", 1.0), "UnitMass_in_g is 1)"),
            (header("UnitVelocity_in_cm_per_s", np.nan), "UnitVelocity_in_cm_per_s is nan)"),
            (header("NumFilesPerSnapshot", 2), "NumFilesPerSnapshot 2, not 1 (a start is one whole file"),
            (header("BoxSize", 0.03), "BoxSize 0.03, not 30"),
            (header("Time", 1e7), "Time 1e+07, not 0"),
            (six("NumPart_Total", 1, 7), "NumPart_Total 7 for type 1"),
            (six("NumPart_ThisFile", 0, 5), "NumPart_ThisFile 5 for type 0, not 0"),
            (six("NumPart_Total_HighWord", 1, 1), "NumPart_Total_HighWord 1 for type 1, not 0"),
            (six("MassTable", 1, 4e3), "MassTable 4000 for type 1, not 0"),
            (array("Coordinates", "unit", "km"), "Coordinates is in another unit (its attribute unit is 'km')"),
            (array("Velocities", "units", "cm/s"), "Velocities is in another unit (its attribute units is 'cm/s')"),
            (array("Masses", "to_cgs", 1.0), "Masses is in another unit (its attribute to_cgs is 1)"),
            (array("Radius", "CGSConversionFactor", 1e5), "Radius is in another unit"),
        ):
            with self.subTest(words):
                self.change(how)
                self.refused(4, words)
        for how in (header("UnitLength_in_cm", 100), array("Coordinates", "unit", "metre"), array("Velocities", "unit", "m s^-1"),
                    array("Masses", "to_cgs", 1000.0), lambda file, _: file.__delitem__("Header")):
            self.change(how)
            done = keeler("analyze", self.file)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_units_and_scales_that_other_attributes_state(self):
        """On the root, groups and arrays, in any case; what states SI is taken."""

        def group(name, attribute, value):
            return lambda file, _: file.require_group(name).attrs.__setitem__(attribute, value)

        def array(name, attribute, value):
            return lambda _, part: part[name].attrs.__setitem__(attribute, value)

        units = "Unit length in cgs (U_L)"
        for how, words in (
            (group("/", "units", "km"), "the file is in another unit (its attribute units is 'km')"),
            (group("Header", "HubbleParam", 0.7), "/Header is in another unit (its attribute HubbleParam is 0.7)"),
            (group("Parameters", "UnitLength_in_cm", 1e5), "/Parameters is in another unit (its attribute UnitLength_in_cm"),
            (group("Parameters", "unitmass_in_g", 1.0), "/Parameters is in another unit (its attribute unitmass_in_g is 1)"),
            (group("Units", units, [1e5]), f"/Units is in another unit (its attribute {units} is 100000)"),
            (group("RingBox", "units", "km"), "/RingBox is in another unit (its attribute units is 'km')"),
            (group("RingBox", "time_s", np.nan), "its /RingBox has time_s nan"),
            (group("RingBox", "bounds_low", [np.nan] * 3), "its /RingBox has bounds_low nan"),
            (group("PartType1", "length_unit", "kpc"), "/PartType1 is in another unit"),
            (array("Coordinates", "Units", "km"), "Coordinates is in another unit (its attribute Units is 'km'), and Keeler takes m"),
            (array("Coordinates", "Units", ["m", "km"]), "the attribute Units of Coordinates is neither"),
            (array("Radius", "scale_factor", 1000), "its attribute scale_factor is 1000"),
            (array("Radius", "add_offset", 1.0), "its attribute add_offset is 1"),
            (array("Velocities", "to_SI", 1e3), "its attribute to_SI is 1000"),
            (array("Masses", "unitSI", 1e-3), "its attribute unitSI is 0.001"),
            (array("ParticleIDs", "scale_factor", 2), "ParticleIDs is in another unit"),
            (lambda _, part: part["Radius"].attrs.__setitem__("_FillValue", part["Radius"][0]), "Radius has "),
        ):
            with self.subTest(words):
                self.change(how)
                self.refused(4, words)

        def stated(file, part):
            for place, attributes in (
                ("/", {"units": "SI", "length_unit": "m"}),
                ("Units", {units: [100.0], "Unit mass in cgs (U_M)": [1000.0], "Unit time in cgs (U_t)": 1.0}),
                ("Parameters", {"UnitLength_in_cm": "100", "HubbleParam": 0.0}),
                ("PartType1/Radius", {"Units": "", "scale_factor": 1, "add_offset": 0.0, "unitSI": 1.0, "_FillValue": -1.0}),
                ("PartType1/ParticleIDs", {"to_cgs": 0.0}),
            ):
                of = file[place] if place in file else file.create_group(place)
                of.attrs.update(attributes)

        self.change(stated)
        done = keeler("analyze", self.file)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_ids_that_are_no_whole_numbers(self):
        for first, kind in ((0.5, "f8"), (-1.0, "i8"), (-1.0, "f8"), (np.nan, "f8"), (2.0**60, "f8")):
            def make(part, count, first=first, kind=kind):
                ids = np.arange(count).astype(kind)
                ids[0] = first
                part["ParticleIDs"] = ids

            with self.subTest(first, kind=kind):
                self.replace("ParticleIDs", make)
                self.refused(4, "an id is a whole number from 0 on")
        self.replace("ParticleIDs", lambda part, count: part.__setitem__("ParticleIDs", np.arange(count, dtype="f4")))
        self.assertEqual(keeler("analyze", self.file).returncode, 0)

    def test_units_and_scales_that_a_table_states(self):
        table = self.folder / "units.h5"

        def written(where, attribute, value):
            with h5py.File(table, "w") as file:
                for name in "xyz":
                    file[name] = [0.0, 5.0]
                file["r"] = [1.0, 1.0]
                file[where].attrs[attribute] = value
            return keeler("generate", self.scene, "--from-table", table, "-o", self.folder / "of_table.hdf", "--force")

        for where, attribute, value in (("/", "unit", "km"), ("x", "scale_factor", 1000), ("x", "Units", "km"),
                                        ("r", "_FillValue", 1.0), ("r", "missing_value", [9.0, 1.0])):
            done = written(where, attribute, value)
            self.assertEqual((done.returncode, done.stderr.count(b"\n")), (4, 1), done.stderr)
            self.assertIn(attribute.encode(), done.stderr)
        self.assertEqual(written("x", "_FillValue", -1.0).returncode, 0)


if __name__ == "__main__":
    unittest.main()
