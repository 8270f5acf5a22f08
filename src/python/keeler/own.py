"""Physics of one's own: forces, size laws, starts and numbers that scenes and results call by name."""

import ctypes
import math
from typing import NamedTuple

import numpy as np

from . import _arguments, _core
from .errors import UsageError
from .snapshots import Snapshot


class Key(NamedTuple):
    """A number in the table of a force, a size law or a start: ``default`` (None: a scene must give it), ``unit`` and
    ``meaning`` for people, and the lowest and the highest value."""

    default: "float | None" = None
    unit: str = "1"
    meaning: str = ""
    low: float = -math.inf
    high: float = math.inf


class StartRequest(NamedTuple):
    """The particles that a start of one's own places: radii (m) and masses (kg) in the order of the ids, the box
    (L_x, L_y in m), Omega (rad/s), kappa/Omega and nu/Omega, the c_x that the scene asks for (m/s), its seed, and the
    values of the start's keys."""

    radii: np.ndarray
    masses: np.ndarray
    box: "tuple[float, float]"
    orbital_frequency: float
    epicyclic_ratio: float
    vertical_ratio: float
    velocity_dispersion: float
    seed: int
    keys: "dict[str, float]"


_forces, _laws, _columns = set(), set(), set()
_kept = []  # compiled functions that Keeler calls


_ARRAYS = ("positions", "velocities", "velocities_beyond_shear", "masses", "radii")


def add_force(name, function, keys=None, reads=_ARRAYS):
    """Registers a force: scenes that are read from then on may have a table ``[NAME]`` with its ``keys``.

    ::

        def drag(kick, accelerations):
            accelerations[:] = -kick.keys["rate"] * kick.velocities_beyond_shear

        keeler.add_force("drag", drag, {"rate": keeler.Key(1e-5, "1/s", "gamma of the drag -gamma c", low=0.0)})
        sim = keeler.Simulation(scene, drag={"rate": 2e-5}).run()

    ``function(kick, accelerations)`` is called once per kick with a ``Kick``, and writes m/s^2 into an array (N, 3) of
    zeros. Or it is compiled: a ctypes function or an address, called for blocks of particles in several threads, of the
    C type (the manual explains it) ::

        void force(int64_t count, const double *positions, const double *velocities, const double *beyond_shear,
                   const double *masses, const double *radii, const uint64_t *ids, const double *kick,
                   const double *keys, double *accelerations);

    ``reads`` names the arrays of Kick that compiled code reads, ``("velocities_beyond_shear",)``: it is given null for the
    others, which are then not computed (default: all).

    What it returns must follow from the arguments alone, and from no order of the particles, or a restart differs.
    ``keys`` is a dictionary of names with a default number or a ``Key``. Name and keys are in the scene, in checkpoints
    and in ``state_hash``; so is ``version``, a key of every force, for changes of the formula. A name that this
    function was given before gets the new function: simulations that exist keep theirs. Raises UsageError.
    """
    address = compiled(function)
    if address:
        if isinstance(reads, str):
            raise UsageError(f"reads is {_arguments.shown(reads)}; give a list of names")
        _core.add_compiled_force(_text(name, "name"), address, _declared(keys), [_text(one, "an array") for one in reads])
        _kept.append(function)
    else:
        _core.add_python_force(_text(name, "name"), _callable(function, "a force"), _declared(keys))
    _forces.add(name)


def add_size_law(name, quantile, keys=None):
    """Registers a size law for ``particles.sizes = {law = NAME, ...}``. ``quantile(u, keys)`` returns the radii (m)
    below which the fractions ``u`` of all particles are; it is called once, with 4097 numbers from 0 to 1, and the law
    is linear between them. A name that was given before gets the new function. Raises UsageError."""
    function = _callable(quantile, "a size law")

    def radii(u, values):
        return np.asarray(function(u, values), dtype=float)

    _core.add_size_law(_text(name, "name"), radii, _declared(keys))
    _laws.add(name)


def add_start(name, place, keys=None):
    """Registers a start for ``particles.start = {law = NAME, ...}``. ``place(request)`` gets a ``StartRequest`` and
    returns positions (N, 3) in m, in or near the box, and velocities (N, 3) in m/s, shear included. A name that was given before gets
    the new function. Raises UsageError."""
    function = _callable(place, "a start")

    def states(*request):
        placed = function(StartRequest(*request))
        if not isinstance(placed, (tuple, list)) or len(placed) != 2:
            raise UsageError(f"the start '{name}' returns no pair; return positions and velocities")
        return tuple(_arguments.doubles(array, of) for array, of in zip(placed, ("positions", "velocities")))

    _core.add_start(_text(name, "name"), states, _declared(keys))
    _laws.add(name)


def add_quantity(name, unit, function, meaning=""):
    """Adds a number to what ``analyze()`` returns: ``function(snapshot)`` of one Snapshot, without its ``scene``; for a
    run the mean over its snapshots. The name ends in the unit, "gas_torque_n_m". A name that was given before gets the
    new function. Raises UsageError."""
    _core.add_quantity(_text(name, "name"), _text(unit, "unit"), "", _text(meaning, "meaning"), _of_snapshot(function))


def add_series_column(name, unit, function, meaning=""):
    """Adds a column to the series of runs of this process: ``function(snapshot)`` of the Snapshot at each row. From
    then on ``keeler.run`` runs in this process. Raises UsageError."""
    meaning = _text(meaning, "meaning")
    _core.add_series_column(_text(name, "name"), _text(unit, "unit"), f"{meaning or name}: {name}", meaning,
                            _of_snapshot(function))
    _columns.add(name)


def needs_this_process(text):
    """True if a run of a scene (its resolved text) needs what was added here."""
    lines = set(text.splitlines())
    tables = {f"[{name}]" for name in _forces}
    laws = {f'law = "{name}"' for name in {*_laws, "own"}}
    return bool(_columns or lines & (tables | laws))


def compiled(function):
    """Returns the address of a compiled function; 0 for anything else."""
    if isinstance(function, (ctypes._CFuncPtr, ctypes.c_void_p)):
        return ctypes.cast(function, ctypes.c_void_p).value or 0
    is_address = isinstance(function, int) and not isinstance(function, bool)
    return function if is_address and 4096 <= function < 2**64 else 0  # the first page holds no code


def _of_snapshot(function):
    function = _callable(function, "a number")
    return lambda core: float(function(Snapshot(core)))


def _callable(function, what):
    if not callable(function):
        compilable = ", or a ctypes function or the address of one" if what == "a force" else ""
        raise UsageError(f"{_arguments.shown(function)} is no function; give {what} a function of Python{compilable}")
    return function


def _text(value, name):
    if not isinstance(value, str):
        raise UsageError(f"{name} is {_arguments.shown(value)}; give a text")
    return _arguments.whole_characters(value, name)


def _declared(keys):
    """Returns keys as rows for the compiled part."""
    if not isinstance(keys or {}, dict):
        raise UsageError(f"keys is {_arguments.shown(keys)}; give a dictionary of names with default numbers or keeler.Keys")
    rows = []
    for name, key in (keys or {}).items():
        key = key if isinstance(key, Key) else Key(key)
        try:
            default = None if key.default is None else float(key.default)
            low, high = float(key.low), float(key.high)
        except (TypeError, ValueError, OverflowError):
            raise UsageError(f"the key '{name}' has no numbers; give a default number, or a keeler.Key of numbers") from None
        if default is not None and not low <= default <= high:
            raise UsageError(f"the key '{name}' has the default {default}, which is not from {low} to {high}")
        rows.append((_text(name, "the name of a key"), default, _text(key.unit, "unit"), _text(key.meaning, "meaning"),
                     low, high))
    return rows
