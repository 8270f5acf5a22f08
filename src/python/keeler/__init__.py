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

What there is:

- ``Simulation``: a patch that runs in memory. ``load``, ``resume``, ``from_arrays`` make one from what exists.
- ``Snapshot``: a patch at one instant. ``generate``, ``tile``, ``start_from_arrays`` make one; ``read`` reads one.
- ``Run``: the folder of a run, from ``run`` or ``read(folder)``: series, snapshots, summary. ``sweep`` makes many runs.
- ``analyze()`` of each of these: ``Numbers``; ``quantities`` says what each is, and in which unit.
- ``render``: a picture of any of them. ``add_restitution_law``: a law of one's own.
- ``set_threads``, ``threads``: results are the same, bit for bit, for any number.
- ``Error`` and its four kinds: ``UsageError``, ``InvariantError``, ``IoError``, ``RunError``.

Lengths are in m, velocities in m/s, masses in kg, times in orbits. x points outward, y along the orbit, z up.
docs/manual/python.md has more.
"""

import atexit as _atexit
import ctypes as _ctypes
import os as _os
import sys as _sys
from importlib.util import find_spec as _find_spec

# Threads that spin while they wait make a run ten times slower on a busy machine. OpenMP reads this when it is loaded.
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

from . import scenes
from .errors import Error, InvariantError, IoError, RunError, UsageError
from .numbers import Numbers, Quantity, quantities
from .runs import Run, program, read, render, run, sweep
from .simulation import ELEMENTS, Simulation, from_arrays, load, resume
from .snapshots import Picture, Snapshot, generate, start_from_arrays, tile

__version__ = _core.version()

_atexit.register(_core.end_other_threads)  # daemon threads that compute: the interpreter would end them inside C++

__all__ = [
    "ELEMENTS",
    "Error",
    "InvariantError",
    "IoError",
    "Numbers",
    "Picture",
    "Quantity",
    "Run",
    "RunError",
    "Simulation",
    "Snapshot",
    "UsageError",
    "add_restitution_law",
    "from_arrays",
    "generate",
    "load",
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
]


def threads():
    """How many threads loops use. The default is that of OMP_NUM_THREADS, or all processors."""
    return _core.threads()


def set_threads(count):
    """Sets how many threads, at least 1, loops of this Python thread use from now on. Raises UsageError."""
    _core.set_threads(scenes.whole_number(count, "count", 1, 1024))


_own_laws = []  # functions that Keeler calls must live as long as it


def add_restitution_law(name, function):
    """A restitution law of your own, which scenes then name: ``collisions.restitution = {law = "own", name = NAME}``.

    ``function`` is compiled code, never Python (a call for each contact): a ctypes function or the address of one, of
    the C type ``double law(double speed, double radius_low, double radius_high)``: normal approach speed in m/s, radii in
    m of the particles with the lower and the higher id; it returns the coefficient, in [0, 1]. It is called from
    several threads at once and must give the same value for the same impact. Of numba: ``cfunc(...).address``.

    The name enters the scene and ``state_hash``: a program that has no law of that name refuses to go on with such a
    run. Raises UsageError for a coefficient out of range, or a name that is taken.
    """
    if isinstance(function, (_ctypes._CFuncPtr, _ctypes.c_void_p)):
        address = _ctypes.cast(function, _ctypes.c_void_p).value
    else:
        address = 0 if isinstance(function, bool) or not isinstance(function, int) else function
    if not address or not 0 < address < 2**64:
        raise UsageError(f"{function!r} is no compiled function; give a ctypes function or the address of one")
    _core.add_restitution_law(name, address)
    _own_laws.append(function)
