#!/usr/bin/env python3
"""The radial pressure of rings and its slope, from runs that log their contacts.

    pressure.py RUN...    prints a line for each run, and the slope of a straight line through them

P_xx = <Σ m v_x²>/area + Σ |n_x J_x| (r₁ + r₂)/(area · time), by particles that move and by contacts (Wisdom & Tremaine
1988, AJ 95, 925), from the third orbit on. For runs of equal spheres without a wave, at several optical depths.
"""

import glob
import math
import sys

import h5py
import numpy

SINCE = 2.0  # orbits


def pressure(run):
    moving, contacts, last = [], 0.0, SINCE
    for path in sorted(glob.glob(f"{run}/snap_*.hdf")):
        with h5py.File(path) as file:
            particles, box = file["PartType1"], file["RingBox"].attrs
            area, omega = float(box["L_x"] * box["L_y"]), float(box["Omega"])
            mass, speed = particles["Masses"][:], particles["Velocities"][:, 0]
            radius = float(particles["Radius"][0])
            if box["time_orbits"] >= SINCE:
                moving.append(numpy.sum(mass * (speed - speed.mean()) ** 2) / area)
    for path in sorted(glob.glob(f"{run}/collisions_*.h5")):
        with h5py.File(path) as file:
            log = file["Contacts"]
            later = log["Time"][:] > SINCE
            contacts += numpy.sum(numpy.abs(log["NormalX"][:] * log["ImpulseX"][:])[later]) * 2 * radius
            last = max(last, log["Time"][:].max(initial=0.0))
    if not moving or last == SINCE:
        sys.exit(f"{run}: no snapshots or no logged contacts after orbit {SINCE:g}")
    time = (last - SINCE) * 2 * math.pi / omega
    return mass.sum() / area, numpy.mean(moving), contacts / (area * time), omega


found = [pressure(run) for run in sys.argv[1:]]
for density, moving, contacts, omega in found:
    print(f"{density:.1f} kg/m²: P/Σ {moving / density / omega**2:.3f} by motion and {contacts / density / omega**2:.3f} "
          "by contacts, m² Ω²")
if len(found) > 1:
    densities, pressures = [f[0] for f in found], [(f[1] + f[2]) / f[3] ** 2 for f in found]
    print(f"dP/dΣ {numpy.polyfit(densities, pressures, 1)[0]:.1f} m² Ω²")
