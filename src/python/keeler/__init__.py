"""Keeler: a patch of a self-gravitating planetary ring.

A ring in a few lines::

    import keeler

    sim = keeler.Simulation({
        "planet": {"preset": "saturn-a-ring"},
        "box": {"size": [200.0, 200.0]},
        "particles": {"optical_depth": 0.5, "density": 450.0, "sizes": {"law": "equal", "radius": 1.0}},
        "gravity": {"solver": "fft"},
        "time": {"step": 1e-3, "end": 3.0},
    })
    sim.run(progress=True)
    print(sim.analyze()["toomre_q"])
    sim.plot("ring.png")

Contents:

- ``Simulation``: a patch that runs in memory. ``load``, ``resume``, ``from_arrays`` and ``from_rebound`` make one
  from existing data; ``to_rebound`` takes its particles to REBOUND.
- ``Snapshot``: a patch at one time. ``generate``, ``tile``, ``start_from_arrays`` make one; ``read`` reads one.
- ``Run``: the folder of a run, from ``run`` or ``read(folder)``: series, snapshots, summary. ``sweep`` makes many runs.
- ``analyze()`` of each of these returns ``Numbers``; ``quantities`` lists their units and meanings.
- ``Columns`` and ``Rows``: the tables of runs and sweeps; ``to_pandas()`` and ``to_xarray()`` where these are installed.
- ``Simulation.view`` and ``widget``: a page that shows it as it runs (``View``).
- ``photometry``: the light of any of them; ``occultation``: a star behind it. ``render``: a picture.
- ``add_force``, ``add_restitution_law``, ``add_size_law``, ``add_start``, ``add_quantity``, ``add_series_column``:
  physics and numbers of your own, called by name; ``Key`` declares a number of theirs.
- ``set_threads``, ``threads``: results are bitwise identical for any number of threads.
- ``Error`` and its four kinds: ``UsageError``, ``InvariantError``, ``IoError``, ``RunError``.

Lengths are in m, velocities in m/s, masses in kg, times in orbits. x points outward, y along the orbit, z up.
docs/manual/python.md has more.
"""

import atexit as _atexit
import os as _os
import sys as _sys
from importlib.util import find_spec as _find_spec

# Threads that spin while waiting make a run ten times slower on a busy machine. OpenMP reads this when it is loaded.
if "GOMP_SPINCOUNT" not in _os.environ and "OMP_WAIT_POLICY" not in _os.environ:
    _os.environ["OMP_WAIT_POLICY"] = "passive"
    _os.environ["GOMP_SPINCOUNT"] = "6000"

if _find_spec("numpy") is None:
    raise ImportError(
        f"keeler needs numpy, and {_sys.executable} has none; install it there, or use a Python that has it "
        "(Debian: python3-numpy, which is for /usr/bin/python3)"
    )
if _find_spec("._core", __name__) is None:
    _folder = _os.path.dirname(__file__)
    _others = [name for name in _os.listdir(_folder) if name.startswith("_core.")]
    raise ImportError(
        f"the compiled part of keeler in {_folder} is for another Python than {_sys.executable}: {', '.join(_others)}"
        if _others
        else f"the compiled part of keeler is not built in {_folder}; in the source tree run scripts/setup package, "
        "cmake --preset default, and cmake --build build/default --target keeler_python"
    )

from . import _border, _core

_border.guard(_core)

from . import own, scenes
from .errors import Error, InvariantError, IoError, RunError, UsageError
from .light import Occultations, Sights, SurfaceLaw, occultation, photometry
from .numbers import Numbers, Quantity, quantities
from .own import Key, StartRequest, add_force, add_quantity, add_series_column, add_size_law, add_start
from .rebound import from_rebound, to_rebound
from .runs import Run, program, read, render, run, sweep
from .simulation import ELEMENTS, Simulation, from_arrays, load, resume
from .snapshots import Picture, Snapshot, generate, start_from_arrays, tile
from .tables import Columns, Rows
from .views import View, close_all as _close_all

Kick = _core.Kick
__version__ = _core.version()

_atexit.register(_close_all)  # called after the next one: no thread computes then
_atexit.register(_core.end_other_threads)  # the interpreter would end computing daemon threads inside C++

__all__ = [
    "Columns",
    "ELEMENTS",
    "Error",
    "InvariantError",
    "IoError",
    "Key",
    "Kick",
    "Numbers",
    "Occultations",
    "Picture",
    "Quantity",
    "Rows",
    "Run",
    "RunError",
    "Sights",
    "Simulation",
    "Snapshot",
    "StartRequest",
    "SurfaceLaw",
    "UsageError",
    "View",
    "add_force",
    "add_quantity",
    "add_restitution_law",
    "add_series_column",
    "add_size_law",
    "add_start",
    "from_arrays",
    "from_rebound",
    "generate",
    "load",
    "occultation",
    "photometry",
    "program",
    "quantities",
    "read",
    "render",
    "resume",
    "run",
    "set_threads",
    "start_from_arrays",
    "sweep",
    "threads",
    "tile",
    "to_rebound",
]


def threads():
    """Returns the number of threads that loops use. The default is OMP_NUM_THREADS, or all processors."""
    return _core.threads()


def set_threads(count):
    """Sets the number of threads, at least 1, for loops called from this Python thread. Raises UsageError."""
    _core.set_threads(scenes.whole_number(count, "count", 1, 1024))


_own_laws = []  # keeps the functions alive that Keeler calls


def add_restitution_law(name, function):
    """Registers a restitution law for scenes with ``collisions.restitution = {law = "own", name = NAME}``.

    ``function`` is compiled code, not Python (it is called for each contact): a ctypes function or its address, of
    the C type ``double law(double speed, double radius_low, double radius_high)``. Its arguments are the normal
    approach speed in m/s and the radii in m of the particles with the lower and the higher id; it returns the
    coefficient, in [0, 1]. It is called from several threads at once, and its result may depend on the arguments
    only. With numba use ``cfunc(...).address``.

    The name enters the scene and ``state_hash``: a program without a law of that name refuses to continue such a run.
    Raises UsageError for a coefficient out of range, or a name that is taken.
    """
    address = own.compiled(function)
    if not address:
        raise UsageError(f"{function!r} is no compiled function; give a ctypes function or the address of one")
    _core.add_restitution_law(name, address)
    _own_laws.append(function)
