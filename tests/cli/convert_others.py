#!/usr/bin/python3
"""convert_others.py SNAPSHOT TABLE: what numpy, h5py, ASE and yt read in TABLE.npz, .hdf5, .xyz and .gadget equals the
snapshot. Ids and numbers are exact; velocities pass through m per radian, and GADGET's places through a shift."""
import sys

import ase.io
import h5py
import numpy as np
import yt

snapshot, table = sys.argv[1:3]
with h5py.File(snapshot) as file:
    arrays = {name: file["PartType1"][name][:] for name in file["PartType1"]}
    ring = dict(file["RingBox"].attrs)
names = {"positions": "Coordinates", "velocities": "Velocities", "radii": "Radius", "masses": "Masses", "ids": "ParticleIDs"}


def same(found, name, digits=0.0):
    np.testing.assert_allclose(found, arrays[name], rtol=5e-16 if name == "Velocities" else 0.0, atol=digits)


with np.load(table + ".npz") as file:
    for name, other in names.items():
        same(file[name], other)
    assert tuple(file["box"]) == (ring["L_x"], ring["L_y"]) and file["shear_offset"] == ring["shear_offset"]
    assert file["orbits"] == ring["time_orbits"] and file["orbital_frequency"] == ring["Omega"]
    assert file["ids"].dtype == np.uint64

with h5py.File(table + ".hdf5") as file:
    same(np.column_stack([file[f"{axis}_m"] for axis in "xyz"]), "Coordinates")
    same(np.column_stack([file[f"v{axis}_m_s"] for axis in "xyz"]), "Velocities")
    same(file["r_m"][:], "Radius")
    same(file["m_kg"][:], "Masses")
    same(file["id"][:], "ParticleIDs")
    assert file["vx_m_s"].attrs["unit"] in ("m/s", b"m/s") and tuple(file.attrs["box_m"]) == (ring["L_x"], ring["L_y"])

atoms = ase.io.read(table + ".xyz")
same(atoms.positions, "Coordinates")
for name, other in (("velo", "Velocities"), ("radius", "Radius"), ("mass", "Masses"), ("id", "ParticleIDs")):
    same(atoms.arrays[name], other)
assert list(atoms.pbc) == [True, True, False]
# The lattice has the images of the ring: at L_x they are shifted along y by minus the offset, up to L_y.
shift = atoms.cell[0] + [0.0, ring["shear_offset"], 0.0]
assert shift[0] == ring["L_x"] and min(abs(shift[1]), abs(shift[1] - ring["L_y"])) < 1e-12, shift
assert np.allclose(atoms.info["Origin"] + 0.5 * atoms.cell.sum(axis=0), 0.0, atol=1e-12)

yt.set_log_level(50)
with h5py.File(table + ".gadget") as file:
    units, side = dict(file["Units"].attrs), file["Header"].attrs["BoxSize"]
base = {name: units[name] for name in ("UnitLength_in_cm", "UnitMass_in_g", "UnitVelocity_in_cm_per_s")}
every = yt.load(table + ".gadget", unit_base=base).all_data()
order = np.argsort(every["PartType1", "ParticleIDs"].d)
same(every["PartType1", "Masses"].to("kg").d[order], "Masses", 1e-9)
places = every["PartType1", "Coordinates"].to("m").d[order] - 0.5 * side
np.testing.assert_allclose(places, arrays["Coordinates"], rtol=0.0, atol=1e-12)
np.testing.assert_allclose(every["PartType1", "Velocities"].to("m/s").d[order], arrays["Velocities"], rtol=1e-14)
