#!/usr/bin/python3
"""convert.py SNAPSHOT CSV VTP [PVD]: the numbers read by numpy and VTK equal those of the snapshot, spins included.
Prints the times in the PVD."""
import sys
import xml.etree.ElementTree

import h5py
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

snapshot, csv, vtp = sys.argv[1:4]
with h5py.File(snapshot) as file:
    arrays = {name: file["PartType1"][name][:] for name in file["PartType1"]}
    orbits = file["RingBox"].attrs["time_orbits"]


def same(found, name):
    """The arrays are equal, except for two roundings of velocities, which are stored in other units."""
    np.testing.assert_allclose(found, arrays[name], rtol=5e-16 if name in ("Velocities", "Spins") else 0.0, atol=0.0)


def columns(table, *names):
    return np.column_stack([table[name] for name in names])


table = np.genfromtxt(csv, delimiter=",", names=True, dtype=None)
same(table["id"], "ParticleIDs")
same(columns(table, "x_m", "y_m", "z_m"), "Coordinates")
same(columns(table, "vx_m_s", "vy_m_s", "vz_m_s"), "Velocities")
same(table["r_m"], "Radius")
same(table["m_kg"], "Masses")

reader = vtkXMLPolyDataReader()
reader.SetFileName(vtp)
reader.Update()
grid = reader.GetOutput()
assert grid.GetNumberOfVerts() == len(arrays["Radius"]), grid.GetNumberOfVerts()
same(vtk_to_numpy(grid.GetPoints().GetData()), "Coordinates")
assert grid.GetPoints().GetDataType() == 11, "points are not doubles"
for k, unit in (("Velocities", "m/s"), ("Masses", "kg"), ("Radius", "m"), ("ParticleIDs", None), ("Spins", "rad/s")):
    array = grid.GetPointData().GetArray(k)
    if k == "Spins" and k not in arrays:
        assert array is None and "sx_rad_s" not in table.dtype.names
        continue
    same(vtk_to_numpy(array), k)
    if unit:
        assert array.GetInformation().Get(array.UNITS_LABEL()) == unit, (k, array.GetInformation())
if "Spins" in arrays:
    same(columns(table, "sx_rad_s", "sy_rad_s", "sz_rad_s"), "Spins")
assert grid.GetFieldData().GetArray("TimeValue").GetValue(0) == orbits
cell = grid.GetCell(len(table) - 1)
assert cell.GetNumberOfPoints() == 1 and cell.GetPointId(0) == len(table) - 1

for pvd in sys.argv[4:]:
    for instant in xml.etree.ElementTree.parse(pvd).iter("DataSet"):
        print(instant.get("timestep"), instant.get("file"))
