"""What Simulation needs while it steps: recorded contacts, the copies of edit(), times, the line of progress."""

import sys
import time

import numpy as np

from . import _arguments
from .errors import UsageError


class Contacts:
    """Returns the recorded contacts since the last call: see Simulation.collisions."""

    def __init__(self, core):
        self.core, self.last = core, None

    def __call__(self):
        if self.last is None:
            return self.core.take_contacts()
        rows, self.last = self.last, self.last[:0]
        return rows

    def end(self):
        self.last = self.core.take_contacts()


class Edited:
    """The writable copies of edit(); any other attribute is an error."""

    __slots__ = ("positions", "velocities", "radii", "masses", "spins", "_ids")

    def __init__(self, sim):
        self.positions = np.array(sim.positions)
        self.velocities = np.array(sim.velocities)
        self.radii = np.array(sim.radii)
        self.masses = np.array(sim.masses)
        spins = sim.spins
        self.spins = None if spins is None else np.array(spins)
        self._ids = np.array(sim.ids)
        self._ids.flags.writeable = False

    @property
    def ids(self):
        return self._ids

    @ids.setter
    def ids(self, _):
        raise UsageError("ids are given within edit(), and they never change; change the rows of the other arrays")

    def arrays(self):
        names = ("positions", "velocities", "radii", "masses", "spins")
        return [_arguments.doubles(getattr(self, name), name) for name in names]


def ticks(orbits, name, scene):
    """Returns a time in orbits as ticks of whole kick intervals. Raises UsageError."""
    try:
        orbits = float(orbits)
    except (TypeError, ValueError, OverflowError):
        raise UsageError(f"{name} is {_arguments.shown(orbits)}; give a time in orbits") from None
    count = orbits / (scene.tick * scene.kick_interval)
    if not 0.0 <= count < 1e15:
        raise UsageError(f"{name} is {orbits} orbits; give a time from 0 to {1e15 * scene.tick:g}")
    return round(count) * scene.kick_interval


class ProgressLine:
    """The line of Simulation.run on standard error."""

    def __init__(self, first, end):
        self.first, self.end_tick, self.begin, self.shown = first, end, time.monotonic(), 0.0

    def show(self, tick, orbits):
        now = time.monotonic()
        if now - self.shown < 0.2 and tick < self.end_tick:
            return
        self.shown = now
        done = (tick - self.first) / (self.end_tick - self.first)
        left = (now - self.begin) * (1.0 - done) / done if done > 0.0 else float("nan")
        print(f"\r{100.0 * done:3.0f} %  orbit {orbits:.4g}  {left:.0f} s left ", end="", file=sys.stderr, flush=True)

    def end(self):
        print(file=sys.stderr)
