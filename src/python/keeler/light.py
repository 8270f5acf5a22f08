"""Photometry: the light that an observer sees of a patch."""

import math

from . import _arguments, _core, numbers, runs, scenes, simulation, snapshots
from .errors import UsageError


def _angles(value, name, low, high):
    """Returns a list of angles in degrees from one or several numbers. Raises UsageError."""
    try:
        given = [float(angle) for angle in (value if hasattr(value, "__iter__") and not isinstance(value, str) else [value])]
    except (TypeError, ValueError):
        given = []
    if not given or not all(low <= angle <= high for angle in given):
        raise UsageError(f"{name} is {_arguments.shown(value)}; give angles from {low} to {high} degrees")
    return given


def _elevations(value, name):
    angles = _angles(value, name, -90, 90)
    if any(abs(angle) < 0.1 for angle in angles):
        raise UsageError(f"{name} is {_arguments.shown(value)}; give elevations of 0.1 degrees at least, on either face")
    return angles


def _number(value, name, low, high):
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not low <= number <= high:
        raise UsageError(f"{name} is {_arguments.shown(value)}; give a number from {low:g} to {high:g}")
    return number


def photometry(
    what,
    elevation,
    azimuth=None,
    *,
    sun_elevation=None,
    phase=6.0,
    law="callisto",
    albedo=0.5,
    rays=100000,
    error=None,
    seed=1,
    since=None,
    until=None,
):
    """Returns what ``keeler photometry`` tells of a Snapshot, a Simulation, a Run or the path of one: a list of Numbers, one per
    sight, azimuths fastest, then phase angles, elevations of the Sun and of the observer.

    Angles are in degrees, one or several each: ``elevation`` of the observer (below 0: the other face), ``azimuth`` of the
    observer from the radius to the orbital motion (default: every 10 in half a turn; a ring longitude is its negative),
    ``sun_elevation`` (default: as the observer), ``phase``. ``law`` is the name of a scattering law, NAME or NAME=VALUE, or
    a function of the phase angle in radians that returns the phase function on any scale; ``albedo`` is that of single
    scattering. ``rays`` are per sight and snapshot; with ``error`` rays are traced until the relative standard error of I/F is
    met. A run gives the means over the snapshots of its steady part, or from orbit ``since`` to ``until``.
    Raises UsageError, IoError, and RunError if Keeler was built without Embree.
    """
    if isinstance(what, simulation.Simulation):
        what = what.snapshot()
    if not isinstance(what, (snapshots.Snapshot, runs.Run)):
        what = runs.read(what)
    if not isinstance(law, str) and not callable(law):
        raise UsageError(f"law is {_arguments.shown(law)}; give the name of a law, or a function of the phase angle")
    found = _core.photometry(
        what.folder if isinstance(what, runs.Run) else what._core,
        since,
        until,
        _elevations(elevation, "elevation"),
        [] if sun_elevation is None else _elevations(sun_elevation, "sun_elevation"),
        _angles(phase, "phase", 0, 180),
        [10.0 * k for k in range(18)] if azimuth is None else _angles(azimuth, "azimuth", -360, 360),
        law,
        _number(albedo, "albedo", 0, 1),
        scenes.whole_number(rays, "rays", 1, 10**9),
        None if error is None else _number(error, "error", 1e-5, 1),
        scenes.whole_number(seed, "seed", 0, 10**15),
    )
    return [numbers.Numbers(*one) for one in found]
