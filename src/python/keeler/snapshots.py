"""Snapshots: a patch of ring at one time."""

import functools
import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np

from . import _arguments, _core, numbers, scenes
from .errors import UsageError


class Picture:
    """A picture, which a notebook shows. ``data`` is the PNG."""

    def __init__(self, data):
        self.data = data

    def _repr_png_(self):
        return self.data

    def save(self, file):
        """Writes the PNG. Raises IoError."""
        _core.write_file(_arguments.path(file, "save"), self.data)


class Snapshot:
    """A patch of ring at one time, in SI units, with N particles sorted by id.

    ``positions`` (N, 3) m and ``velocities`` (N, 3) m/s in Hill's frame (x outward, y along the orbit, z up; the
    shear is in the velocities), ``radii`` (N,) m, ``masses`` (N,) kg, ``ids`` (N,), inertial ``spins`` (N, 3) rad/s
    or None. All arrays are read-only. ``box`` is (L_x, L_y) in m. The neighbour boxes at larger x are shifted along y
    by -``shear_offset`` m per box: the image in the box (n, m) is at x + n L_x, y + m L_y - n shear_offset. ``scene``
    is the resolved scene as text.
    """

    def __init__(self, core, name="snapshot"):
        self._core = core
        self._name = name
        self._velocities = None

    def __len__(self):
        return len(self._core)

    def __repr__(self):
        x, y = self.box
        return f"<keeler.Snapshot: {len(self)} particles in {x:g} m x {y:g} m at orbit {self.orbits:g}>"

    positions = property(lambda self: self._core.positions)
    radii = property(lambda self: self._core.radii)
    masses = property(lambda self: self._core.masses)
    ids = property(lambda self: self._core.ids)
    spins = property(lambda self: self._core.spins())
    box = property(lambda self: self._core.box)
    shear_offset = property(lambda self: self._core.shear_offset)
    orbital_frequency = property(lambda self: self._core.orbital_frequency, doc="Omega, rad/s.")
    orbits = property(lambda self: self._core.time_orbits, doc="The time in orbits.")
    scene = property(lambda self: self._core.scene)

    @property
    def velocities(self):
        if self._velocities is None:
            self._velocities = self._core.velocities()
        return self._velocities

    def analyze(self):
        """Returns the Numbers of ``keeler analyze --json``: a dictionary of names with units."""
        return numbers.Numbers(*self._core.analyze())

    def save(self, file):
        """Writes a snapshot file; give it the ending .hdf. Raises IoError."""
        self._core.save(_arguments.path(file, "save"))

    def tile(self, nx, ny):
        """Returns the snapshot repeated nx times along the radius and ny times along the orbit. Raises UsageError."""
        nx, ny = (scenes.whole_number(n, name, 1, 10000) for n, name in ((nx, "nx"), (ny, "ny")))
        return Snapshot(self._core.tile(nx, ny, self._name), self._name)

    def plot(self, file=None, *, title="Ring patch", width=1600):
        """Returns the picture of ``keeler render``: from above, and edge-on. Writes it as PNG if a file is given.
        ``width`` is in pixels, from 200 to 8000. Raises UsageError, IoError."""
        width = scenes.whole_number(width, "width", 200, 8000)
        file = None if file is None else _arguments.path(file, "plot")
        if file is not None and not _core.is_stream(file) and file.suffix != ".png":
            raise UsageError(f"'{file}' cannot be written: pictures are PNGs; give it the ending .png")
        with tempfile.TemporaryDirectory() as folder:
            drawn = Path(folder) / "picture.png"
            self._core.render(drawn, title, width)
            picture = Picture(drawn.read_bytes())
        if file is not None:
            picture.save(file)
        return picture

    def _repr_png_(self):
        return self.plot(width=1000)._repr_png_()

    def __reduce__(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "snapshot.hdf"
            self._core.save(file, as_it_is=True)
            return _from_bytes, (file.read_bytes(), self._name, self._core.is_a_start)


def generate(scene, *, clumped=False, **overrides):
    """Returns the initial state of a scene as a Snapshot.

    ``clumped``: evolved under self-gravity until its wakes have settled, as ``keeler generate --clumped`` (minutes).
    Raises UsageError for an invalid scene, RunError when wakes do not settle.
    """
    return Snapshot(_core.generate(scenes.read(scene, overrides), clumped))


def tile(snapshot, nx, ny):
    """Returns a snapshot, or the file of one, repeated into a larger patch. Raises UsageError, IoError."""
    if not isinstance(snapshot, Snapshot):
        snapshot = read(snapshot)
    return snapshot.tile(nx, ny)


def start_from_arrays(
    scene,
    positions,
    radii,
    velocities=None,
    masses=None,
    spins=None,
    *,
    ids=None,
    relax=False,
    shear_offset=0.0,
    orbital_frequency=None,
    orbits=None,
    **overrides,
):
    """Returns an initial state with given particles, as a Snapshot in the scene's box.

    positions (N, 3) m, velocities (N, 3) m/s or None (circular orbits), radii (N,) m or one number, masses (N,) kg or
    one number or None (from the scene's density), inertial spins (N, 3) rad/s if the scene has friction. Particle k
    gets the id k; with ``ids`` (N,), all different, the order is that of the ids. ``relax`` moves overlapping particles
    apart. ``shear_offset`` (m, from 0 to L_y) is that of the box, as of a Snapshot.

    So ``**numpy.load(file)`` of an npz file of ``keeler convert`` may be given: ``orbital_frequency`` (rad/s) and ``box``, as two
    numbers, must then be those of the scene, and ``orbits`` is not used, since the simulation begins at orbit 0. Warns (UserWarning) of a state unlike any ring:
    velocities without the shear, tables in km. Raises UsageError, naming the row, for invalid particles and for
    masked entries; InvariantError for overlaps.
    """
    text, scene_name = scenes.source(scene)
    given = {"positions": positions, "velocities": velocities, "radii": radii, "masses": masses, "spins": spins}
    arrays = [_arguments.doubles(array, name) for name, array in given.items()]
    if ids is not None:
        arrays = _sorted_by(ids, arrays)
    box = (0.0, 0.0)
    if not isinstance(overrides.get("box", {}), dict):  # numbers, and no table of the scene
        box = _arguments.numbers(overrides.pop("box"), "box", 2)
    frequency = 0.0 if orbital_frequency is None else _arguments.numbers(orbital_frequency, "orbital_frequency", 1)[0]
    try:
        offset = float(shear_offset)
    except (TypeError, ValueError, OverflowError):
        raise UsageError(f"shear_offset is {_arguments.shown(shear_offset)}; give a length in m") from None
    make = functools.partial(_core.from_arrays, text, scene_name, scenes.overrides_of(overrides), *arrays, relax, offset, box, frequency)
    start = scenes.as_arguments(make)
    warn(start.start_doubts())
    return Snapshot(start, "the arrays")


def _sorted_by(ids, arrays):
    """Returns arrays of particles with their rows in the order of the ids; numbers and None unchanged."""
    ids = np.asarray(ids)
    count = len(arrays[0]) if arrays[0].ndim else 0
    if ids.shape != (count,) or ids.dtype.kind not in "iu" or len(np.unique(ids)) != count:
        raise UsageError(f"ids are {count} whole numbers, one per particle, and all different; correct them, or leave them out")
    order = np.argsort(ids)
    return [array if array is None or array.ndim == 0 else array[order] if len(array) == count else array for array in arrays]


def warn(lines):
    """Warns of each line, at the line outside the package that called it."""
    frame, level = sys._getframe(1), 2
    while frame.f_back and frame.f_globals.get("__name__", "").partition(".")[0] == __package__:
        frame, level = frame.f_back, level + 1
    for line in lines:
        warnings.warn(line, stacklevel=level)


def read(file):
    """Reads a snapshot file. Raises IoError, and InvariantError for invalid particles."""
    file = _arguments.path(file, "read")
    if not file.is_file():
        raise UsageError(f"'{file}' is not a file; name a snapshot, snap_NNNNNN.hdf")
    return Snapshot(_core.read_snapshot(file), str(file))


def as_snapshot(start):
    """Converts an initial state to a Snapshot: a Snapshot, the file of one, or a Simulation."""
    if isinstance(start, Snapshot):
        return start
    return start.snapshot() if hasattr(start, "snapshot") else read(start)


def _from_bytes(data, name, is_a_start):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "snapshot.hdf"
        file.write_bytes(data)
        return Snapshot(_core.read_snapshot(file, is_a_start), name)
