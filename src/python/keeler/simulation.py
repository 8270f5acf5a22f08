"""Simulations in memory."""

import sys
import tempfile
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from . import _arguments, _core, scenes, snapshots, views
from ._steps import Contacts, Edited, ProgressLine, ticks
from .errors import UsageError
from .snapshots import Snapshot

#: Columns of ``Simulation.elements``: X and Y of the guiding centre, and the vectors of eccentricity and inclination.
ELEMENTS = ("X", "Y", "e cos phi", "e sin phi", "i sin zeta", "i cos zeta")


class Simulation:
    """A patch of ring that runs in memory; files are written on request only.

    ::

        sim = keeler.Simulation("scene.toml", time={"end": 5.0})
        sim.run(5.0, every=0.5, callback=lambda sim: print(sim.orbits, sim.analyze()["toomre_q"]))

    ``scene`` is the path of a scene file, the name of an example ("a-ring-wakes"), its text, or a dictionary of its tables. ``start`` is the initial state: a
    Snapshot, the file of one, or the present state of a Simulation. Other arguments override keys of the scene:
    ``time={"end": 5.0}``, or ``**{"time.end": 5.0}``. Raises UsageError for an invalid scene.

    The state is bitwise identical to that of ``keeler run`` with this scene, for any number of threads.

    **Arrays** are read-only and have one row per particle, in memory order: neighbours in space are neighbours in
    memory. The order changes as particles move; ``ids`` identifies the particles, and ``by_id(array)`` sorts rows by
    id. ``elements``, ``radii``, ``masses`` and ``ids`` are views of the state, without a copy; ``positions`` and
    ``velocities`` are computed at the first access after a step. An existing array does not change when the
    simulation continues (which then costs one copy of the state).
    """

    __slots__ = ("_core", "_scene", "_motion", "_recording", "_changes", "__weakref__")

    def __init__(self, scene, start=None, **overrides):
        if start is None:
            core = _core.Simulation(scenes.read(scene, overrides))
        else:
            start = snapshots.as_snapshot(start)
            core = _core.Simulation(start._core, start._name, scenes.read(scene, overrides, start._name))
        self._begin(core)

    def _begin(self, core):
        self._core = core
        self._scene = core.scene  # kept: making it later could fail for lack of memory
        self._motion = None
        self._recording = False
        self._changes = 0

    @classmethod
    def _of(cls, core):
        simulation = cls.__new__(cls)
        simulation._begin(core)
        return simulation

    def __len__(self):
        return len(self._core)

    def __repr__(self):
        return f"<keeler.Simulation: {len(self)} particles at orbit {self.orbits:g}>"

    # --- the state

    @property
    def orbits(self):
        """The time in orbits."""
        return self._core.orbits

    @property
    def state_hash(self):
        """32 hexadecimal digits: states with equal hashes are bitwise identical, and evolve identically."""
        return self._core.state_hash

    @property
    def scene(self):
        """The resolved scene as text: every key, defaults included."""
        return self._scene.text

    @property
    def remarks(self):
        """The notices and warnings of the program about the scene, one line each."""
        return self._scene.remarks

    @property
    def orbital_frequency(self):
        """Omega, rad/s: velocities and frequencies of the elements are in units of it."""
        return self._scene.orbital_frequency

    @property
    def box(self):
        """(L_x, L_y) in m."""
        return self._core.box

    @property
    def shear_offset(self):
        """m: the image in the box (n, m) is now at x + n L_x, y + m L_y - n shear_offset."""
        return self._core.shear_offset

    @property
    def elements(self):
        """(N, 6) m: X, Y, e cos, e sin, i sin, i cos (keeler.ELEMENTS) at ``epoch``. A view."""
        return self._core.elements()

    @property
    def epoch(self):
        """The epoch of ``elements``, in orbits: the middle of the next step."""
        return self._core.epoch

    @property
    def ids(self):
        """(N,) identifiers of the particles, which never change. A view."""
        return self._core.ids()

    @property
    def radii(self):
        """(N,) m. A view."""
        return self._core.radii()

    @property
    def masses(self):
        """(N,) kg. A view."""
        return self._core.masses()

    @property
    def positions(self):
        """(N, 3) m, Hill's frame: x outward, y along the orbit, z up."""
        return self._moving()[0]

    @property
    def velocities(self):
        """(N, 3) m/s, Hill's frame, including the shear."""
        return self._moving()[1]

    @property
    def spins(self):
        """(N, 3) rad/s, inertial spins in components of Hill's frame; None for smooth particles."""
        return self._core.spins()

    def _moving(self):
        if self._motion is None:
            self._motion = self._core.motion()
        return self._motion

    @property
    def work_by_force(self):
        """The work of each force on the motion beyond the shear since the start, in J: a dictionary by names."""
        return self._core.works()

    def by_id(self, array):
        """Returns a copy of an array with its rows sorted by id; of a masked array with its mask."""
        array = np.asanyarray(array)
        if array.shape[:1] != (len(self),):
            raise UsageError(f"the array has {array.shape[0] if array.ndim else 'no'} rows; give one per particle ({len(self)})")
        return array[np.argsort(self.ids)]

    def snapshot(self):
        """Returns the state as a Snapshot: a copy in SI, sorted by id. After an InvariantError it lacks the particles
        that a snapshot cannot hold, with numbers that are not finite or far out of bounds."""
        return Snapshot(self._core.snapshot(), f"the simulation at orbit {self.orbits:g}")

    def analyze(self):
        """Returns the numbers of ``keeler analyze --json`` on a snapshot, as a dictionary: names with units."""
        return self.snapshot().analyze()

    @property
    def collisions_so_far(self):
        """Counts since the start: {"collisions": faster than v_cut, "slow_contacts": elastic, "steps": steps}."""
        return self._core.counts()

    # --- steps

    def run(self, until=None, *, every=None, callback=None, progress=False):
        """Runs until a time (orbits; default: the scene's end).

        ``callback(sim)`` is called at multiples of ``every`` (orbits) and at the end; an exception in it ends the
        run. Times are rounded to whole kick intervals, at which kicks and drifts are synchronized. ``progress`` shows
        a line on standard error.

        Ctrl-C raises KeyboardInterrupt at the next such time, and the run can continue. A second Ctrl-C abandons the
        current step: the state is then an earlier one, of the last 0.2 s of computing or of the previous step. The
        same holds after a MemoryError, or after an invalid coefficient of a user-defined restitution law
        (UsageError); the run can continue.

        Raises InvariantError when a step breaks an invariant. The simulation then cannot continue, but its arrays and
        snapshot() can be read: they are of the last contact in the step, or of the end of the step.
        """
        core, scene = self._core, self._scene
        interval = scene.kick_interval
        end = ticks(scene.end if until is None else until, "until", scene)
        if end < core.tick:
            requested = scene.end if until is None else until
            raise UsageError(f"until is orbit {requested:g}, and the simulation is at orbit {self.orbits:g}; give a later time")
        if (every is None) != (callback is None):
            raise UsageError("every and callback go together: the callback is called at multiples of every")
        between = max(interval, ticks(every, "every", scene)) if every is not None else None
        line = ProgressLine(core.tick, end) if progress else None
        piece = between or end
        if line:
            piece = min(piece, max(interval, (end - core.tick) // 200 // interval * interval))
        try:
            while core.tick < end:
                target = min(end, (core.tick // piece + 1) * piece)
                if between:
                    target = min(target, (core.tick // between + 1) * between)
                self._motion = None
                core.advance(target)
                if callback and (core.tick % between == 0 or core.tick == end):
                    callback(self)
                if line:
                    line.show(core.tick, self.orbits)
        finally:
            if line:
                line.end()
        return self

    def step(self, count=1):
        """Advances by ``count`` kick intervals, the shortest time after which the state can be read."""
        count = scenes.whole_number(count, "count", 0, 10**12)
        self._motion = None
        self._core.advance(self._core.tick + count * self._scene.kick_interval)
        return self

    @contextmanager
    def collisions(self, minimum_speed=0.0):
        """Records contacts with at least this normal speed (m/s)::

            with sim.collisions(minimum_speed=0.002) as contacts:
                sim.run(sim.orbits + 1.0)
                rows = contacts()

        ``contacts()`` returns the contacts since its last call, as an array with the fields time_orbits, low_id,
        high_id, x_m, y_m, z_m (the point of contact, at the image of the particle with the lower id),
        normal_speed_m_s, tangential_speed_m_s, energy_lost_j. After the block it returns the remaining ones.
        """
        if self._recording:
            raise UsageError("contacts are recorded already; end that block first")
        try:
            speed = float(minimum_speed)
        except (TypeError, ValueError, OverflowError):
            speed = -1.0
        if not speed >= 0.0:
            raise UsageError(f"minimum_speed is {_arguments.shown(minimum_speed)}; give a speed in m/s, 0 or more")
        self._core.record_contacts(speed)
        self._recording = True
        contacts = Contacts(self._core)
        try:
            yield contacts
        finally:
            try:
                contacts.end()
            finally:
                self._core.record_contacts(None)
                self._recording = False

    # --- changes and files

    @contextmanager
    def edit(self):
        """Changes the state. Within the block, ``positions``, ``velocities``, ``radii``, ``masses`` and ``spins`` are
        writable copies with rows in the order of ``sim.ids``::

            with sim.edit() as state:
                state.velocities[:, 2] += 1e-4

        At the end they become the state, unless the block raises. Raises InvariantError, and changes nothing, when a
        particle is invalid (a number that is not finite, a radius or a density out of bounds, a position far outside
        the box) or particles overlap; UsageError for arrays of another shape or with masked entries, or when the
        simulation has continued within the block. The energy of a change counts as part of the initial energy.
        """
        state, begun = Edited(self), (self._core.tick, self._changes)
        yield state
        if begun != (self._core.tick, self._changes):
            raise UsageError("the simulation has moved on, or was changed, within edit(); the order of its rows may have changed")
        self._core.replace(*state.arrays())
        self._changes += 1
        self._motion = None

    def save(self, file):
        """Writes the state to a checkpoint, from which load() continues with bitwise identical results. As
        checkpoint_000000.h5 in a separate folder it can also be continued by ``keeler resume FOLDER``. Raises
        IoError."""
        self._core.save(_arguments.path(file, "save"))

    def plot(self, file=None, **options):
        """Returns the picture of the state, as Snapshot.plot()."""
        return self.snapshot().plot(file, **options)

    def show(self, **options):
        """Shows the picture in a notebook (and returns None); elsewhere returns it."""
        picture = self.plot(**options)
        if "IPython" in sys.modules:
            from IPython.display import display

            display(picture)
            return None
        return picture

    def view(self, port=0):
        """Shows the simulation, as it runs, in a page for browsers of this machine, and returns a View: its ``address``,
        and ``close()``. The page has the particles in 3-D, plots that grow, and buttons to pause, step and stop: a stop
        is a KeyboardInterrupt in ``run`` or ``step``. Nothing is computed for a page that is not looked at, and no result
        depends on it. ``port`` is that of the address (0: a free one). A second call returns the open page. Raises
        RunError when there is none to be had, and UsageError for another port than that of an open page."""
        return views.open_view(self._core, f"Keeler: {len(self)} particles", port, None)

    def widget(self, height=900, port=0):
        """As view(), shown in place where a notebook displays it, ``height`` pixels tall. The notebook's browser must run
        on this machine, or see its ports."""
        return views.open_view(self._core, f"Keeler: {len(self)} particles", port, height)

    def _repr_png_(self):
        return self.plot(width=1000)._repr_png_()

    # --- pickling and copies

    def __reduce__(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "state.h5"
            self.save(file)
            return _from_bytes, (file.read_bytes(),)


def load(file):
    """Reads a simulation from a file of Simulation.save() or a checkpoint of a run. Raises IoError."""
    return Simulation._of(_core.Simulation.load(_arguments.path(file, "load")))


def resume(folder):
    """Reads the newest checkpoint in a run's folder as a simulation in memory; the folder is not changed. Warns
    (UserWarning) of a scene.toml that was edited after the start of the run, and of damaged checkpoints, which it
    skips. Raises IoError."""
    lines = []
    core = _core.Simulation.resume(_arguments.path(folder, "resume"), lines.append)
    snapshots.warn(lines)
    return Simulation._of(core)


def from_arrays(scene, positions, radii, velocities=None, masses=None, spins=None, **options):
    """Returns a simulation of given particles in the scene's box: see start_from_arrays(), which has the options."""
    start = snapshots.start_from_arrays(scene, positions, radii, velocities, masses, spins, **options)
    return Simulation(start.scene, start=start)


def _from_bytes(data):
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "state.h5"
        file.write_bytes(data)
        return load(file)
