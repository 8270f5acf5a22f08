"""The light that an observer sees of a patch: photometry, and occultations of stars."""

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


def _looked(what):
    """Returns what the compiled part looks at: a snapshot, or the folder of a run."""
    if isinstance(what, simulation.Simulation):
        what = what.snapshot()
    if not isinstance(what, (snapshots.Snapshot, runs.Run)):
        what = runs.read(what)
    return what.folder if isinstance(what, runs.Run) else what._core


_ALL_AZIMUTHS = [10.0 * k for k in range(18)]


class SurfaceLaw:
    """A surface of one's own for ``photometry(law=...)``: ``function(mu0, mu, alpha)`` returns the I/F of a point on any
    scale, mu0 and mu the cosines of the angles between its normal and the directions to the Sun and to the observer, alpha
    the phase angle in radians. A surface is reciprocal if function/mu0 is the same with mu0 and mu exchanged. The function is
    tabulated every 2.5 degrees before rays are traced."""

    __slots__ = ("function",)

    def __init__(self, function):
        if not callable(function):
            raise UsageError(f"function is {_arguments.shown(function)}; give a function of mu0, mu and the phase angle")
        self.function = function


class Sights(list):
    """Numbers, one per sight. ``asymmetries`` are Numbers of each set of at least two azimuths at the same other angles:
    ``mean_reflectance``, ``asymmetry`` and ``minimum_longitude_degrees``."""

    def __init__(self, sights, asymmetries):
        super().__init__(sights)
        self.asymmetries = asymmetries


class Occultations(list):
    """Numbers, one per line of sight. ``wake_model`` are the Numbers of the bars that fit their transmissions; None where they
    leave these open."""

    def __init__(self, lines, wake_model):
        super().__init__(lines)
        self.wake_model = wake_model


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
    """Returns what ``keeler photometry`` tells of a Snapshot, a Simulation, a Run or the path of one: Sights, a list of Numbers,
    one per sight, azimuths fastest, then phase angles, elevations of the Sun and of the observer.

    Angles are in degrees, one or several each: ``elevation`` of the observer (below 0: the other face), ``azimuth`` of the
    observer from the radius to the orbital motion (default: every 10 in half a turn; a ring longitude is its negative),
    ``sun_elevation`` (default: as the observer), ``phase``. ``law`` is the name of a scattering law, NAME or NAME=VALUE,
    a function of the phase angle in radians that returns the phase function on any scale, or a SurfaceLaw; ``albedo`` is that of single
    scattering. ``rays`` are per sight and snapshot; with ``error`` rays are traced until the relative standard error of I/F is
    met. A run gives the means over the snapshots of its steady part, or from orbit ``since`` to ``until``.
    Raises UsageError, IoError, and RunError if Keeler was built without Embree.
    """
    is_surface = isinstance(law, SurfaceLaw)
    if not isinstance(law, str) and not is_surface and not callable(law):
        raise UsageError(
            f"law is {_arguments.shown(law)}; give the name of a law, a function of the phase angle, or a keeler.SurfaceLaw"
        )
    sights, groups = _core.photometry(
        _looked(what),
        since,
        until,
        _elevations(elevation, "elevation"),
        [] if sun_elevation is None else _elevations(sun_elevation, "sun_elevation"),
        _angles(phase, "phase", 0, 180),
        _ALL_AZIMUTHS if azimuth is None else _angles(azimuth, "azimuth", -360, 360),
        law.function if is_surface else law,
        is_surface,
        _number(albedo, "albedo", 0, 1),
        scenes.whole_number(rays, "rays", 1, 10**9),
        None if error is None else _number(error, "error", 1e-5, 1),
        scenes.whole_number(seed, "seed", 0, 10**15),
    )
    return Sights([numbers.Numbers(*one) for one in sights], [numbers.Numbers(*one) for one in groups])


def occultation(
    what,
    elevation,
    azimuth=None,
    *,
    length=10.0,
    width=10.0,
    track=0.0,
    tracks=100,
    samples=64,
    rays=32,
    section="rectangle",
    since=None,
    until=None,
):
    """Returns what ``keeler occultation`` tells of a Snapshot, a Simulation, a Run or the path of one: Occultations, a list of
    Numbers, one per line of sight, azimuths fastest; ``autocovariance`` is a list.

    Angles are in degrees, one or several each: ``elevation`` of the star, below 0 on the other face, ``azimuth`` from the
    radius to the orbital motion (default: every 10 in half a turn). A sample sweeps ``length`` along the azimuth ``track`` and is
    ``width`` wide, in m; ``tracks`` of ``samples`` lie at random places in each snapshot, with ``rays`` a sample. ``section``
    is that of the bars: "rectangle" or "ellipse". A run gives the numbers of all snapshots of its steady part together, or of
    those from orbit ``since`` to ``until``. Raises UsageError, IoError, and RunError if Keeler was built without Embree.
    """
    if section not in ("rectangle", "ellipse"):
        raise UsageError(f"section is {_arguments.shown(section)}; give 'rectangle' or 'ellipse'")
    lines, wakes = _core.occultation(
        _looked(what),
        since,
        until,
        _elevations(elevation, "elevation"),
        _ALL_AZIMUTHS if azimuth is None else _angles(azimuth, "azimuth", -360, 360),
        _number(length, "length", 1e-6, 1e6),
        _number(width, "width", 1e-6, 1e6),
        _number(track, "track", -360, 360),
        scenes.whole_number(tracks, "tracks", 2, 10**6),
        scenes.whole_number(samples, "samples", 2, 10**5),
        scenes.whole_number(rays, "rays", 4, 10**5),
        section == "ellipse",
    )
    return Occultations([numbers.Numbers(*one) for one in lines], None if wakes is None else numbers.Numbers(*wakes))
